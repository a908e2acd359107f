// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <support/meshes.hpp>

#include <meshfarm/io/mesh_format.hpp>

#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

TEST_CASE("the written OBJ and OFF are these") {
  const TempFolder folder;
  const Mesh square{k_square_vertices, k_square_triangles};
  write_mesh(folder / "m.obj", square, PositionType::float32);
  CHECK(read_file(folder / "m.obj") == "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.5\nf 1 2 3\nf 3 2 4\n");
  write_mesh(folder / "m.off", square, PositionType::float32);
  CHECK(read_file(folder / "m.off") ==
        "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0.5\n3 0 1 2\n3 2 1 3\n");
}

TEST_CASE("a comment is an OBJ's first line") {
  const TempFolder folder;
  create_mesh(folder / "m.obj", {.comment = "by a test"})->commit();
  CHECK(read_file(folder / "m.obj") == "# by a test\n");
}

TEST_CASE("what is written as text is what is read") {
  const TempFolder folder;
  Mesh mesh = torus(100, 200);
  mesh.positions[0] = {1e-30, 123456789.125, -1e20};
  mesh.positions[1] = {0.384765625, -0.376953125, 0.466796875};
  for (const auto name : {"m.obj", "m.off"}) {
    write_mesh(folder / name, mesh, PositionType::float64);
    const ReadFile wide = read_path(folder / name);
    CHECK(wide.info.positions == PositionType::float64);
    CHECK(wide.mesh.positions == mesh.positions);
    CHECK(wide.mesh.triangles == mesh.triangles);

    Mesh narrow = mesh;
    for (Vec3& p : narrow.positions) p = rounded(p, PositionType::float32);
    write_mesh(folder / name, narrow, PositionType::float32);
    const ReadFile read = read_path(folder / name);
    CHECK(read.info.positions == PositionType::float32);
    CHECK(read.mesh.positions == narrow.positions);
    CHECK(read.mesh.triangles == narrow.triangles);
  }
}

TEST_CASE("all formats check counts and indices, and leave nothing behind") {
  const TempFolder folder;
  for (const auto name : {"m.obj", "m.off", "m.stl"}) {
    CAPTURE(name);
    const std::string path = (folder / name).string();
    const auto sink = create_mesh(path, {.vertices = 4, .triangles = 1, .comment = {}});
    CHECK_THROWS_WITH_AS(
        sink->triangles(k_square_triangles),
        (path + ": 0 vertices were given to be written, but 4 were promised").c_str(), DataError);
    sink->vertices(k_square_vertices);
    const std::vector<WideTriangle> bad{{0, 1, 4}};
    CHECK_THROWS_AS(sink->triangles(std::span<const WideTriangle>(bad)), DataError);
    CHECK_THROWS_AS(sink->commit(), DataError);
  }
  CHECK(std::filesystem::is_empty(folder.path()));
}
