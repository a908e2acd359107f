// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A finish made of jobs, without processes. With Composition::sink every part is a piece.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/geometry/value_error.hpp>
#include <meshfarm/geometry/vertex_normals.hpp>
#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/pipeline/assemble.hpp>
#include <meshfarm/pipeline/job_table.hpp>
#include <meshfarm/pipeline/run_graph.hpp>
#include <meshfarm/util/file.hpp>

#include "support/memory_source.hpp"
#include "support/meshes.hpp"
#include "support/next_jobs.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

/// A stage, and runs on it.
class FinishBench {
 public:
  FinishBench(const Mesh& mesh, std::uint32_t parts) : FinishBench(mesh, {.parts = parts}) {}
  FinishBench(const Mesh& mesh, const CutOptions& options)
      : stage_(Stage::create(folder_.path() / "stage")) {
    test::MemorySource source(mesh);
    manifest_ = cut_mesh(source, stage_, options);
  }

  static RunOptions bounded(double share) {
    return {.error = {share, true}, .finish_place = FinishPlace::farm};
  }
  static RunOptions farmed(std::uint64_t triangles) {
    return {.triangles = triangles,
            .finish_place = FinishPlace::farm,
            .composition = Composition::sink};
  }

  /// In the order in which they are asked for, or the other way round; then the sink that ends the
  /// run is not the one that did its jobs.
  RunSummary run(const RunOptions& options, const std::string& name, bool backwards = false) {
    const JobSource jobs_of = make_job_source(manifest_, options);
    const JobContext context{stage_, 1, ++incarnation_, [](std::uint64_t) { return true; }};
    std::vector<AcceptedJob> accepted;
    kinds_.clear();
    std::filesystem::remove(path(name));
    const AssembleOptions output{.output = {path(name)}, .threads = 1};
    auto sink = std::make_unique<Assembler>(stage_, manifest_, options, output);
    for (std::vector<Job> jobs = test::next_jobs(jobs_of, accepted); !jobs.empty();
         jobs = test::next_jobs(jobs_of, accepted)) {
      if (backwards) std::reverse(jobs.begin(), jobs.end());
      for (const Job& job : jobs) {
        ++kinds_[job.kind];
        const JobOutput made =
            job.by_sink ? sink->do_job(job, context, accepted) : do_job(job, context);
        accepted.push_back({key_of(job), made});
        check_output(job.kind, accepted.back().output);
      }
    }
    CHECK_FALSE(std::filesystem::exists(path(name)));  // before the end
    if (backwards) sink = std::make_unique<Assembler>(stage_, manifest_, options, output);
    return sink->complete(accepted);
  }

  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  Mesh mesh(const std::string& name) const { return read_mesh(*open_mesh(path(name))); }
  std::map<std::string, int>& kinds() { return kinds_; }

 private:
  test::TempFolder folder_;
  Stage stage_;
  Manifest manifest_;
  std::uint64_t incarnation_ = 0;
  std::map<std::string, int> kinds_;
};

void check_clean(const Topology& t) {
  CHECK(t.components == 1);
  CHECK(t.nonmanifold_edges == 0);
  CHECK(t.orientation_conflicts == 0);
  CHECK(t.degenerate + t.zero_area + t.duplicate == 0);
}

