// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The messages about a mesh's attributes, and about those that are left out.
#include <array>
#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include "support/shell.hpp"

using meshfarm::test::has;
using meshfarm::test::lines;
using meshfarm::test::Ran;
using meshfarm::test::Shell;
namespace fs = std::filesystem;

TEST_CASE("info names the labels of triangles, and convert what it leaves out of them") {
  Shell shell;
  shell.file("m.mtl", "newmtl stone\nKd 1 0 0\nnewmtl glass\nd 0.5\n");
  const std::string mesh = shell.file("m.obj",
                                      "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n"
                                      "usemtl stone\nf 1 2 3\nusemtl glass\nf 3 2 4\n");
  CHECK(has(shell({"info", mesh}).out, "labels           material: 2 (stone, glass)\n"));
  const std::string json = shell({"info", mesh, "--json"}).out;
  CHECK(has(json, "\"name\": \"material\""));
  CHECK(has(json, "\"glass\""));
  const auto left_out = [&](const std::string& from, const std::string& to) {
    const Ran ran = shell({"convert", from, shell.path(to)});
    CHECK(ran.code == 0);
    return ran.err;
  };
  CHECK_FALSE(has(left_out(mesh, "m.glb"), "not kept"));
  CHECK(has(left_out(mesh, "m.ply"), "not kept: names and colours of materials\n"));
  CHECK(has(left_out(mesh, "m.stl"), "not kept: material libraries (1), uses of materials (2)\n"));
  CHECK(has(left_out(shell.path("m.ply"), "m.off"), "not kept: face.material_index\n"));
  CHECK(
      has(shell({"info", shell.path("m.ply")}).out, "labels           material_index: numbers\n"));
}

TEST_CASE("convert names what it leaves out, and refuses what it cannot do in a line") {
  Shell shell;
  const std::string mesh = shell.path("m.obj");
  std::ofstream(mesh)
      << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nvn 0 0 1\nf 1 2 3\nf 1 2\nf 1 2 4\n";
  const Ran ran = shell({"convert", mesh, shell.path("m.stl")});
  CHECK(ran.code == 0);
  CHECK(ran.out.empty());
  CHECK(has(ran.err, "m.obj: not kept: normals (1)"));
  CHECK(has(ran.err, "m.obj: left out: 1 faces of 0 to 2 corners"));
  CHECK(has(ran.err, "m.obj: left out: 1 triangles with positions that are not finite"));
  CHECK(fs::file_size(shell.path("m.stl")) == 84 + 50);
  std::ofstream(mesh, std::ios::app) << "f 1 2 9\n";
  for (const auto& [from, to, why] :
       {std::array<std::string, 3>{mesh, shell.path("x.ply"), "line 9: vertex index 9 is out of"},
        {mesh, shell.path("x.ply.gz"),
         "cannot write .gz; meshfarm writes .ply, .glb, .gltf, .off, .obj and .stl"},
        {shell.path("none"), shell.path("x.ply"), "No such file"},
        {mesh, shell.path("none/x.ply"), "No such file"}}) {
    const Ran refused = shell({"convert", from, to});
    CHECK(refused.code == 1);
    CHECK(lines(refused.err) == 1);
    CHECK(has(refused.err, why));
    CHECK_FALSE(fs::exists(shell.path("x.ply")));
  }
  CHECK(shell({"convert", mesh}).code == 2);
}
