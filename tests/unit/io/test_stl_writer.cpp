// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstring>

#include <doctest/doctest.h>
#include <support/meshes.hpp>

#include <meshfarm/io/mesh_format.hpp>

#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

Vec3 vector_at(const std::string& bytes, std::size_t at) {
  float xyz[3];
  REQUIRE(bytes.size() >= at + sizeof xyz);
  std::memcpy(xyz, bytes.data() + at, sizeof xyz);
  return {xyz[0], xyz[1], xyz[2]};
}

}  // namespace

TEST_CASE("a written STL has the corners and the normals of the triangles") {
  const TempFolder folder;
  const std::vector<Vec3> positions{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {4, 0, 0}};
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 1}, {0, 1, 3}};
  write_mesh(folder / "m.stl", {positions, triangles}, PositionType::float64);
  const std::string bytes = read_file(folder / "m.stl");
  REQUIRE(bytes.size() == 84 + 3 * 50);
  CHECK(bytes.substr(0, 9) == std::string("meshfarm\0", 9));
  CHECK(bytes.substr(80, 4) == std::string("\3\0\0\0", 4));
  CHECK(vector_at(bytes, 84) == Vec3{0, 0, 1});
  CHECK(vector_at(bytes, 84 + 24) == Vec3{2, 0, 0});
  CHECK(vector_at(bytes, 84 + 50) == Vec3{0, 0, -1});
  CHECK(vector_at(bytes, 84 + 100) == Vec3{0, 0, 0});  // without area
  CHECK(bytes.substr(84 + 48, 2) == std::string(2, '\0'));
}

TEST_CASE("a written STL never begins with the word of a text") {
  const TempFolder folder;
  create_mesh(folder / "m.stl", {.comment = "solid"})->commit();
  CHECK(read_file(folder / "m.stl").starts_with("meshfarm: solid"));
}

TEST_CASE("what is written as STL is read as its soup, rounded to float") {
  const TempFolder folder;
  const Mesh mesh = torus(60, 100);
  write_mesh(folder / "m.stl", mesh, PositionType::float64);
  const ReadFile read = read_path(folder / "m.stl");
  REQUIRE(read.mesh.triangles.size() == mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      REQUIRE(read.mesh.positions[3 * t + i] ==
              rounded(mesh.positions[mesh.triangles[t][i]], PositionType::float32));
    }
  }
}

TEST_CASE("more triangles than an STL can count are refused before any work") {
  const TempFolder folder;
  CHECK_THROWS_WITH_AS(
      create_mesh(folder / "m.stl", {.triangles = std::uint64_t{1} << 32, .comment = {}}),
      "an STL file with 4294967296 triangles cannot be written: it counts them with 32 bits",
      UsageError);
  CHECK(std::filesystem::is_empty(folder.path()));
}
