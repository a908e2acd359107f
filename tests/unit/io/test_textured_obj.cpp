// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <support/meshes.hpp>

#include <meshfarm/io/mesh_format.hpp>

#include "textured_meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

TEST_CASE("an OBJ is written with texture coordinates, a library and pictures beside it") {
  const TempFolder folder;
  write_textured(folder / "my m.obj", textured_square(), square_options());
  CHECK(read_file(folder / "my m.obj") ==
        "mtllib my m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.5\n"
        "vt 0 0\nvt 0.5 0\nvt 0 1\nvt 0.625 1\nvt 1 0.33333334\n"
        "usemtl front\nf 1/1 2/2 3/3\nusemtl back\nf 3/3 2/4 4/5\n");
  CHECK(read_file(folder / "my m.mtl") ==
        "newmtl front\nKd 1 1 1\nd 1\nmap_Kd my_m_atlas.png\nmap_Bump my_m_bumps.jpg\n"
        "newmtl back\nKd 1 1 1\nd 0.5\nmap_Kd -clamp on my_m_a_b.png\n"
        "Ke 1 1 1\nmap_Ke -clamp on my_m_atlas.png\n");
  CHECK(read_file(folder / "my_m_atlas.png") == "bytes of maps/atlas.png");
  CHECK(read_file(folder / "my_m_bumps.jpg") == "bytes of bumps.jpg");
  CHECK(read_file(folder / "my_m_a_b.png") == "bytes of C:\\tex\\a b.png");
  CHECK(files_in(folder) == 5);  // MTL has no keyword for "rough.png"
}

TEST_CASE("an OBJ has one vt for a vertex and its wedge, across batches") {
  const TempFolder folder;
  const Mesh mesh = textured_grid(200, 100);
  MeshSinkOptions options{.uvs = true};
  write_textured(folder / "m.obj", mesh, options);
  const std::string text = read_file(folder / "m.obj");
  CHECK(lines_with(text, "vt ") == mesh.positions.size());
  CHECK(lines_with(text, "f ") == mesh.triangles.size());
  CHECK(lines_with(text, "mtllib") == 0);
  CHECK(uvs_of_obj(text) == mesh.columns.uvs);
  write_textured(folder / "n.obj", mesh, options);
  CHECK(read_file(folder / "n.obj") == text);
}

TEST_CASE("texture coordinates come back from an OBJ to the bit, and none is no number") {
  const TempFolder folder;
  Mesh mesh{k_square_vertices, k_square_triangles};
  mesh.columns.uvs = {{{{-7.125F, 1e-30F}, {0.1F, 3e20F}, {0.30000001F, 1}}},
                      {{{0, -0.0F}, {1.0F / 3, 2.0F / 3}, {16777216, 0.99999994F}}}};
  write_textured(folder / "m.obj", mesh, {.uvs = true});
  CHECK(uvs_of_obj(read_file(folder / "m.obj")) == mesh.columns.uvs);
  mesh.columns.uvs[0][1] = {NAN, HUGE_VALF};
  write_textured(folder / "m.obj", mesh, {.uvs = true});
  CHECK(uvs_of_obj(read_file(folder / "m.obj"))[0][1] == Uv{0, 0});
}

TEST_CASE("the pictures of an input in the same folder stay as they are") {
  const TempFolder folder;
  write_file(folder / "m_atlas.png", "theirs");
  MeshSinkOptions options = square_options();
  options.pictures = pictures_named({"atlas.png", "m_atlas.png", "sub/atlas.png", "m_own.png"});
  options.labels->materials[1].maps = {{MapUse::colour, 0}, {MapUse::normal, 2}};
  options.labels->materials[2].maps = {{MapUse::colour, 1}, {MapUse::emission, 3}};
  options.pictures.load = [&](std::size_t picture) {
    return picture == 1 ? read_file(folder / "m_atlas.png") : "picture " + std::to_string(picture);
  };
  for (int time = 0; time < 2; ++time) {
    write_textured(folder / "m.obj", textured_square(), options);
    CHECK(read_file(folder / "m_atlas.png") == "theirs");
    CHECK(read_file(folder / "m_atlas_2.png") == "picture 0");
    CHECK(read_file(folder / "m_atlas_3.png") == "picture 2");
    CHECK(read_file(folder / "m_own.png") == "picture 3");
    CHECK(files_in(folder) == 6);
  }
}

