// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <support/meshes.hpp>

#include <meshfarm/io/mesh_format.hpp>

#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

constexpr std::string_view k_square = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.5\n";

std::string obj_square_with(std::string_view faces) {
  return std::string(k_square) + std::string(faces);
}

std::vector<Triangle> triangles_of(std::string_view faces) {
  return read_bytes(obj_square_with(faces)).mesh.triangles;
}

Mesh read_by(unsigned threads, std::string_view bytes) {
  const TempFolder folder;
  write_file(folder / "m", bytes);
  return read_mesh(*open_mesh(folder / "m", {.threads = threads}));
}

/// A grid, large enough for many pieces, whose rows use relative indices if `relative`.
std::string large_obj(bool relative) {
  constexpr int k_columns = 100;
  constexpr int k_rows = 1000;
  std::string text;
  for (int row = 0; row < k_rows; ++row) {
    for (int i = 0; i < k_columns; ++i) {
      text += "v " + std::to_string(i) + " " + std::to_string(row) + " 0\n";
    }
    for (int i = 1; row > 0 && i < k_columns; ++i) {
      const int from = relative ? -2 * k_columns - 1 : k_columns * (row - 1);
      const auto corner = [&](int at) { return " " + std::to_string(from + at); };
      text += "f" + corner(i) + corner(i + 1) + corner(i + 1 + k_columns) + "\n";
      text += "f" + corner(i) + corner(i + 1 + k_columns) + corner(i + k_columns) + " # half\n";
    }
  }
  return text;
}

}  // namespace

TEST_CASE("an OBJ is its vertices and faces") {
  const ReadFile read = read_bytes(obj_square_with("f 1 2 3\nf 3 2 4\n"));
  CHECK(read.info.format == "OBJ");
  CHECK(read.info.faces == 2);
  CHECK(read.info.positions == PositionType::float32);
  CHECK(read.info.skipped.empty());
  check_square(read);
}

TEST_CASE("the corners of an OBJ face may have texture coordinates and normals") {
  for (const auto faces : {"f 1/1 2/2 3/3\nf 3/1 2/2 4/3\n", "f 1//1 2//1 3//1\nf 3//1 2//1 4//1\n",
                           "f 1/1/1 2/2/1 3/3/1\nf 3/3/1 2/2/1 4/1/1\n", "f 1/ 2/ 3/\nf 3 2 4\n",
                           "f 1/-1/-1 2//-1 3\nf 3 2 4\n"}) {
    CAPTURE(faces);
    check_square(read_bytes(obj_square_with(faces)));
  }
}

TEST_CASE("relative OBJ indices count back from the line they are on") {
  check_square(read_bytes(obj_square_with("f -4 -3 -2\nf -2/-1 -3/-1 -1/-1\n")));
  check_square(read_bytes("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 1 1 0.5\nf -2 -3 -1\n"));
  check_square(read_bytes("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 -2 3\nv 1 1 0.5\nf 3 2 -1\n"));
}

TEST_CASE("a face may come before its vertices") {
  check_square(read_bytes("f 1 2 3\nf 3 2 4\n" + std::string(k_square)));
}

TEST_CASE("lines of an OBJ may be joined, commented, blank, indented, and end in any way") {
  for (const auto text : {
           "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.5\nf 1 \\\n2 \\\n3\nf 3 2\\\n 4",
           "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nv 1 1 0.5\r\nf 1 \\\r\n2 3\r\nf 3 2 4\r\n",
           "v 0 0 0\rv 1 0 0\rv 0 1 0\rv 1 1 0.5\rf 1 2 3\rf 3 2 4\r",
           "# f 1 2 3\n\n v  0\t0 0 #a\n\tv 1 0 0\nv 0 1 0#b\nv 1 1 5e-1 \n\n f 1 2 3 # f\nf 3 2 4",
           "# a path is no joined line: C:\\models\\\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 \\\n 1 0.5\n"
           "f 1 2 3 # here, too: \\\nf 3 2 4\n",
       }) {
    CAPTURE(text);
    check_square(read_bytes(text));
  }
}

