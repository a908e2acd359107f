// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/util/errors.hpp>

#include "gltf_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

TEST_CASE("an output has an extension that is written, or none") {
  for (const char* path : {"a.ply", "a.PLY", "folder.obj/a.ply", "a", "folder.obj/a", "a.b.ply",
                           "a.obj", "a.STL", "a.off", "a.glb", "a.gltf"}) {
    INFO(path);
    CHECK_NOTHROW(check_output_format(path));
  }
}

TEST_CASE("an output that would not be what its name says is refused") {
  for (const char* path :
       {"a.gltf.gz", "a.objs", "a.ply.gz", "a.ply.zst", "a.ply/b.fbx", "a.plyx"}) {
    INFO(path);
    CHECK_THROWS_AS(check_output_format(path), DataError);
  }
  CHECK_THROWS_WITH(
      check_output_format("f/a.fbx"),
      "f/a.fbx: cannot write .fbx; meshfarm writes .ply, .glb, .gltf, .off, .obj and .stl, "
      "not compressed");
}

TEST_CASE("without an extension the output is PLY") {
  const TempFolder folder;
  const Mesh mesh{k_square_vertices, k_square_triangles};
  write_mesh(folder / "square", mesh, PositionType::float32);
  CHECK(read_file(folder / "square") == binary_square().text());
  write_mesh(folder / "square.PLY", mesh, PositionType::float32);
  CHECK(read_file(folder / "square.PLY") == binary_square().text());
}

TEST_CASE("a GLB or glTF is known by its content, whatever its name") {
  const TempFolder folder;
  write_file(folder / "m.bin", k_square_binary);
  const std::string text =
      with(k_square_json, "\"byteLength\":60", R"("byteLength":60,"uri":"m.bin")");
  for (const char* name : {"m.stl", "m.obj", "m.off", "m.ply"}) {
    CAPTURE(name);
    write_file(folder / name, square_glb());
    check_square(read_path(folder / name));
    write_file(folder / name, text);
    check_square(read_path(folder / name));
  }
}

TEST_CASE("a binary STL may begin as a JSON does") {
  const TempFolder folder;
  write_mesh(folder / "m.stl", {k_square_vertices, k_square_triangles}, PositionType::float32);
  std::string bytes = read_file(folder / "m.stl");
  bytes[0] = '{';
  write_file(folder / "m", bytes);
  CHECK(read_path(folder / "m").info.format == "STL binary");
}

TEST_CASE("a mesh of a format that is not written is not begun") {
  const TempFolder folder;
  CHECK_THROWS_AS(create_mesh(folder / "a.fbx", {}), DataError);
  CHECK(std::filesystem::is_empty(folder.path()));
}
