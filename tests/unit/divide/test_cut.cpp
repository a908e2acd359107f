// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <set>

#include <doctest/doctest.h>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

#include "divide/cell_graph.hpp"
#include "divide/part_builder.hpp"
#include "support/joined.hpp"
#include "support/memory_source.hpp"
#include "support/meshes.hpp"
#include "support/temp_folder.hpp"
#include "triangle_corners.hpp"

using namespace meshfarm;

namespace {

using test::Corners;
using test::corners_of;
using test::triangles_of;

struct CutMesh {
  Manifest manifest;
  std::vector<Part> parts;
  std::vector<BoundaryTriangle> boundary;
  TriangleColumns boundary_columns;
};

CutMesh cut(Mesh mesh, const CutOptions& options, const std::filesystem::path& folder,
            PositionType positions = PositionType::float64) {
  test::MemorySource source(std::move(mesh), positions);
  const Stage stage = Stage::create(folder);
  CutMesh made{cut_mesh(source, stage, options), {}, {}, {}};
  for (const PartEntry& entry : made.manifest.parts) {
    made.parts.push_back(decode_part(stage.read(entry.file), "part"));
  }
  made.boundary = read_boundary(stage, made.manifest.boundary, made.boundary_columns);
  return made;
}

/// All triangles of the cut, by position.
std::vector<Corners> triangles_of(const CutMesh& made) {
  std::vector<Corners> all;
  for (const Part& part : made.parts) {
    const auto some = triangles_of(part.mesh);
    all.insert(all.end(), some.begin(), some.end());
  }
  const auto at = [&](BoundaryCorner corner) {
    return made.parts[corner.part].mesh.positions[corner.local];
  };
  for (const auto& [a, b, c] : made.boundary) all.push_back(corners_of(at(a), at(b), at(c)));
  std::sort(all.begin(), all.end());
  return all;
}

/// The triangles with this label.
std::vector<Corners> triangles_of(const Mesh& mesh, Label label) {
  Mesh some = mesh;
  keep_triangles(some, [&](std::size_t i) { return mesh.columns.labels[i] == label; });
  return triangles_of(some);
}

std::vector<Corners> triangles_of(const CutMesh& made, Label label) {
  CutMesh some = made;
  for (Part& part : some.parts) {
    const std::vector<Label> labels = part.mesh.columns.labels;
    keep_triangles(part.mesh, [&](std::size_t i) { return labels[i] == label; });
  }
  some.boundary.clear();
  for (std::size_t i = 0; i < made.boundary.size(); ++i) {
    if (made.boundary_columns.labels[i] == label) some.boundary.push_back(made.boundary[i]);
  }
  return triangles_of(some);
}

}  // namespace

TEST_CASE("parts and boundary together are the input, boundary vertices first") {
  const Mesh mesh = test::torus(60, 40);
  const test::TempFolder folder;
  const CutMesh made = cut(mesh, {.parts = 7}, folder.path());
  CHECK(triangles_of(made) == triangles_of(mesh));
  CHECK(made.parts.size() == 7);
  CHECK(made.manifest.partitioner == partitioner_name());
  CHECK(made.manifest.triangles() == mesh.triangles.size());
  CHECK(made.manifest.input_vertices == mesh.positions.size());

  std::vector<std::set<std::uint32_t>> used(made.parts.size());
  for (const BoundaryTriangle& t : made.boundary) {
    std::set<std::uint32_t> parts;
    for (const BoundaryCorner& corner : t) {
      used[corner.part].insert(corner.local);
      parts.insert(corner.part);
    }
    CHECK(parts.size() >= 2);
  }
  for (std::size_t p = 0; p < made.parts.size(); ++p) {
    // Every vertex at the head is used by a boundary triangle, and no other is.
    CHECK(used[p].size() == made.parts[p].boundary_vertices);
    CHECK(*used[p].rbegin() == made.parts[p].boundary_vertices - 1);
    CHECK(made.manifest.parts[p].triangles == made.parts[p].mesh.triangles.size());
  }
}

