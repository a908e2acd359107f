// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/vertices.hpp>

using namespace meshfarm;

namespace {

Appearance grey(std::uint16_t value) {
  return {value, value, value, 0};
}

/// Vertices on the x axis, one per number, with appearances that tell their numbers.
Mesh row(const std::vector<std::uint16_t>& numbers, bool appearances) {
  Mesh mesh;
  for (const std::uint16_t n : numbers) {
    mesh.positions.push_back({static_cast<double>(n), 0, 0});
    if (appearances) mesh.appearances.push_back(grey(n));
  }
  return mesh;
}

void check_is(const Mesh& mesh, const Mesh& expected) {
  CHECK(mesh.positions == expected.positions);
  CHECK(mesh.appearances == expected.appearances);
}

}  // namespace

TEST_CASE("vertices are placed by their new numbers, with what they look like") {
  for (const bool appearances : {false, true}) {
    const Mesh from = row({10, 11, 12, 13}, appearances);
    const std::vector<std::uint32_t> number = {2, k_left_out, 0, 1};
    Mesh to = row({1, 2, 3, 4, 5}, !appearances);
    place_vertices(VertexView(from), number, 3, to);
    check_is(to, row({12, 13, 10}, appearances));
  }
}

TEST_CASE("a vertex is put and appended within its own mesh, while it grows") {
  for (const bool appearances : {false, true}) {
    Mesh mesh = row({1, 2}, appearances);
    mesh.positions.shrink_to_fit();
    mesh.appearances.shrink_to_fit();
    for (int i = 0; i < 5; ++i) append_vertex(VertexView(mesh), 1, mesh);
    put_vertex(VertexView(mesh), 0, mesh, 3);
    check_is(mesh, row({1, 2, 2, 1, 2, 2, 2}, appearances));
  }
}

TEST_CASE("where only one of two meshes has appearances, the other's are 0") {
  Mesh first = row({1, 2}, true);
  append_vertices(VertexView(row({3}, false)), first);
  CHECK(first.appearances == std::vector<Appearance>{grey(1), grey(2), grey(0)});

  Mesh second = row({1, 2}, false);
  append_vertices(VertexView(row({3}, true)), second);
  CHECK(second.appearances == std::vector<Appearance>{grey(0), grey(0), grey(3)});
  CHECK(second.positions == row({1, 2, 3}, false).positions);

  Mesh none = row({1}, false);
  append_vertices(VertexView(row({2}, false)), none);
  check_is(none, row({1, 2}, false));
}

TEST_CASE("vertices are resized with the columns that they have") {
  Mesh mesh = row({1, 2, 3}, true);
  resize_vertices(mesh, 2);
  check_is(mesh, row({1, 2}, true));
  clear_vertices(mesh);
  check_is(mesh, {});
  resize_vertices(mesh, 2);
  CHECK(mesh.positions.size() == 2);
  CHECK(mesh.appearances.empty());
}

TEST_CASE("corners get the new numbers of their vertices") {
  std::vector<Triangle> triangles = {{0, 1, 2}, {2, 1, 3}};
  renumber_corners(triangles, std::vector<std::uint32_t>{5, 6, 7, 8});
  CHECK(triangles == std::vector<Triangle>{{5, 6, 7}, {7, 6, 8}});
}

TEST_CASE("a surface is added after what is there") {
  Mesh mesh = row({1, 2, 3}, false);
  mesh.triangles = {{0, 1, 2}};
  const Mesh more = row({4, 5, 6, 7}, false);
  append_surface(more.positions, std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}}, mesh);
  CHECK(mesh.positions == row({1, 2, 3, 4, 5, 6, 7}, false).positions);
  CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}, {5, 4, 6}});
}
