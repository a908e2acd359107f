// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A finish that consists of jobs, to a bound on the error.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/geometry/vertex_normals.hpp>
#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/util/file.hpp>

#include "finish_bench.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;
using meshfarm::test::both_schemes;
using meshfarm::test::check_clean;
using meshfarm::test::FinishBench;
using meshfarm::test::waves;

namespace {

double diagonal_of(const Mesh& mesh) {
  Box box;
  for (const Vec3& p : mesh.positions) box.add(p);
  return box.diagonal();
}

/// A torus, and another just inside of it that faces the other way.
Mesh thin_shell() {
  Mesh shell = test::torus(150, 100);
  Mesh inner = test::torus(150, 100);
  const double thickness = 0.002 * diagonal_of(shell);
  const std::vector<Vec3> normals = vertex_normals(inner);
  for (std::size_t v = 0; v < inner.positions.size(); ++v) {
    inner.positions[v] = inner.positions[v] - normals[v] * thickness;
  }
  for (Triangle& t : inner.triangles) std::swap(t[1], t[2]);
  append_surface(inner.positions, inner.triangles, shell);
  return shell;
}

}  // namespace

TEST_CASE("pieces keep a bound on the error, with about as few triangles as the sink") {
  const Mesh torus = test::torus(180, 120);
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
  const Mesh shell = thin_shell();  // half as thick as the bound: each wall is near the other
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

TEST_CASE("streams keep a bound in pieces, swept or proven, sorted before or by jobs") {
  const Mesh torus = test::torus(160, 110);
  const double bound = 0.002 * diagonal_of(torus);
  for (const bool certify : {false, true}) {
    std::string bytes;
    for (const SortAt sort : {SortAt::here, SortAt::farm}) {
      FinishBench bench(
          torus, {.scheme = Scheme::stream, .parts = 6, .sort = sort, .window_triangles = 2'000});
      RunOptions options = FinishBench::bounded(0.002);
      options.certify = certify;
      const RunSummary made = bench.run(options, "farm.ply");
      CHECK((bench.kinds()["sweep"] > 0) != certify);  // a proof needs a stream in memory
      CHECK(made.finished_in_pieces == 7);
      const Mesh mesh = bench.mesh("farm.ply");
      const Topology t = measure_topology(mesh);
      check_clean(t);
      CHECK(t.euler == 0);
      CHECK(t.border_edges == 0);
      if (certify) {
        CHECK(made.certified_error == doctest::Approx(bound));
        const HausdorffOptions enough{.enough = bound, .threads = 1};
        CHECK(bound_distance(torus, mesh, enough).upper <= bound * 1.0001);
        CHECK(bound_distance(mesh, torus, enough).upper <= bound * 1.0001);
      } else {
        const DistanceOptions many{.samples = 100'000, .threads = 1};
        CHECK(measure_distance(torus, mesh, many).max < 1.1 * bound);
        CHECK(measure_distance(mesh, torus, many).max < 1.1 * bound);
      }
      options.finish_place = FinishPlace::here;
      const RunSummary here = bench.run(options, "here.ply");
      CHECK(made.triangles < 1.05 * static_cast<double>(here.triangles));
      if (bytes.empty()) bytes = read_file(bench.path("farm.ply"));
      CHECK(read_file(bench.path("farm.ply")) == bytes);
    }
  }
}

TEST_CASE("under a bound creases that cross pieces stay where they are") {
  Mesh roof = test::grid(80, 80);
  for (Vec3& p : roof.positions) {
    const double away = std::abs(p.x - 40);
    p.z = 30 - away + 0.01 * std::min(away, 2.0) * std::sin(p.y * 0.9 + p.x);
  }
  for (const CutOptions& cut : both_schemes(5)) {
    FinishBench bench(roof, cut);
    RunOptions options = FinishBench::bounded(0.002);
    options.lines.crease_angle = 40;
    const RunSummary made = bench.run(options, "roof.ply");
    CHECK(made.finished_in_pieces == 6);
    const Mesh mesh = bench.mesh("roof.ply");
    double ridge = 0;  // its length, by the edges on it
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& a = mesh.positions[t[k]];
        const Vec3& b = mesh.positions[t[(k + 1) % 3]];
        if (std::abs(a.x - 40) < 1e-3 && std::abs(b.x - 40) < 1e-3) ridge += length(b - a) / 2;
      }
    }
    CHECK(ridge == doctest::Approx(80).epsilon(1e-3));
  }
}

TEST_CASE("under a bound borders stay, and small components go") {
  RunOptions options = FinishBench::bounded(0.002);
  options.lines.preserve_border = true;
  for (const CutOptions& cut : both_schemes(4)) {
    FinishBench bench(waves(60), cut);
    CHECK(bench.run(options, "border.ply").finished_in_pieces == 5);
    CHECK(measure_topology(bench.mesh("border.ply")).border_edges == 4 * 60);
  }

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
    // The components left out are far from the rest, and the summary tells it.
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