TEST_CASE("columns go with their triangles") {
  Mesh mesh = test::torus(60, 40);
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) mesh.columns.labels.push_back(i % 7);
  const auto uv_of = [](const Vec3& p) {
    return Uv{static_cast<float>(p.x), static_cast<float>(p.y)};
  };
  const auto uvs_of = [&](const Mesh& of, const Triangle& t) {
    return CornerUvs{uv_of(of.positions[t[0]]), uv_of(of.positions[t[1]]),
                     uv_of(of.positions[t[2]])};
  };
  for (const Triangle& t : mesh.triangles) mesh.columns.uvs.push_back(uvs_of(mesh, t));
  Mesh dirty = mesh;
  dirty.triangles.insert(dirty.triangles.begin(), {{0, 0, 1}, {5, 6, 5}});
  dirty.columns.labels.insert(dirty.columns.labels.begin(), {100, 101});
  dirty.columns.uvs.insert(dirty.columns.uvs.begin(), 2, CornerUvs{});
  const test::TempFolder folder;
  const CutMesh made = cut(dirty, {.parts = 7}, folder.path());
  REQUIRE(made.manifest.labels.has_value());
  CHECK(made.manifest.labels->name == "region");
  CHECK(made.boundary_columns.labels.size() == made.boundary.size());
  for (Label label = 0; label < 7; ++label) {
    CHECK(triangles_of(made, label) == triangles_of(mesh, label));
  }
  CHECK(triangles_of(made, 100).empty());
  CHECK(made.manifest.uvs);
  for (const Part& part : made.parts) {
    REQUIRE(part.mesh.columns.uvs.size() == part.mesh.triangles.size());
    for (std::size_t i = 0; i < part.mesh.triangles.size(); ++i) {
      CHECK(part.mesh.columns.uvs[i] == uvs_of(part.mesh, part.mesh.triangles[i]));
    }
  }
}

TEST_CASE("the same cut from any number of threads and in any memory") {
  const test::TempFolder folder;
  const Mesh mesh = test::torus(50, 50);
  cut(mesh, {.parts = 5, .threads = 1}, folder.path() / "1");
  cut(mesh, {.parts = 5, .threads = 4}, folder.path() / "4");
  cut(mesh, {.parts = 5, .threads = 4, .memory_bytes = 1}, folder.path() / "1 at once");
  for (const char* name : {"parts/000000.part", "parts/000004.part", "boundary"}) {
    const std::string bytes = read_file(folder.path() / "1" / name);
    CHECK(read_file(folder.path() / "4" / name) == bytes);
    CHECK(read_file(folder.path() / "1 at once" / name) == bytes);
  }
}

TEST_CASE("coincident vertices are welded across the whole mesh, seams included") {
  // Every triangle has vertices of its own, as in an STL file.
  const Mesh mesh = test::torus(40, 30);
  Mesh soup;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t corner : t) soup.positions.push_back(mesh.positions[corner]);
    const auto n = static_cast<std::uint32_t>(soup.positions.size());
    soup.triangles.push_back({n - 3, n - 2, n - 1});
  }
  const test::TempFolder folder;
  const CutMesh welded = cut(soup, {.parts = 4, .weld = Weld::exact}, folder.path() / "exact");
  CHECK(triangles_of(welded) == triangles_of(mesh));
  CHECK(welded.manifest.coincident_vertices == soup.positions.size() - mesh.positions.size());
  std::uint64_t vertices = 0;
  for (const PartEntry& part : welded.manifest.parts) vertices += part.vertices;
  CHECK(vertices == mesh.positions.size());
  for (const BoundaryTriangle& t : welded.boundary) {
    for (const BoundaryCorner& c : t) CHECK(c.local < welded.parts[c.part].boundary_vertices);
  }

  const CutMesh apart = cut(soup, {.parts = 4, .weld = Weld::off}, folder.path() / "off");
  CHECK(apart.manifest.coincident_vertices == 0);
  vertices = 0;
  for (const PartEntry& part : apart.manifest.parts) vertices += part.vertices;
  CHECK(vertices == soup.positions.size());
}

TEST_CASE("surfaces that touch are not welded together") {
  const Mesh octahedron = test::octahedron();
  const Mesh mesh = test::touching_twice(octahedron, octahedron.positions[0]);
  const test::TempFolder folder;
  const CutMesh touching = cut(mesh, {.parts = 1, .weld = Weld::exact}, folder.path());
  CHECK(touching.manifest.coincident_vertices == 1);
  CHECK(touching.manifest.parts[0].vertices == 12);
}