/// So many parts, or streams that are swept.
std::vector<CutOptions> both_schemes(std::uint32_t parts) {
  return {{.parts = parts}, {.scheme = Scheme::stream, .parts = parts, .window_triangles = 1'500}};
}

double diagonal_of(const Mesh& mesh) {
  Box box;
  for (const Vec3& p : mesh.positions) box.add(p);
  return box.diagonal();
}

/// A torus, and another just inside of it that faces the other way.
Mesh thin_shell() {
  Mesh shell = test::torus(180, 120);
  Mesh inner = test::torus(180, 120);
  const double thickness = 0.002 * diagonal_of(shell);
  const std::vector<Vec3> normals = vertex_normals(inner);
  for (std::size_t v = 0; v < inner.positions.size(); ++v) {
    inner.positions[v] = inner.positions[v] - normals[v] * thickness;
  }
  for (Triangle& t : inner.triangles) std::swap(t[1], t[2]);
  append_surface(inner.positions, inner.triangles, shell);
  return shell;
}

Mesh waves(std::uint32_t side) {
  Mesh mesh = test::grid(side, side);
  for (Vec3& p : mesh.positions) p.z = 2 * std::sin(p.x * 0.11) * std::cos(p.y * 0.07);
  return mesh;
}

}  // namespace

TEST_CASE("pieces make a closed surface of the count, as good as the sink's") {
  const Mesh torus = test::torus(240, 160);
  FinishBench bench(torus, 6);
  const RunSummary made = bench.run(FinishBench::farmed(16'000), "farm.ply");
  CHECK(bench.kinds()["split"] == 6);
  CHECK(bench.kinds()["seam"] == 1);
  CHECK(bench.kinds()["reduce"] >= 7);
  CHECK(bench.kinds()["measure"] == 7);
  CHECK(bench.kinds()["write"] == 1);
  CHECK(made.finished_in_pieces == 7);
  CHECK(made.triangles == 16'000);
  CHECK(made.why_not_exact.empty());
  const Mesh mesh = bench.mesh("farm.ply");
  const Topology t = measure_topology(mesh);
  check_clean(t);
  CHECK(t.triangles == 16'000);
  CHECK(t.euler == 0);
  CHECK(t.border_edges == 0);
  CHECK(made.vertices == mesh.positions.size());

  const RunSummary here = bench.run({.triangles = 16'000}, "here.ply");
  CHECK(here.finished_in_pieces == 0);
  CHECK(made.error.greater().rms < 1.1 * here.error.greater().rms);
  // It is what is measured with more points and in one place.
  const DistanceOptions many{.samples = 100'000, .threads = 1};
  const Distance forth = measure_distance(torus, mesh, many);
  const Distance back = measure_distance(mesh, torus, many);
  CHECK(made.error.to_output.rms == doctest::Approx(forth.rms).epsilon(0.03));
  CHECK(made.error.to_input.rms == doctest::Approx(back.rms).epsilon(0.03));
  CHECK(made.error.input_samples > 90'000);
  REQUIRE(made.error.to_input_quantiles);
  const SurfaceError all = measure_error({mesh, {}}, {torus, {}}, {}, many);
  CHECK(made.error.to_input_quantiles->p95 == doctest::Approx(all.quantiles.p95).epsilon(0.05));
  CHECK(made.error.to_input_quantiles->p99 == doctest::Approx(all.quantiles.p99).epsilon(0.08));
  REQUIRE(made.error.to_output_quantiles);
  const SurfaceError forth_all = measure_error({torus, {}}, {mesh, {}}, {}, many);
  CHECK(made.error.to_output_quantiles->p95 ==
        doctest::Approx(forth_all.quantiles.p95).epsilon(0.05));
  for (const ErrorOfPiece& each : made.pieces) {
    for (const auto& [distance, quantiles] : {std::pair(each.to_output, each.to_output_quantiles),
                                              std::pair(each.to_input, each.to_input_quantiles)}) {
      CHECK(distance.mean < quantiles.p95);
      CHECK(quantiles.p95 < quantiles.p99);
      CHECK(quantiles.p99 <= distance.max);
    }
  }
  REQUIRE(made.pieces.size() == 7);
  CHECK(made.pieces.front().first_part == 0);
  CHECK(made.pieces.back().parts == 0);
}

TEST_CASE("pieces are made of streams, swept or climbed, sorted before or by jobs") {
  const Mesh torus = test::torus(240, 160);
  std::string bytes;
  for (const SortAt sort : {SortAt::here, SortAt::farm}) {
    for (const std::uint64_t window : {3'000, 100'000}) {
      CAPTURE(window);
      FinishBench bench(
          torus, {.scheme = Scheme::stream, .parts = 6, .sort = sort, .window_triangles = window});
      const RunSummary made = bench.run(FinishBench::farmed(16'000), "farm.ply");
      CHECK(bench.kinds()["sort"] == (sort == SortAt::farm ? 6 : 0));
      CHECK(bench.kinds()["sweep"] == (window == 3'000 ? 6 : 0));
      CHECK(bench.kinds()["split"] >= 6);
      CHECK(bench.kinds()["measure"] == 7);
      CHECK(made.finished_in_pieces == 7);
      CHECK(made.triangles == 16'000);
      const Mesh mesh = bench.mesh("farm.ply");
      const Topology t = measure_topology(mesh);
      check_clean(t);
      CHECK(t.triangles == 16'000);
      CHECK(t.euler == 0);
      CHECK(t.border_edges == 0);
      RunOptions options = FinishBench::farmed(16'000);
      options.finish_place = FinishPlace::here;
      const RunSummary here = bench.run(options, "here.ply");
      CHECK(here.finished_in_pieces == 0);
      CHECK(made.error.greater().rms < 1.1 * here.error.greater().rms);
      const DistanceOptions many{.samples = 100'000, .threads = 1};
      CHECK(made.error.to_output.rms ==
            doctest::Approx(measure_distance(torus, mesh, many).rms).epsilon(0.03));
      CHECK(made.error.to_input.rms ==
            doctest::Approx(measure_distance(mesh, torus, many).rms).epsilon(0.03));
      bench.run(FinishBench::farmed(16'000), "again.ply", true);
      CHECK(read_file(bench.path("again.ply")) == read_file(bench.path("farm.ply")));
      if (window != 3'000) continue;
      if (bytes.empty()) bytes = read_file(bench.path("farm.ply"));
      CHECK(read_file(bench.path("farm.ply")) == bytes);
    }
  }
}

TEST_CASE("bytes and figures do not depend on the order of jobs, nor on who does them") {
  FinishBench bench(waves(90), 5);
  const RunSummary made = bench.run(FinishBench::farmed(4'001), "a.ply");
  const RunSummary again = bench.run(FinishBench::farmed(4'001), "b.ply", true);
  CHECK(read_file(bench.path("a.ply")) == read_file(bench.path("b.ply")));
  CHECK(made.error.to_output.rms == again.error.to_output.rms);
  CHECK(made.error.to_input.rms == again.error.to_input.rms);
  CHECK(made.error.to_input.max == again.error.to_input.max);
}

TEST_CASE("the surroundings of many seams are several groups, between which nothing is lost") {
  const Mesh torus = test::torus(480, 320);
  FinishBench bench(torus, 24);
  const RunSummary made = bench.run(FinishBench::farmed(120'000), "a.ply");
  CHECK(bench.kinds()["seam"] >= 2);
  CHECK(bench.kinds()["seam"] < 24);
  CHECK(made.finished_in_pieces == 24 + static_cast<std::uint64_t>(bench.kinds()["seam"]));
  CHECK(made.triangles == 120'000);
  const Mesh mesh = bench.mesh("a.ply");
  const Topology t = measure_topology(mesh);
  check_clean(t);
  CHECK(t.triangles == 120'000);
  CHECK(t.euler == 0);
  CHECK(t.border_edges == 0);
  const DistanceOptions many{.samples = 50'000, .threads = 1};
  CHECK(made.error.to_output.rms ==
        doctest::Approx(measure_distance(torus, mesh, many).rms).epsilon(0.03));
  bench.run(FinishBench::farmed(120'000), "b.ply", true);
  CHECK(read_file(bench.path("a.ply")) == read_file(bench.path("b.ply")));
}

TEST_CASE("an odd count needs an open border somewhere") {
  FinishBench open(waves(90), 5);
  CHECK(open.run(FinishBench::farmed(4'001), "open.ply").triangles == 4'001);
  const Topology t = measure_topology(open.mesh("open.ply"));
  check_clean(t);
  CHECK(t.euler == 1);
  FinishBench closed(test::torus(120, 80), 4);
  const RunSummary made = closed.run(FinishBench::farmed(4'001), "closed.ply");
  CHECK(made.triangles == 4'000);
  CHECK_FALSE(made.why_not_exact.empty());
}

TEST_CASE("one piece has no seams") {
  FinishBench bench(waves(60), 1);
  const RunSummary made = bench.run(FinishBench::farmed(1'000), "o.ply");
  CHECK(bench.kinds()["seam"] == 0);
  CHECK(made.finished_in_pieces == 1);
  CHECK(made.triangles == 1'000);
  CHECK(made.error.output_samples > 10'000);
}

TEST_CASE("neighbours are composed until they are large enough for a piece") {
  FinishBench bench(waves(90), 8);
  RunOptions options = FinishBench::farmed(4'000);
  options.composition = Composition::automatic;
  const RunSummary made = bench.run(options, "o.ply");
  CHECK(bench.kinds()["compose"] > 0);
  CHECK(made.finished_in_pieces == 1);
  CHECK(made.triangles == 4'000);
}

TEST_CASE("every format is written from pieces") {
  FinishBench bench(waves(60), 4);
  for (const std::string name : {"o.obj", "o.off", "o.stl", "o.gltf", "o.glb"}) {
    CAPTURE(name);
    CHECK(bench.run(FinishBench::farmed(2'000), name).triangles == 2'000);
    const Mesh mesh = bench.mesh(name);
    CHECK(mesh.triangles.size() == 2'000);
    for (const Vec3& p : mesh.positions) CHECK(std::abs(p.z) < 2.1);
  }
}

TEST_CASE("open borders and creases across pieces stay where they are to") {
  for (const CutOptions& cut : both_schemes(4)) {
    FinishBench bench(waves(60), cut);
    RunOptions options = FinishBench::farmed(2'000);
    options.lines.preserve_border = true;
    const RunSummary made = bench.run(options, "border.ply");
    CHECK(made.triangles == 2'000);
    CHECK(made.finished_in_pieces == 5);
    CHECK(measure_topology(bench.mesh("border.ply")).border_edges == 4 * 60);
  }

  Mesh roof = test::grid(80, 80);  // its ridge crosses all parts
  for (Vec3& p : roof.positions) {
    const double away = std::abs(p.x - 40);
    p.z = 30 - away + 0.01 * std::min(away, 2.0) * std::sin(p.y * 0.9 + p.x);
  }
  const auto lying_across = [](const Mesh& mesh) {
    return std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
      const auto x = [&](std::size_t k) { return mesh.positions[t[k]].x; };
      const double tolerance = 1e-3;
      return std::min({x(0), x(1), x(2)}) < 40 - tolerance &&
             std::max({x(0), x(1), x(2)}) > 40 + tolerance;
    });
  };
  for (const CutOptions& cut : both_schemes(5)) {
    FinishBench ridge(roof, cut);
    RunOptions options = FinishBench::farmed(1'500);
    options.lines.crease_angle = 40;
    CHECK(ridge.run(options, "roof.ply").triangles == 1'500);
    CHECK(ridge.kinds()["split"] >= 5);
    CHECK(lying_across(ridge.mesh("roof.ply")) == 0);
    options.finish_place = FinishPlace::here;
    CHECK(ridge.run(options, "here.ply").triangles == 1'500);
    CHECK(lying_across(ridge.mesh("here.ply")) == 0);
  }
}

TEST_CASE("triangles keep their labels, whose lines cross pieces") {
  Mesh mesh = waves(90);
  for (const Triangle& t : mesh.triangles) {
    double y = 0;
    for (const std::uint32_t v : t) y += mesh.positions[v].y / 3;
    mesh.columns.labels.push_back(y < 45 ? 3 : 5);
  }
  for (const CutOptions& cut : both_schemes(5)) {
    FinishBench bench(mesh, cut);
    const RunSummary made = bench.run(FinishBench::farmed(4'000), "farm.ply");
    CHECK(bench.kinds()["write"] == 0);
    CAPTURE(made.why_finished_here);
    CHECK(made.finished_in_pieces == 6);
    CHECK(made.triangles == 4'000);
    CHECK(made.labels->name == "region");
    const Mesh result = bench.mesh("farm.ply");
    REQUIRE(result.columns.labels.size() == 4'000);
    for (std::size_t i = 0; i < result.triangles.size(); ++i) {
      double y = 0;
      for (const std::uint32_t v : result.triangles[i]) y += result.positions[v].y / 3;
      if (std::abs(y - 45) > 0.01) CHECK(result.columns.labels[i] == (y < 45 ? 3U : 5U));
    }
    check_clean(measure_topology(result));
  }
}

TEST_CASE("small components are left out whole, though they span pieces") {
  Mesh mesh = waves(150);
  const Mesh ball = test::icosphere(2);
  const auto add_ball = [&](Vec3 centre, double radius) {
    std::vector<Vec3> positions;
    positions.reserve(ball.positions.size());
    for (const Vec3& p : ball.positions) positions.push_back(centre + p * radius);
    append_surface(positions, ball.triangles, mesh);
  };
  for (int i = 0; i < 25; ++i) {
    add_ball({15.0 + 30 * (i % 5), 15.0 + 30 * (i / 5), 9}, i % 6 == 0 ? 5 : 3);
  }
  for (const CutOptions& cut : both_schemes(6)) {
    FinishBench bench(mesh, cut);
    RunOptions options = FinishBench::farmed(15'001);
    options.drop_components = {12, false};  // of the smaller balls the diagonals are 10.4
    const RunSummary made = bench.run(options, "farm.ply");
    CHECK(bench.kinds()["components"] == 1);
    CHECK(made.why_finished_here.empty());
    CHECK(made.finished_in_pieces == 7);
    CHECK(made.triangles == 15'001);
    CHECK(made.dropped_components.components == 20);
    const Topology t = measure_topology(bench.mesh("farm.ply"));
    CHECK(t.components == 1 + 5);
    CHECK(t.border_edges > 0);
    CHECK(t.euler == 1 + 5 * 2);
    bench.run(options, "again.ply", true);
    CHECK(read_file(bench.path("farm.ply")) == read_file(bench.path("again.ply")));
    options.finish_place = FinishPlace::here;
    const RunSummary here = bench.run(options, "here.ply");
    CHECK(here.dropped_components.components == 20);
    CHECK(here.triangles == 15'001);
  }
}

TEST_CASE("handles and small pieces go in pieces, where the count is not met with them") {
  Mesh mesh = waves(120);
  const Mesh ring = test::torus(12, 8);
  for (int i = 0; i < 36; ++i) {
    const Vec3 centre = {10.0 + 20 * (i % 6), 10.0 + 20 * (i / 6), 12};
    std::vector<Vec3> positions;
    for (const Vec3& p : ring.positions) positions.push_back(centre + p * 0.5);
    append_surface(positions, ring.triangles, mesh);
  }
  for (const CutOptions& cut : both_schemes(5)) {
    FinishBench bench(mesh, cut);
    const auto farmed = [&](std::uint64_t triangles, TopologyMode topology) {
      RunOptions options = FinishBench::farmed(triangles);
      options.lines.topology = topology;
      return bench.run(options, "o.ply");
    };
    // A ring has 14 triangles at least.
    RunSummary made = farmed(2'000, TopologyMode::automatic);
    CHECK(made.finished_in_pieces == 6);
    CHECK(made.triangles == 2'000);
    CHECK_FALSE(made.topology_simplified);
    CHECK(measure_topology(bench.mesh("o.ply")).components == 37);
    for (const TopologyMode topology : {TopologyMode::automatic, TopologyMode::simplify}) {
      made = farmed(300, topology);
      CAPTURE(made.why_finished_here);
      CHECK(made.finished_in_pieces == 6);
      CHECK(made.triangles == 300);
      CHECK(made.topology_simplified);
      const Topology t = measure_topology(bench.mesh("o.ply"));
      CHECK(t.nonmanifold_edges == 0);
      CHECK(t.degenerate + t.zero_area + t.duplicate == 0);
    }
    made = farmed(300, TopologyMode::keep);
    CHECK(made.finished_in_pieces == 0);
    CHECK(made.triangles > 300);
  }
}

TEST_CASE("what pieces have no way for is the sink's, and it says why") {
  FinishBench bench(waves(60), 4);
  RunOptions options = FinishBench::farmed(2'000);
  RunOptions here = options;
  const auto expect_here = [&] {
    here = options;
    here.finish_place = FinishPlace::here;
    const RunSummary made = bench.run(options, "farm.ply");
    CHECK(made.finished_in_pieces == 0);
    CHECK_FALSE(made.why_finished_here.empty());
    CHECK(bench.kinds()["split"] == 0);
    CHECK(bench.run(here, "here.ply").why_finished_here.empty());
    CHECK(read_file(bench.path("farm.ply")) == read_file(bench.path("here.ply")));
  };
  options = FinishBench::bounded(0.01);
  options.lines.topology = TopologyMode::simplify;
  expect_here();
  options = FinishBench::farmed(2'000);
  options.allocation = Allocation::uniform;
  expect_here();
}

TEST_CASE("pieces keep a bound on the error, with about as few triangles as the sink") {
  const Mesh torus = test::torus(240, 160);
  FinishBench bench(torus, 6);
  const double bound = 0.002 * diagonal_of(torus);
  const RunSummary made = bench.run(FinishBench::bounded(0.002), "farm.ply");
  CHECK(bench.kinds()["split"] == 6);
  CHECK(bench.kinds()["seam"] == 1);
  CHECK(bench.kinds()["reduce"] == 7);
  CHECK(bench.kinds()["measure"] == 7);
  CHECK(made.finished_in_pieces == 7);
  CHECK(made.why_not_exact.empty());
  CHECK(made.max_error == doctest::Approx(bound));
  CHECK(made.certified_error == 0);
  const Mesh mesh = bench.mesh("farm.ply");
  const Topology t = measure_topology(mesh);
  check_clean(t);
  CHECK(t.euler == 0);
  CHECK(t.border_edges == 0);
  CHECK(made.triangles == mesh.triangles.size());
  CHECK(made.vertices == mesh.positions.size());

  RunOptions options = FinishBench::bounded(0.002);
  options.finish_place = FinishPlace::here;
  const RunSummary here = bench.run(options, "here.ply");
  CHECK(made.stitched == here.stitched);
  CHECK(made.triangles < 1.03 * static_cast<double>(here.triangles));
  CHECK(made.triangles < made.stitched / 2);
  const DistanceOptions many{.samples = 100'000, .threads = 1};
  const double forth = measure_distance(torus, mesh, many).max;
  const double back = measure_distance(mesh, torus, many).max;
  CHECK(std::max(forth, back) < bound);
  CHECK(made.error.greater().max > 0.99 * std::max(forth, back));
  CHECK(made.error.greater().max < bound);
  CHECK(made.error.output_samples > 150'000);

  bench.run(FinishBench::bounded(0.002), "again.ply", true);
  CHECK(read_file(bench.path("farm.ply")) == read_file(bench.path("again.ply")));
}

TEST_CASE("a bound on the error is proven piece by piece and seam by seam") {
  const Mesh shell = thin_shell();  // half as thick as the bound: either wall is near the other
  FinishBench bench(shell, 14);
  RunOptions options = FinishBench::bounded(0.004);
  const double bound = 0.004 * diagonal_of(shell);
  options.certify = true;
  const RunSummary made = bench.run(options, "farm.ply");
  CHECK(made.finished_in_pieces > 14);
  CHECK(made.certified_error == doctest::Approx(bound));
  const Mesh mesh = bench.mesh("farm.ply");
  const HausdorffOptions enough{.enough = bound, .threads = 1};
  CHECK(bound_distance(shell, mesh, enough).upper <= bound * 1.0001);
  CHECK(bound_distance(mesh, shell, enough).upper <= bound * 1.0001);
  const Topology t = measure_topology(mesh);
  CHECK(t.components == 2);
  CHECK(t.border_edges == 0);
  CHECK(t.nonmanifold_edges == 0);
  options.finish_place = FinishPlace::here;
  CHECK(made.triangles < 1.05 * static_cast<double>(bench.run(options, "here.ply").triangles));
}

TEST_CASE("under a bound the surroundings of many seams are several groups, too") {
  constexpr double k_bound = 0.03;
  Mesh rough = waves(190);
  for (std::size_t v = 0; v < rough.positions.size(); ++v) {
    rough.positions[v].z += 0.2 * static_cast<double>(v * 2654435769U % 1024) / 1024;
  }
  FinishBench bench(rough, 80);
  RunOptions options{.error = {k_bound, false}, .certify = true, .finish_place = FinishPlace::farm};
  const RunSummary made = bench.run(options, "a.ply");
  CHECK(bench.kinds()["seam"] >= 2);
  CHECK(bench.kinds()["seam"] < 80);
  CHECK(made.finished_in_pieces == 80 + static_cast<std::uint64_t>(bench.kinds()["seam"]));
  CHECK(made.triangles < made.stitched);
  const Mesh mesh = bench.mesh("a.ply");
  const Topology t = measure_topology(mesh);
  check_clean(t);
  CHECK(t.triangles == made.triangles);
  CHECK(t.euler == 1);
  const HausdorffOptions enough{.enough = k_bound, .threads = 1};
  CHECK(bound_distance(rough, mesh, enough).upper <= 1.0001 * k_bound);
  CHECK(bound_distance(mesh, rough, enough).upper <= 1.0001 * k_bound);
  bench.run(options, "b.ply", true);
  CHECK(read_file(bench.path("a.ply")) == read_file(bench.path("b.ply")));
}

TEST_CASE("under a bound borders and creases stay, and small components go") {
  FinishBench bench(waves(60), 4);
  RunOptions options = FinishBench::bounded(0.002);
  options.lines.preserve_border = true;
  bench.run(options, "border.ply");
  CHECK(measure_topology(bench.mesh("border.ply")).border_edges == 4 * 60);

  Mesh sheet = waves(80);
  const Mesh ball = test::icosphere(2);
  for (int i = 0; i < 9; ++i) {
    std::vector<Vec3> positions;
    const Vec3 centre = {15.0 + 25 * (i % 3), 15.0 + 25 * (i / 3), 9};
    for (const Vec3& p : ball.positions) positions.push_back(centre + p * (i % 2 == 0 ? 5 : 3));
    append_surface(positions, ball.triangles, sheet);
  }
  FinishBench with_balls(sheet, 5);
  options = FinishBench::bounded(0.002);
  options.drop_components = {12, false};
  for (const FinishPlace place : {FinishPlace::farm, FinishPlace::here}) {
    options.finish_place = place;
    const RunSummary made = with_balls.run(options, "balls.ply");
    CHECK(made.dropped_components.components == 4);
    const Topology t = measure_topology(with_balls.mesh("balls.ply"));
    CHECK(t.components == 1 + 5);
    CHECK(t.euler == 1 + 5 * 2);
    CHECK(t.nonmanifold_edges == 0);
    // What was left out is far from the rest, and told.
    CHECK(made.error.to_output.max > 3);
    CHECK(made.error.to_input.max < made.max_error);
  }
}

TEST_CASE("under a bound one piece is finished as it is, and so is a plane of nothing but seams") {
  FinishBench one(waves(60), 1);
  CHECK(one.run(FinishBench::bounded(0.002), "one.ply").finished_in_pieces == 1);
  CHECK(one.kinds()["seam"] == 0);
  RunOptions here = FinishBench::bounded(0.002);
  here.finish_place = FinishPlace::here;
  one.run(here, "here.ply");
  CHECK(one.mesh("one.ply").triangles == one.mesh("here.ply").triangles);

  FinishBench plane(test::grid(60, 60), 5);
  const RunSummary made = plane.run(FinishBench::bounded(0.001), "plane.ply");
  CHECK(made.finished_in_pieces == 6);
  CHECK(made.triangles == 2);
  CHECK(made.error.greater().max < 1e-3);
}

TEST_CASE("with a bound it is the sink that finishes what it holds well, or too many parts") {
  FinishBench few(waves(60), 4);
  RunOptions options = FinishBench::bounded(0.002);
  options.finish_place = FinishPlace::automatic;
  const RunSummary made = few.run(options, "few.ply");
  CHECK(made.finished_in_pieces == 0);
  CHECK(made.why_finished_here.empty());
  FinishBench many(waves(120), 440);
  const RunSummary by_sink = many.run(FinishBench::bounded(0.002), "many.ply");
  CHECK(by_sink.finished_in_pieces == 0);
  CHECK(by_sink.why_finished_here == "there are more pieces than a job can name");
}

TEST_CASE("more than there is cannot be asked of pieces") {
  FinishBench bench(waves(40), 3);
  const RunSummary made = bench.run(FinishBench::farmed(100'000), "o.ply");
  CHECK(made.finished_in_pieces == 0);
  CHECK(made.triangles == 3'200);
  CHECK_FALSE(made.why_finished_here.empty());
}
