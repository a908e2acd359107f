// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <support/memory_source.hpp>
#include <support/meshes.hpp>

#include <meshfarm/io/convert_mesh.hpp>
#include <meshfarm/io/mesh_format.hpp>

#include "ply_test_files.hpp"
#include "textured_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

Converted convert(const std::filesystem::path& from, const std::filesystem::path& to) {
  const auto source = open_mesh(from);
  return convert_mesh(*source, to, [](double) {});
}

/// Like a file with texture coordinates.
class TexturedSource : public MemorySource {
 public:
  explicit TexturedSource(Mesh mesh) : MemorySource(std::move(mesh), PositionType::float32) {
    info_.labels = square_options().labels;
    info_.pictures = square_options().pictures;
  }
};

}  // namespace

TEST_CASE("a mesh converted round all formats with indices is the same to the byte") {
  const TempFolder folder;
  Mesh mesh = torus(50, 80);
  for (const PositionType type : {PositionType::float32, PositionType::float64}) {
    for (Vec3& p : mesh.positions) p = rounded({p.x + 1e-9, p.y, p.z}, type);
    write_mesh(folder / "a.ply", mesh, type);
    convert(folder / "a.ply", folder / "b.obj");
    convert(folder / "b.obj", folder / "c.off");
    convert(folder / "c.off", folder / "d.ply");
    CHECK(read_file(folder / "d.ply") == read_file(folder / "a.ply"));
  }
}

TEST_CASE("by way of STL a mesh becomes its soup") {
  const TempFolder folder;
  write_mesh(folder / "a.ply", {k_square_vertices, k_square_triangles}, PositionType::float32);
  const Converted made = convert(folder / "a.ply", folder / "a.stl");
  CHECK(made.vertices == 4);
  CHECK(made.triangles == 2);
  convert(folder / "a.stl", folder / "b.obj");
  CHECK(read_file(folder / "b.obj") ==
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 1 0\nv 1 0 0\nv 1 1 0.5\nf 1 2 3\nf 4 5 6\n");
}

TEST_CASE("what cannot be converted is left out and counted") {
  const TempFolder folder;
  write_file(folder / "a.obj",
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nf 1 2 3\nf 1 2 4\nf 1 2\nf 3 2 1\n");
  const Converted made = convert(folder / "a.obj", folder / "a.off");
  CHECK(made.vertices == 4);
  CHECK(made.triangles == 2);
  CHECK(made.small_faces == 1);
  CHECK(made.dropped_not_finite == 1);
  CHECK(read_file(folder / "a.off") ==
        "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\nnan nan nan\n3 0 1 2\n3 2 1 0\n");
}

TEST_CASE("positions that prove to be doubles are written as doubles") {
  const TempFolder folder;
  write_file(folder / "a.obj", "v 0 0 0\nv 5412345.678 0 0\nv 0 1 0\nf 1 2 3\n");
  CHECK(convert(folder / "a.obj", folder / "a.ply").positions == PositionType::float64);
  CHECK(read_path(folder / "a.ply").mesh.positions[1] == Vec3{5412345.678, 0, 0});
}

TEST_CASE("a mesh may be converted over itself, and a failed one leaves it as it was") {
  const TempFolder folder;
  write_file(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 \\\n2 3\n");
  convert(folder / "a.obj", folder / "a.obj");
  const std::string tidy = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  CHECK(read_file(folder / "a.obj") == tidy);
  write_file(folder / "b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  CHECK_THROWS_AS(convert(folder / "b.off", folder / "a.obj"), DataError);
  CHECK(read_file(folder / "a.obj") == tidy);
}

TEST_CASE("texture coordinates and pictures come with the triangles that stay") {
  const Quiet quiet;  // glTF does not support these pictures
  const TempFolder folder;
  Mesh mesh = textured_square();
  mesh.positions.push_back(k_no_position);
  mesh.triangles.insert(mesh.triangles.begin() + 1, {0, 1, 4});
  mesh.columns.uvs.insert(mesh.columns.uvs.begin() + 1, CornerUvs{{{9, 9}, {9, 9}, {9, 9}}});
  mesh.columns.labels.insert(mesh.columns.labels.begin() + 1, 0);
  TexturedSource source(mesh);
  for (const char* name : {"m.obj", "m.ply", "m.glb", "m.gltf", "m.stl", "m.off"}) {
    const Converted made = convert_mesh(source, folder / name, [](double) {});
    CHECK(made.triangles == 2);
    CHECK(made.dropped_not_finite == 1);
    CHECK(made.has_uvs == keeps_uvs(folder / name));
  }
  CHECK(uvs_of_obj(read_file(folder / "m.obj")) == textured_square().columns.uvs);
  CHECK(read_file(folder / "m_atlas.png") == "bytes of maps/atlas.png");
}