TEST_CASE("where surfaces touch at seams it is decided as if there were none") {
  const Mesh tips = test::touching_row(40, false);
  const Mesh edges = test::touching_row(40, true);
  const Mesh necks = test::torus_with_necks(60, 5);
  for (const Mesh& mesh : {tips, edges, necks}) {
    const Topology whole = measure_topology(mesh);
    CAPTURE(whole.components);
    const test::TempFolder folder;
    for (const std::uint32_t parts : {1U, 4U, 16U}) {
      for (unsigned seed = 0; seed < 5; ++seed) {
        CAPTURE(parts);
        CAPTURE(seed);
        const CutMesh made = cut(seed == 0 ? mesh : test::shuffled(mesh, seed), {.parts = parts},
                                 folder / std::to_string(8 * parts + seed));
        const Topology got = measure_topology(test::joined(made.parts, made.boundary));
        CHECK(got.used_vertices == whole.used_vertices);
        CHECK(got.triangles == whole.triangles);
        CHECK(got.components == whole.components);
        CHECK(got.euler == whole.euler);
        CHECK(got.nonmanifold_edges == 0);
        CHECK(made.manifest.coincident_vertices == test::count_coincident(mesh));
        CHECK(made.manifest.coincident_corners == test::count_flat(mesh));
      }
    }
  }
}

TEST_CASE(
    "triangles with a position that is not finite go and are counted, all else is as without") {
  const Mesh mesh = test::torus(40, 30);
  const Mesh spoilt = test::with_lost_vertices(mesh, 7);
  const test::TempFolder folder;
  const CutMesh made = cut(spoilt, {.parts = 4}, folder / "spoilt");
  CHECK(made.manifest.dropped_not_finite == 7);
  CHECK(made.manifest.triangles() == mesh.triangles.size());
  CHECK(made.manifest.input_triangles == mesh.triangles.size() + 7);
  const CutMesh clean = cut(mesh, {.parts = 4}, folder / "clean");
  CHECK(made.manifest.box.lo == clean.manifest.box.lo);
  CHECK(made.manifest.box.hi == clean.manifest.box.hi);
  CHECK(triangles_of(made) == triangles_of(clean));
  CHECK(made.boundary.size() == clean.boundary.size());

  Mesh lost = mesh;
  for (Vec3& p : lost.positions) p = k_no_position;
  CHECK(cut(lost, {.parts = 4}, folder / "lost").manifest.triangles() == 0);
}

TEST_CASE("parts come out even with vertices far out and where triangles are far smaller") {
  const auto check_even = [](const Mesh& mesh, const std::filesystem::path& folder) {
    const CutMesh made = cut(mesh, {.parts = 28, .threads = 1}, folder / "1");
    REQUIRE(made.parts.size() == 28);
    std::uint64_t most = 0;
    for (const PartEntry& part : made.manifest.parts) most = std::max(most, part.vertices);
    CHECK(static_cast<double>(most) * 28 <= 1.15 * static_cast<double>(mesh.positions.size()));
    CHECK(made.manifest.triangles() == mesh.triangles.size());
    for (const unsigned threads : {2U, 5U}) {
      const std::filesystem::path other = folder / std::to_string(threads);
      cut(mesh, {.parts = 28, .threads = threads}, other);
      for (const char* name : {"parts/000000.part", "parts/000027.part", "boundary"}) {
        CHECK(read_file(folder / "1" / name) == read_file(other / name));
      }
    }
  };
  const test::TempFolder folder;
  for (const double far : {1e2, 1e4, 1e8}) {
    CAPTURE(far);
    check_even(test::with_outlier(test::grid(150, 150), far), folder / std::to_string(far));
  }
  Mesh dense = test::grid(150, 150);  // from left to right a hundred times closer both ways
  for (Vec3& p : dense.positions) {
    const double closer = std::pow(0.01, p.x / 150);
    p = {150 * closer, p.y * closer, 0};
  }
  check_even(dense, folder / "dense");
}

TEST_CASE("parts come out even with many vertices at one point, welded or not") {
  constexpr std::uint32_t k_many = 20'000;
  const Mesh sheet = test::grid(150, 150);
  const Mesh mesh = test::with_crowd(sheet, k_many);
  const test::TempFolder folder;
  for (const Weld weld : {Weld::exact, Weld::off}) {
    const std::filesystem::path here = folder / (weld == Weld::exact ? "welded" : "apart");
    const CutMesh made = cut(mesh, {.parts = 28, .weld = weld, .threads = 1}, here / "1");
    REQUIRE(made.parts.size() == 28);
    std::uint64_t most = 0;
    std::uint64_t all = 0;
    for (const PartEntry& part : made.manifest.parts) {
      most = std::max(most, part.vertices);
      all += part.vertices;
    }
    CHECK(all == sheet.positions.size() + (weld == Weld::off ? k_many : 0));
    CHECK(static_cast<double>(most) * 28 <= 1.15 * static_cast<double>(all));
    CHECK(made.manifest.coincident_vertices == (weld == Weld::off ? 0 : k_many));
    for (const unsigned threads : {2U, 5U}) {
      const std::filesystem::path other = here / std::to_string(threads);
      cut(mesh, {.parts = 28, .weld = weld, .threads = threads}, other);
      for (const char* name : {"parts/000000.part", "parts/000027.part", "boundary"}) {
        CHECK(read_file(here / "1" / name) == read_file(other / name));
      }
    }
  }
}

