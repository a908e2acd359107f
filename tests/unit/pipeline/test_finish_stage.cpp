// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A finish that consists of jobs, to a count.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/geometry/value_error.hpp>
#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/util/file.hpp>

#include "finish_bench.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;
using meshfarm::test::both_schemes;
using meshfarm::test::check_clean;
using meshfarm::test::FinishBench;
using meshfarm::test::waves;

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
  // The same error is measured with more points and in one place.
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
    options.drop_components = {12, false};  // the smaller balls' diagonals are 10.4
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
    // A ring has at least 14 triangles.
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

TEST_CASE("vertices are fitted, in pieces and by the sink, and by nobody where that is off") {
  for (const CutOptions& options : both_schemes(4)) {
    FinishBench bench(waves(160), options);
    const auto rms_of = [&](VertexFit fit, FinishPlace place) {
      RunOptions run = FinishBench::farmed(3'000);
      run.fit = fit;
      run.finish_place = place;
      const RunSummary made = bench.run(run, "o.ply");
      CHECK(made.triangles == 3'000);
      CHECK((made.finished_in_pieces > 0) == (place == FinishPlace::farm));
      CHECK((made.fitted_vertices > 0) == (fit != VertexFit::off && place == FinishPlace::here));
      check_clean(measure_topology(bench.mesh("o.ply")));
      return made.error.greater().rms;
    };
    for (const FinishPlace place : {FinishPlace::here, FinishPlace::farm}) {
      CAPTURE(place);
      const double off = rms_of(VertexFit::off, place);
      // In pieces, the surroundings of seams are not fitted: a large share of so small a mesh.
      const double share = place == FinishPlace::here ? 0.98 : 0.997;
      CHECK(rms_of(VertexFit::on, place) < share * off);
      CHECK(rms_of(VertexFit::automatic, place) < share * off);
    }
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

TEST_CASE("more than there is cannot be asked of pieces") {
  FinishBench bench(waves(40), 3);
  const RunSummary made = bench.run(FinishBench::farmed(100'000), "o.ply");
  CHECK(made.finished_in_pieces == 0);
  CHECK(made.triangles == 3'200);
  CHECK_FALSE(made.why_finished_here.empty());
}
