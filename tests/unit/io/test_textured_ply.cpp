// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <support/meshes.hpp>

#include <meshfarm/io/mesh_format.hpp>

#include "gltf_test_files.hpp"
#include "textured_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

const std::string k_vertices = "element vertex 4\n" + std::string(k_xyz) + "element face 2\n" +
                               std::string(k_corners) + "property list uchar float texcoord\n";
const std::string k_textured_positions = raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5F});

std::string face(const Triangle& triangle, const CornerUvs& uvs, const std::string& more) {
  std::string made = "\3";
  for (const std::uint32_t corner : triangle) made += raw({corner});
  made += '\6';
  for (const Uv& uv : uvs) made += raw({uv[0], uv[1]});
  return made + more;
}

/// The file of a square whose faces end in `first` and `second`.
std::string square_file(const std::string& comments, const std::string& properties,
                        const std::string& first, const std::string& second) {
  const Mesh square = textured_square();
  return "ply\nformat binary_little_endian 1.0\n" + comments + k_vertices + properties +
         "end_header\n" + k_textured_positions +
         face(square.triangles[0], square.columns.uvs[0], first) +
         face(square.triangles[1], square.columns.uvs[1], second);
}

}  // namespace

TEST_CASE("a PLY has texture coordinates at its faces, and pictures beside it") {
  const TempFolder folder;
  MeshSinkOptions options = square_options();
  options.labels->materials[0].maps.clear();
  write_textured(folder / "m.ply", textured_square(), options);
  CHECK((read_file(folder / "m.ply") ==
         square_file("comment TextureFile m_atlas.png\ncomment TextureFile m_a_b.png\n",
                     "property int texnumber\nproperty uchar material_index\n",
                     raw<std::int32_t>({0}) + "\1", raw<std::int32_t>({1}) + "\2")));
  CHECK(read_file(folder / "m_atlas.png") == "bytes of maps/atlas.png");
  CHECK(read_file(folder / "m_a_b.png") == "bytes of C:\\tex\\a b.png");
  CHECK(files_in(folder) == 3);  // PLY has no place for other maps
}

TEST_CASE("a PLY with one picture for all triangles needs no numbers of pictures") {
  const TempFolder folder;
  MeshSinkOptions options = square_options();
  for (Material& material : options.labels->materials) material.maps = {{MapUse::colour, 2}};
  write_textured(folder / "m.ply", textured_square(), options);
  CHECK(
      (read_file(folder / "m.ply") == square_file("comment TextureFile m_a_b.png\n",
                                                  "property uchar material_index\n", "\1", "\2")));
  CHECK(files_in(folder) == 2);
  options.labels->materials[2].maps.clear();
  write_textured(folder / "m.ply", textured_square(), options);
  CHECK((read_file(folder / "m.ply") ==
         square_file("comment TextureFile m_a_b.png\n",
                     "property int texnumber\nproperty uchar material_index\n",
                     raw<std::int32_t>({0}) + "\1", raw<std::int32_t>({-1}) + "\2")));
}

TEST_CASE("a PLY has texture coordinates without materials, of no more vertices than before") {
  const TempFolder folder;
  Mesh mesh = textured_square();
  mesh.columns.labels.clear();
  write_textured(folder / "m.ply", mesh, {.uvs = true});
  CHECK((read_file(folder / "m.ply") == square_file("", "", "", "")));
  CHECK(read_path(folder / "m.ply").mesh.triangles == mesh.triangles);
  mesh = textured_grid(200, 150);
  mesh.columns.labels.assign(mesh.triangles.size(), 0);
  write_textured(folder / "m.ply", mesh, {.labels = LabelMeaning{"region", {}}, .uvs = true});
  const ReadFile read = read_path(folder / "m.ply");
  CHECK(read.mesh.positions == mesh.positions);
  CHECK(read.mesh.triangles == mesh.triangles);
  mesh.columns.uvs[0][0] = {NAN, 0};
  write_textured(folder / "n.ply", mesh, {.labels = LabelMeaning{"region", {}}, .uvs = true});
  CHECK(read_file(folder / "n.ply").size() == read_file(folder / "m.ply").size());
}

TEST_CASE("a PLY whose pictures cannot be read leaves what was there") {
  const TempFolder folder;
  write_file(folder / "m.ply", "old");
  MeshSinkOptions options = square_options();
  options.pictures.load = [](std::size_t /*picture*/) -> std::string {
    throw DataError("atlas.png: has changed");
  };
  CHECK_THROWS_AS(write_textured(folder / "m.ply", textured_square(), options), DataError);
  CHECK(read_file(folder / "m.ply") == "old");
  CHECK(files_in(folder) == 1);
}

TEST_CASE("labels of a PLY do not have the name of its texture numbers") {
  const TempFolder folder;
  MeshSinkOptions options = square_options();
  options.labels->name = "texnumber";
  write_textured(folder / "m.ply", textured_square(), options);
  CHECK(read_file(folder / "m.ply")
            .find("property int texnumber\nproperty uchar material_index\nend") !=
        std::string::npos);
}