TEST_CASE("how many triangles have two corners at one place does not depend on the seams") {
  const test::TempFolder folder;
  for (const std::uint32_t parts : {1U, 2U, 5U}) {
    const CutMesh made = cut(test::torus_with_neck(40, 20), {.parts = parts, .weld = Weld::exact},
                             folder / std::to_string(parts));
    CHECK(made.manifest.coincident_corners == 40);
  }
}

TEST_CASE("degenerate triangles go, wherever they lie, and are counted") {
  Mesh mesh = test::torus(40, 30);
  const std::size_t clean = mesh.triangles.size();
  for (std::uint32_t i = 0; i < 1200; i += 10) {
    mesh.triangles.push_back({i, i, (i + 600) % 1200});  // two equal corners, often of two parts
  }
  const test::TempFolder folder;
  const CutMesh made = cut(mesh, {.parts = 4}, folder.path());
  CHECK(made.manifest.dropped_degenerate == 120);
  CHECK(made.manifest.triangles() == clean);
  CHECK(made.manifest.input_triangles == clean + 120);
}

TEST_CASE("a boundary triangle that comes twice is kept once") {
  Mesh mesh = test::torus(40, 30);
  const std::vector<Triangle> once = mesh.triangles;
  for (const auto& [a, b, c] : once) mesh.triangles.push_back({c, a, b});
  const test::TempFolder folder;
  const CutMesh made = cut(mesh, {.parts = 4}, folder.path());
  const CutMesh clean = cut(test::torus(40, 30), {.parts = 4}, folder.path() / "clean");
  CHECK(made.boundary == clean.boundary);
  CHECK(made.manifest.dropped_duplicate == clean.boundary.size());
}

TEST_CASE("float positions stay as they are") {
  Mesh mesh = test::icosphere(3);
  for (Vec3& p : mesh.positions) p = rounded(p, PositionType::float32);
  const test::TempFolder folder;
  const CutMesh made = cut(mesh, {.parts = 3}, folder.path(), PositionType::float32);
  CHECK(triangles_of(made) == triangles_of(mesh));
}

TEST_CASE("meshes of almost nothing") {
  const test::TempFolder folder;
  const CutMesh empty = cut({}, {}, folder.path() / "empty");
  CHECK(empty.manifest.triangles() == 0);
  const CutMesh points = cut({{{0, 0, 0}, {1, 1, 1}}, {}}, {.parts = 2}, folder.path() / "points");
  CHECK(points.manifest.triangles() == 0);
  const CutMesh one = cut(test::tetrahedron(), {}, folder.path() / "one");
  CHECK(one.parts.size() == 1);
  CHECK(triangles_of(one) == triangles_of(test::tetrahedron()));
  // All at one place: one cell, one part, whatever was asked for.
  const CutMesh place =
      cut({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}}, {.parts = 9}, folder.path() / "place");
  CHECK(place.parts.size() == 1);
  CHECK(place.manifest.dropped_degenerate == 1);
}

TEST_CASE("a stop ends the cut and publishes no manifest") {
  const test::TempFolder folder;
  const std::atomic<bool> stop = true;
  CHECK_THROWS_AS(cut(test::torus(20, 20), {.stop = &stop}, folder.path()), IncompleteError);
  CHECK_FALSE(std::filesystem::exists(folder.path() / "manifest"));
}

TEST_CASE("the number of parts depends on the size alone") {
  CHECK(default_parts(Scheme::cut, 0) == 1);
  CHECK(default_parts(Scheme::cut, 99'999) == 1);
  CHECK(default_parts(Scheme::cut, 200'000) == 4);
  CHECK(default_parts(Scheme::cut, 871'414) == 16);
  CHECK(default_parts(Scheme::cut, 10'000'000) == 16);
  CHECK(default_parts(Scheme::cut, 28'000'000) == 28);
  CHECK(default_parts(Scheme::cut, std::uint64_t{1} << 60) == 1'000'000);
}
