// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/rung_input.hpp"
#include "support/meshes.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

constexpr std::uint32_t k_boundary = 12;
constexpr std::uint64_t k_share = 100;

/// `count` spheres in a row, more than the goals leave triangles for.
Part part_of_spheres(int count) {
  Part part;
  for (int i = 0; i < count; ++i) {
    Mesh sphere = test::icosphere(2);
    for (Vec3& p : sphere.positions) p = p * (1 + 0.02 * i) + Vec3{4.0 * i, 0, 0};
    test::append(part.mesh, sphere);
  }
  part.boundary_vertices = k_boundary;
  part.positions = PositionType::float32;
  for (Vec3& p : part.mesh.positions) p = rounded(p, part.positions);
  return part;
}

SimplifyParameters parameters_of(TopologyMode topology) {
  SimplifyParameters parameters;
  parameters.start_triangles = 400;
  parameters.share_triangles = k_share;
  parameters.samples = 500;
  parameters.cost_unit = cost_unit(100);
  parameters.lines.topology = topology;
  return parameters;
}

struct ClimbedPart {
  FileRef file;
  ResultSummary summary;

  explicit ClimbedPart(const JobOutput& output)
      : file(output.file), summary(decode_summary(output.summary, "summary")) {}
  const Rung& first() const { return summary.rungs.front(); }
  const Rung& last() const { return summary.rungs.back(); }
};

class ClimbBench {
 public:
  explicit ClimbBench(const Part& part) : stage_(Stage::create(folder_.path())) {
    part_ = stage_.publish(PartName{0}, encode_part(part));
  }

  ClimbedPart climb(TopologyMode topology, std::uint64_t end_triangles = 0,
                    std::uint64_t foreseen_triangles = 0,
                    std::uint64_t start_triangles = 400) const {
    SimplifyParameters parameters = parameters_of(topology);
    parameters.start_triangles = start_triangles;
    parameters.end_triangles = end_triangles;
    parameters.foreseen_triangles = foreseen_triangles;
    return do_job({std::string(k_simplify_kind), {part_}, encode_parameters(parameters)});
  }
  ClimbedPart climb_on(const ClimbedPart& from, TopologyMode topology,
                       std::uint32_t place = 0) const {
    SimplifyParameters parameters = parameters_of(topology);
    parameters.from = RungOfLadder{place, from.summary.rungs[place].level};
    Job job;
    job.kind = k_simplify_kind;
    add_rung_input({.file = from.file, .rung = place, .place = place_of(from.summary, place)}, true,
                   job);
    job.parameters = encode_parameters(parameters);
    return do_job(job);
  }
  ResultMesh mesh_of(const ClimbedPart& done, std::size_t rung) const {
    return decode_result(stage_.read(done.file), rung, "result");
  }

 private:
  ClimbedPart do_job(const Job& job) const {
    return ClimbedPart(simplify_part(job, {stage_, 1, 7, [](std::uint64_t) { return true; }}));
  }

  test::TempFolder folder_;
  Stage stage_;
  FileRef part_;
};

}  // namespace

TEST_CASE("a ladder has no rungs that are hardly smaller than the ones before, except the last") {
  // The small spheres have 3 % of the triangles, and lose them over many levels.
  Part part;
  part.mesh = test::icosphere(5);
  for (Vec3& p : part.mesh.positions) p = p * 100;
  for (int i = 0; i < 2; ++i) {
    Mesh sphere = test::icosphere(2);
    for (Vec3& p : sphere.positions) p = p * 0.01 + Vec3{200.0 + i, 0, 0};
    test::append(part.mesh, sphere);
  }
  part.boundary_vertices = k_boundary;
  part.positions = PositionType::float64;
  const ClimbBench bench(part);
  const std::vector<Rung> rungs =
      bench.climb(TopologyMode::keep, 0, 0, part.mesh.triangles.size() - 100).summary.rungs;
  REQUIRE(rungs.size() > 3);
  for (std::size_t i = 1; i + 1 < rungs.size(); ++i) {
    CAPTURE(i);
    CHECK(static_cast<double>(rungs[i].triangles) <
          0.98 * static_cast<double>(rungs[i - 1].triangles));
  }
}

TEST_CASE("levels are finer near what is wanted of the part") {
  Part part;
  part.mesh = test::icosphere(5);
  part.positions = PositionType::float64;
  const ClimbBench bench(part);
  const std::vector<Rung> rungs =
      bench.climb(TopologyMode::keep, 0, 0, part.mesh.triangles.size()).summary.rungs;
  REQUIRE(rungs.size() > 8);
  for (std::size_t i = 2; i + 1 < rungs.size(); ++i) {
    CAPTURE(rungs[i].free_triangles);
    const bool is_far = rungs[i].free_triangles > 5 * k_share;
    const std::int32_t step = rungs[i + 1].level - rungs[i].level;
    CHECK((is_far ? step == 2 && rungs[i].level % 2 == 0 : step == 1));
  }
  CHECK(rungs[2].free_triangles > 10 * k_share);
}

TEST_CASE("a ladder that may have to give up its topology begins where nothing was refused") {
  const ClimbBench bench(part_of_spheres(60));
  const ClimbedPart kept = bench.climb(TopologyMode::keep_while_fair);
  const ClimbedPart simplified = bench.climb(TopologyMode::simplify);
  CHECK(kept.summary.held_by_topology);
  // 60 pieces of four triangles are the least there can be.
  CHECK(kept.last().triangles >= 240);
  CHECK(simplified.last().triangles < 100);
  CHECK(measure_topology(bench.mesh_of(kept, 0).mesh).components == 60);
  // Another job gets as far from there as from the part itself.
  const ClimbedPart on = bench.climb_on(kept, TopologyMode::simplify);
  CHECK(on.first().triangles <= kept.first().triangles);
  CHECK(on.last().triangles <= simplified.last().triangles + 4);
  for (std::size_t i = 1; i < on.summary.rungs.size(); ++i) {
    CHECK(on.summary.rungs[i].level > on.summary.rungs[i - 1].level);
  }
}