TEST_CASE("where a picture cannot be read or written nothing is left behind") {
  const TempFolder folder;
  MeshSinkOptions options = square_options();
  options.pictures.load = [](std::size_t picture) -> std::string {
    if (picture == 1) throw IoError("cannot read", "bumps.jpg", ENOENT);
    return "bytes";
  };
  CHECK_THROWS_WITH_AS(write_textured(folder / "m.obj", textured_square(), options),
                       doctest::Contains("bumps.jpg"), IoError);
  CHECK(files_in(folder) == 0);
  write_file(folder / "m.obj", "old");
  std::filesystem::create_directory(folder / "m_atlas.png");
  CHECK_THROWS_WITH_AS(write_textured(folder / "m.obj", textured_square(), square_options()),
                       doctest::Contains("m_atlas.png"), IoError);
  CHECK(files_in(folder) == 2);
  CHECK(read_file(folder / "m.obj") == "old");
}

TEST_CASE("more pictures than files can be open are written") {
  const TempFolder folder;
  Mesh mesh = textured_grid(40, 10);
  std::vector<std::string> names;
  LabelMeaning meaning{"material", {}};
  for (std::uint32_t i = 0; i < 300; ++i) {
    names.push_back("tile" + std::to_string(i) + ".png");
    meaning.materials.push_back({.name = "m" + std::to_string(i), .maps = {{MapUse::colour, i}}});
  }
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    mesh.columns.labels.push_back(static_cast<Label>(i % 300));
  }
  write_textured(folder / "m.obj", mesh,
                 {.labels = meaning, .uvs = true, .pictures = pictures_named(names)});
  CHECK(files_in(folder) == 302);
  CHECK(read_file(folder / "m_tile299.png") == "bytes of tile299.png");
}

TEST_CASE("formats without a place for texture coordinates leave them out") {
  const TempFolder folder;
  for (const char* name : {"m", "m.ply", "m.obj", "m.glb", "m.gltf"}) CHECK(keeps_uvs(name));
  CHECK_THROWS_AS(keeps_uvs("m.3mf"), DataError);
  CHECK(keeps_map("m.ply", MapUse::colour));
  CHECK_FALSE(keeps_map("m.ply", MapUse::normal));
  CHECK(keeps_map("m.obj", MapUse::normal));
  CHECK_FALSE(keeps_map("m.obj", MapUse::occlusion));
  CHECK(keeps_map("m.glb", MapUse::occlusion));
  Mesh without = textured_square();
  without.columns.clear();
  for (const char* name : {"m.stl", "m.off"}) {
    CHECK_FALSE(keeps_uvs(name));
    write_textured(folder / name, textured_square(), square_options());
    const std::string bytes = read_file(folder / name);
    write_mesh(folder / name, without, PositionType::float32);
    CHECK((read_file(folder / name) == bytes));
  }
  CHECK(files_in(folder) == 2);
}

TEST_CASE("materials of a mesh without texture coordinates have no pictures") {
  const TempFolder folder;
  Mesh mesh = textured_square();
  mesh.columns.uvs.clear();
  MeshSinkOptions options = square_options();
  options.uvs = false;
  for (const char* name : {"m.obj", "m.ply", "m.glb", "m.gltf"}) {
    write_textured(folder / name, mesh, options);
    CHECK(read_file(folder / name).find("atlas") == std::string::npos);
    CHECK(read_file(folder / name).find("exture") == std::string::npos);
  }
  CHECK(read_file(folder / "m.mtl") ==
        "newmtl front\nKd 1 1 1\nd 1\nnewmtl back\nKd 1 1 1\nd 0.5\n");
  CHECK(files_in(folder) == 6);  // m.bin included
}

TEST_CASE("a mesh that has texture coordinates may have no triangles, and no vertices") {
  const TempFolder folder;
  for (const char* name : {"m.obj", "m.ply", "m.glb", "m.gltf", "m.stl", "m.off"}) {
    for (const std::size_t vertices : {4U, 0U}) {
      MeshSinkOptions options = square_options();
      options.packing = Packing::compressed;
      write_textured(folder / name,
                     {{k_square_vertices.begin(), k_square_vertices.begin() + vertices}, {}},
                     options);
      if (vertices > 0 || keeps_uvs(name)) CHECK(read_path(folder / name).mesh.triangles.empty());
    }
  }
}
