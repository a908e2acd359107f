// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include <meshfarm/divide/slab.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/stream/sweep.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

/// The whole mesh as one stream, along x; the first `boundary` vertices are boundary vertices.
StreamMesh stream_of(const Mesh& mesh, std::uint32_t boundary = 0) {
  MeshShare share{mesh.positions, mesh.triangles, {}};
  for (std::uint32_t v = 0; v < boundary; ++v) share.boundary.push_back(v);
  share.type = PositionType::float64;
  share.columns = mesh.columns;
  return sort_slab(std::move(share), {}).stream;
}

/// A swept stream, and everything that it sent put together.
struct Swept : SweptStream {
  Mesh mesh;
  std::uint32_t boundary_vertices = 0;
  std::size_t pieces = 0;
  std::size_t largest_piece = 0;  // triangles
};

Swept swept(const StreamMesh& stream, const SweepOptions& options) {
  const std::string file = encode_stream(stream);
  StreamReader reader(fill_from(file, "stream"), "stream");
  Swept result;
  result.boundary_vertices = reader.info().boundary_vertices;
  result.mesh.positions.resize(result.boundary_vertices);
  const bool counts = reader.info().appearances && options.lines.appearance_scale.length > 0;
  if (counts) result.mesh.appearances.resize(result.boundary_vertices);
  Mesh& mesh = result.mesh;
  static_cast<SweptStream&>(result) =
      sweep(reader, options, [&](auto vertices, auto triangles, auto columns) {
        for (std::size_t v = 0; v < vertices.size(); ++v) append_vertex(vertices, v, mesh);
        mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
        mesh.columns.append(columns);
        ++result.pieces;
        result.largest_piece = std::max(result.largest_piece, triangles.size());
        for (const Triangle& t : triangles)
          REQUIRE(*std::max_element(t.begin(), t.end()) < mesh.positions.size());
      });
  std::copy(result.boundary.positions.begin(), result.boundary.positions.end(),
            mesh.positions.begin());
  std::copy(result.boundary.appearances.begin(), result.boundary.appearances.end(),
            mesh.appearances.begin());
  return result;
}

Mesh wavy_torus() {
  Mesh mesh = test::torus(240, 120);
  for (Vec3& p : mesh.positions) p.z += 0.05 * std::sin(9 * p.x) * std::cos(7 * p.y);
  return mesh;
}

}  // namespace