TEST_CASE("a ladder ends with what is wanted, unless its topology is kept at any cost") {
  const ClimbBench bench(part_of_spheres(60));
  constexpr std::uint64_t k_end = 390;
  for (const TopologyMode mode : {TopologyMode::keep_while_fair, TopologyMode::simplify}) {
    const ClimbedPart climbed = bench.climb(mode, k_end);
    CHECK(climbed.summary.end == LadderEnd::enough);
    REQUIRE(climbed.summary.rungs.size() >= 2);
    CHECK(climbed.last().triangles <= k_end);
    CHECK(climbed.summary.rungs[climbed.summary.rungs.size() - 2].triangles > k_end);
  }
  const ClimbedPart kept = bench.climb(TopologyMode::keep, k_end);
  CHECK_FALSE(kept.summary.goes_on());
  CHECK(kept.last().triangles < 300);
  // Each rung of a ladder tells how much had been refused for that by then.
  CHECK(kept.last().refused > kept.first().refused);
  CHECK(bench.climb(TopologyMode::simplify).last().refused == 0);
}

TEST_CASE("a ladder ends where too much is going to be refused, if that is foreseen") {
  const ClimbBench bench(part_of_spheres(60));
  constexpr std::uint64_t k_wanted = 250;
  const ClimbedPart whole = bench.climb(TopologyMode::keep_while_fair);
  const ClimbedPart early = bench.climb(TopologyMode::keep_while_fair, 0, k_wanted);
  CHECK(early.summary.end == LadderEnd::refusals);
  CHECK(early.last().triangles > whole.last().triangles);
  CHECK(refused_by(early.last(), k_wanted) > 4 * k_wanted);
  // It is the first such rung.
  REQUIRE(early.summary.rungs.size() >= 2);
  const Rung& before = early.summary.rungs[early.summary.rungs.size() - 2];
  CHECK(refused_by(before, k_wanted) <= 4 * k_wanted);
  // Not if all of it is wanted, nor if the topology is given up, or kept, anyhow.
  CHECK(bench.climb(TopologyMode::keep_while_fair, 0, 100'000).summary.end == LadderEnd::floor);
  CHECK(bench.climb(TopologyMode::simplify, 0, k_wanted).summary.end == LadderEnd::floor);
  CHECK(bench.climb(TopologyMode::keep, 0, k_wanted).summary.end == LadderEnd::floor);
}

TEST_CASE("a rung below which all is refused tells so, also where it is the unchanged part") {
  Part apart;  // single triangles: no edge can collapse
  apart.boundary_vertices = 0;
  apart.positions = PositionType::float32;
  for (std::uint32_t i = 0; i < 500; ++i) {
    const Vec3 at = {3.0 * i, 0, 0};
    for (const Vec3& p : {at, at + Vec3{1, 0, 0}, at + Vec3{0, 1, 0}}) {
      apart.mesh.positions.push_back(p);
    }
    apart.mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  for (const std::uint64_t start : {400, 500}) {
    const ClimbBench bench(apart);
    const ClimbedPart climbed = bench.climb(TopologyMode::keep_while_fair, 0, 250, start);
    REQUIRE(climbed.summary.rungs.size() == 1);
    CHECK(climbed.last().triangles == 500);
    CHECK(climbed.last().refused >= 500);
    CHECK(climbed.summary.end == LadderEnd::refusals);
    CHECK((climbed.last().level == k_input_level) == (start == 500));
  }
}

TEST_CASE("a ladder that ended for what is refused goes on from its last rung") {
  const ClimbBench bench(part_of_spheres(60));
  const ClimbedPart early = bench.climb(TopologyMode::keep_while_fair, 0, 250);
  REQUIRE(early.summary.rungs.size() >= 2);
  const auto last = static_cast<std::uint32_t>(early.summary.rungs.size() - 1);
  const ClimbedPart on = bench.climb_on(early, TopologyMode::keep_while_fair, last);
  CHECK(on.first().level == early.last().level);
  CHECK(on.first().triangles == early.last().triangles);
  CHECK(bench.mesh_of(on, 0).mesh.triangles == bench.mesh_of(early, last).mesh.triangles);
  CHECK(on.last().triangles < early.last().triangles);
  const ResultMesh coarsest = bench.mesh_of(on, on.summary.rungs.size() - 1);
  CHECK(measure_topology(coarsest.mesh).components == 60);
}

TEST_CASE("what begins at a rung has the part's boundary vertices and points") {
  const ClimbBench bench(part_of_spheres(60));
  const ClimbedPart kept = bench.climb(TopologyMode::keep_while_fair);
  const ClimbedPart on = bench.climb_on(kept, TopologyMode::simplify);
  const ResultMesh from = bench.mesh_of(kept, 0);
  const ResultMesh to = bench.mesh_of(on, on.summary.rungs.size() - 1);
  CHECK(to.boundary_vertices == k_boundary);
  for (std::uint32_t v = 0; v < k_boundary; ++v) {
    CHECK(to.mesh.positions[v] == from.mesh.positions[v]);
  }
  REQUIRE(to.samples.size() == 1);
  CHECK(to.samples[0].area == from.samples[0].area);
  CHECK(to.samples[0].points == from.samples[0].points);
  CHECK_THROWS_AS(bench.mesh_of(on, on.summary.rungs.size()), DataError);
}