TEST_CASE("polygons of an OBJ are cut into triangles inside them") {
  CHECK(triangles_of("f 1 2 4 3\n") == std::vector<Triangle>{{0, 1, 3}, {0, 3, 2}});
  CHECK(triangles_of("f 1 2 3\nf 1 2 4 3\nf 3 2 4\n") ==
        std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}, {0, 3, 2}, {2, 1, 3}});
  // An arrowhead: a fan from its first corner would leave it.
  const ReadFile read = read_bytes("v 0 0 0\nv 2 1 0\nv 0 2 0\nv 0.5 1 0\nf 1 2 3 4\n");
  CHECK(read.mesh.triangles.size() == 2);
  for (const Triangle& t : read.mesh.triangles) {
    CHECK(std::find(t.begin(), t.end(), 3U) != t.end());
    CHECK(std::find(t.begin(), t.end(), 1U) != t.end());
  }
}

TEST_CASE("faces of an OBJ with fewer than three corners are left out and counted") {
  const ReadFile read = read_bytes(obj_square_with("f 1 2 3\nf 1 2\nf\nf 4\nf 3 2 4\n"));
  check_square(read);
  CHECK(read.info.faces == 5);
  CHECK(read.small_faces == 3);
}

TEST_CASE("a text may begin with a byte order mark") {
  const Quiet quiet;
  check_square(read_bytes("\xEF\xBB\xBF" + std::string(k_square) + "f 1 2 3\nf 3 2 4\n"));
}

TEST_CASE("what an OBJ has besides is named") {
  const Quiet quiet;
  const ReadFile read = read_bytes(
      "mtllib a b.mtl\no thing\n" + std::string(k_square) +
      "vt 0 0\nvt 1 1\nvn 0 0 1\ng one\nusemtl red\ns 1\nf 1 2 3\ng two\nf 3 2 4\nl 1 2\np 1\n"
      "vc 1 1 1\ncurv2 1 2\n");
  check_square(read);
  CHECK(read.info.skipped == std::vector<std::string>{"objects (1)", "texture coordinates (2)",
                                                      "normals (1)", "groups (2)",
                                                      "smoothing groups (1)", "lines (1)",
                                                      "points (1)", "vc (1)", "curv2 (1)"});
  using Words = std::vector<std::string>;
  CHECK(read_bytes("v 0 0 0\nv 0 0 0 1 0 0\n").info.skipped.empty());
  CHECK(read_bytes("v 0 0 0 1\n").info.skipped == Words{"vertex.weight"});
  CHECK(read_bytes("v 0 0 0 1 1 1 1\n").info.skipped == Words{"vertex.alpha"});
}

TEST_CASE("OBJ numbers are read by the rule of ascii PLY") {
  const auto positions = [](std::string_view text) { return read_bytes(text).info.positions; };
  CHECK(positions("v 0.1 0.100000001 0.10000000149011612\n") == PositionType::float32);
  CHECK(positions("v 0 0 0\nv 500123.45 5412345.678 312.25\n") == PositionType::float64);
  const ReadFile wide = read_bytes("v 0 0 0\nv 500123.45 5412345.678 312.25\nv 0 1 1\nf 1 2 3\n");
  CHECK(wide.mesh.positions[1] == Vec3{500123.45, 5412345.678, 312.25});
  std::string late = "v 0.12345675 0 0\n";
  while (late.size() < (std::size_t{2} << 20)) late += "v 0 1 0\n";
  CHECK(positions(late) == PositionType::float32);
  const ReadFile all = read_bytes(late + "v 500123.45 0 0\n");
  CHECK(all.info.positions == PositionType::float64);
  CHECK(all.mesh.positions.front().x == 0.12345675);
  CHECK(all.mesh.positions.back().x == 500123.45);
  CHECK_FALSE(has_position(read_bytes("v 0 nan 0\n").mesh.positions[0]));
  CHECK_FALSE(has_position(read_bytes("v 0 1e39 -inf\n").mesh.positions[0]));
}