TEST_CASE("a sweep keeps the labels of its triangles and the lines between them") {
  Mesh mesh = test::torus(240, 120);
  const auto label_at = [](const Mesh& of, const Triangle& t) {
    return of.positions[t[0]].y + of.positions[t[1]].y + of.positions[t[2]].y > 0 ? 5U : 3U;
  };
  for (const Triangle& t : mesh.triangles) mesh.columns.labels.push_back(label_at(mesh, t));
  SweepOptions options{.max_cost = 1e-8, .window_triangles = 8'000};
  const Mesh result = swept(stream_of(mesh), options).mesh;
  REQUIRE(result.triangles.size() < mesh.triangles.size() / 4);
  REQUIRE(result.columns.labels.size() == result.triangles.size());
  for (std::size_t i = 0; i < result.triangles.size(); ++i) {
    CHECK(result.columns.labels[i] == label_at(result, result.triangles[i]));
  }
  options.lines.columns.labels = false;
  CHECK(swept(stream_of(mesh), options).mesh.columns.labels.empty());
}

TEST_CASE("a sweep through any window keeps the topology and reaches about the same count") {
  const Mesh mesh = wavy_torus();  // 57,600 triangles
  const double cost = 1e-8;
  Simplifier whole(mesh, {});
  whole.reduce({.triangles = 0, .max_cost = cost});
  REQUIRE(whole.triangles() < mesh.triangles.size() / 4);
  for (const std::uint64_t window : {100'000, 20'000, 8'000}) {
    CAPTURE(window);
    const Swept result = swept(stream_of(mesh), {.max_cost = cost, .window_triangles = window});
    const Topology t = measure_topology(result.mesh);
    CHECK(t.euler == 0);
    CHECK(t.components == 1);
    CHECK(t.border_edges == 0);
    CHECK(t.nonmanifold_edges == 0);
    CHECK(t.orientation_conflicts == 0);
    CHECK(t.degenerate + t.duplicate == 0);
    CHECK(t.used_vertices == t.vertices);
    CHECK(result.free_triangles == result.mesh.triangles.size());
    CHECK(static_cast<double>(t.triangles) ==
          doctest::Approx(static_cast<double>(whole.triangles())).epsilon(0.2));
  }
}

TEST_CASE("the same bytes whenever") {
  const StreamMesh stream = stream_of(wavy_torus());
  const SweepOptions options{.max_cost = 1e-9, .window_triangles = 9'000, .samples = 500};
  const Swept a = swept(stream, options);
  const Swept b = swept(stream, options);
  CHECK(a.mesh.positions == b.mesh.positions);
  CHECK(a.mesh.triangles == b.mesh.triangles);
  CHECK(a.samples.points == b.samples.points);
}

TEST_CASE("boundary vertices come first, in the stream's order and unmoved") {
  const StreamMesh stream = stream_of(test::grid(150, 150), 3 * 151);
  std::vector<Vec3> expected;
  for (std::size_t v = 0; v < stream.boundary.size(); ++v) {
    if (stream.boundary[v] != 0) expected.push_back(stream.mesh.positions[v]);
  }
  const Swept result = swept(stream, {.max_cost = 1, .window_triangles = 4'000});
  REQUIRE(result.boundary_vertices == 3 * 151);
  for (std::size_t v = 0; v < expected.size(); ++v) {
    REQUIRE(result.mesh.positions[v] == expected[v]);
  }
  CHECK(result.mesh.triangles.size() < 8'000);  // two rows of 600 are locked altogether
  CHECK(result.free_triangles < result.mesh.triangles.size());
  const Topology t = measure_topology(result.mesh);
  CHECK(t.euler == 1);
  CHECK(t.nonmanifold_edges == 0);
}

TEST_CASE("with a cost below nothing all stays as it came") {
  const Mesh mesh = test::grid(120, 80);
  const Swept result = swept(stream_of(mesh), {.max_cost = -1, .window_triangles = 3'000});
  CHECK(result.mesh.triangles.size() == mesh.triangles.size());
  CHECK(result.mesh.positions.size() == mesh.positions.size());
}

TEST_CASE("what is passed is sent on at once, window by window") {
  const Mesh mesh = test::grid(900, 40);  // 72,000 triangles: five blocks
  const Swept result = swept(stream_of(mesh), {.max_cost = -1, .window_triangles = 2'000});
  CHECK(result.mesh.triangles.size() == mesh.triangles.size());
  CHECK(result.pieces >= 5);
  CHECK(result.largest_piece < 19'000);  // a block, and what the one before left
}

TEST_CASE("with a ratio every window keeps its share") {
  const Mesh mesh = wavy_torus();
  const Swept result = swept(stream_of(mesh), {.ratio = 0.2, .window_triangles = 9'000});
  CHECK(static_cast<double>(result.mesh.triangles.size()) ==
        doctest::Approx(0.2 * static_cast<double>(mesh.triangles.size())).epsilon(0.2));
  CHECK(measure_topology(result.mesh).euler == 0);
}

TEST_CASE("samples are of the surface as it came, and the error is measured by them") {
  const Mesh mesh = wavy_torus();
  const Swept result =
      swept(stream_of(mesh),
            {.max_cost = 1e-8, .window_triangles = 9'000, .samples = 2'000, .measure = true});
  CHECK(result.samples.points.size() > 1'300);
  CHECK(result.samples.points.size() < 2'700);
  const SurfaceSamples all = sample_surface(mesh, {.samples = 2'000});
  CHECK(result.samples.area == doctest::Approx(all.area));
  const Distance direct = DistanceMeter(result.mesh, 1).measure(result.samples.points);
  CHECK(result.error == doctest::Approx(direct.max));
  CHECK(result.error > 0);
  CHECK(DistanceMeter(mesh, 1).measure(result.samples.points).max < 1e-12);
}

TEST_CASE("a front that is more than the window is held all the same") {
  // A closed strip swept along x whose rings of 600 vertices each are far more than the window.
  const Swept result =
      swept(stream_of(test::torus(40, 600)), {.max_cost = 1e-9, .window_triangles = 100});
  CHECK(measure_topology(result.mesh).euler == 0);
}

TEST_CASE("duplicate triangles are dropped and counted, non-manifold edges stay") {
  Mesh mesh = test::grid(100, 60);
  mesh.triangles.push_back(mesh.triangles[777]);
  mesh.triangles.push_back(
      {mesh.triangles[5'000][1], mesh.triangles[5'000][2], mesh.triangles[5'000][0]});
  const Swept result = swept(stream_of(mesh), {.max_cost = 0, .window_triangles = 2'000});
  CHECK(result.dropped_duplicate == 2);
  CHECK(measure_topology(result.mesh).duplicate == 0);
}

TEST_CASE("a sweep that is given up says so") {
  CHECK_THROWS_AS(swept(stream_of(wavy_torus()), {.max_cost = 1e-9,
                                                  .window_triangles = 5'000,
                                                  .progress = [](std::uint64_t) { return false; }}),
                  IncompleteError);
}

TEST_CASE("a sweep keeps what its vertices look like") {
  // Black on one side of a line, white on the other: the line stays where it is.
  Mesh sheet = test::grid(200, 60);
  for (const Vec3& p : sheet.positions) {
    const bool is_white = p.x + 0.5 * p.y > 100;
    sheet.appearances.push_back(is_white ? Appearance{65535, 65535, 65535, 0} : Appearance{});
  }
  MeshShare share{sheet.positions, sheet.triangles, {0, 1, 2}};
  share.appearances = sheet.appearances;
  share.type = PositionType::float64;
  const StreamMesh stream = sort_slab(std::move(share), {}).stream;
  SweepOptions options;
  options.ratio = 0.1;
  options.window_triangles = 4000;
  options.lines.appearance_scale.length = 10;
  const Swept made = swept(stream, options);
  REQUIRE(made.mesh.appearances.size() == made.mesh.positions.size());
  std::size_t wrong = 0;
  for (std::size_t v = 0; v < made.mesh.positions.size(); ++v) {
    const Vec3 p = made.mesh.positions[v];
    const double from_line = p.x + 0.5 * p.y - 100.25;
    if (std::abs(from_line) < 2) continue;
    wrong += (made.mesh.appearances[v][0] > 32768) == (from_line > 0) ? 0 : 1;
  }
  CHECK(wrong == 0);
  options.lines.appearance_scale.length = 0;
  CHECK(swept(stream, options).mesh.appearances.empty());
}

TEST_CASE("of vertices that become one the appearance does not depend on the order") {
  Mesh soup;
  for (const Triangle& t : test::grid(4, 4).triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t v : t) soup.positions.push_back(test::grid(4, 4).positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  soup.appearances = test::appearances(soup.positions.size());
  const auto sorted = [](const Mesh& mesh) {
    MeshShare share{mesh.positions, mesh.triangles, {}};
    share.appearances = mesh.appearances;
    share.type = PositionType::float64;
    share.columns = mesh.columns;
    return encode_stream(sort_slab(std::move(share), {}).stream);
  };
  Mesh turned = soup;
  std::reverse(turned.positions.begin(), turned.positions.end());
  std::reverse(turned.appearances.begin(), turned.appearances.end());
  const auto last = static_cast<std::uint32_t>(soup.positions.size()) - 1;
  for (Triangle& t : turned.triangles) t = {last - t[0], last - t[1], last - t[2]};
  CHECK(sorted(soup) == sorted(turned));
}