TEST_CASE("a malformed OBJ is refused with its line") {
  const auto told = [](std::string_view faces) { return refusal(obj_square_with(faces)); };
  CHECK(told("f 1 2 5\n") == "m.ply: line 5: vertex index 5 is out of range: there are 4 vertices");
  CHECK(told("f 1 2 0\n") == "m.ply: line 5: vertex index 0 is out of range: there are 4 vertices");
  CHECK(told("\nf 1 2 -5\n") ==
        "m.ply: line 6: vertex index -5 is out of range: there are 4 vertices before");
  CHECK(told("f 1 2 -9223372036854775808\n").starts_with("m.ply: line 5: vertex index -92233"));
  CHECK(told("f 1 2 99999999999999999999\n").starts_with("m.ply: line 5: vertex index 92233"));
  CHECK(told("f 1 2 x\n") ==
        "m.ply: line 5: the corner 'x' of a face has no whole number for its vertex");
  CHECK(told("f 1 2 3.5\n").starts_with("m.ply: line 5: the corner '3.5' of a face"));
  CHECK(told("f 1 2 \\\n/3\n").starts_with("m.ply: line 6: the corner '/3' of a face"));
  CHECK(told("f 1 2 3/a\n").starts_with("m.ply: line 5: the corner '3/a' of a face"));
  CHECK(told("v 1 2\n") == "m.ply: line 5: the line ends before its last value");
  CHECK(told("v 1 2 x3\n") == "m.ply: line 5: the coordinate 'x3' is no number");
  CHECK(told("v 1,5 2 3\n") == "m.ply: line 5: the coordinate '1,5' is no number");
  CHECK(told("{\n") == "m.ply: line 5: '{' begins no statement of OBJ");
  CHECK(told(std::string_view("f 1 2 3\n\0\n", 10)) ==
        "m.ply: unknown format; meshfarm reads PLY, "
        "GLB, glTF, OFF, OBJ and STL, plain or compressed with gzip or zstd");
}

TEST_CASE("a line of an OBJ beyond many pieces is told as it is counted") {
  std::string text = large_obj(false);
  const auto lines = std::count(text.begin(), text.end(), '\n');
  const std::string why = "m.ply: line " + std::to_string(lines + 1) + ": ";
  CHECK(refusal(text + "v x\n") == why + "the coordinate 'x' is no number");
  CHECK(refusal(text + "f 1 2 100001\n") ==
        why + "vertex index 100001 is out of range: there are 100000 vertices");
}

TEST_CASE("threads do not change what is read of an OBJ") {
  const Mesh one = read_by(1, large_obj(false));
  CHECK(one.positions.size() == 100'000);
  CHECK(one.triangles.size() == 2 * 99 * 999);
  for (const bool relative : {false, true}) {
    const std::string text = large_obj(relative);
    for (const unsigned threads : {1U, 2U, 5U}) {
      const Mesh mesh = read_by(threads, text);
      CHECK(mesh.positions == one.positions);
      CHECK(mesh.triangles == one.triangles);
    }
  }
}

TEST_CASE("an OBJ statement may be longer than a block") {
  std::string text =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng " + std::string(3 << 20, 'x') + "\nf 1 2";
  for (int i = 0; i < 300'000; ++i) text += " \\\n";
  const Mesh mesh = read_by(2, text + "3\nf 1 3 4\n");
  CHECK(mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
}

TEST_CASE("a named OBJ may begin with a group of no name") {
  const TempFolder folder;
  const std::string text = "# by hand\n\ng\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  write_file(folder / "m.obj", text);
  CHECK(read_path(folder / "m.obj").mesh.triangles.size() == 1);
  write_file(folder / "m", text);
  CHECK_THROWS_AS(read_path(folder / "m"), DataError);
}

TEST_CASE("a named OBJ may be empty") {
  const TempFolder folder;
  write_file(folder / "m.obj", "# nothing\n");
  CHECK(read_path(folder / "m.obj").mesh.positions.empty());
}
