// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

constexpr std::string_view k_faces = "3 0 1 2\n3 2 1 3\n";

std::string off(std::string_view header) {
  return std::string(header) + std::string(k_square_text) + std::string(k_faces);
}

}  // namespace

TEST_CASE("the counts of an OFF stand on the first line, the next, or more of them") {
  for (const auto header :
       {"OFF\n4 2 0\n", "OFF 4 2 0\n", "OFF4 2 0\n", "OFF\n4 2\n", "OFF\n4\n2\n", "OFF\n4\n2 5\n",
        "# c\n\nOFF # a\n# b\n\n4 2 0 # d\n\n", "  OFF\r\n4 2 0\r\n"}) {
    CAPTURE(header);
    const ReadFile read = read_bytes(off(header));
    CHECK(read.info.format == "OFF ascii");
    CHECK(read.info.skipped.empty());
    check_square(read);
  }
}

TEST_CASE("comments and blank lines in the body of an OFF are passed over") {
  check_square(
      read_bytes("OFF\n4 2 0\n# vertices\n0 0 0 # the first\n\n1 0 0\n0 1 0\n #\n1 1 0.5\n# "
                 "faces\n3 0 1 2 # one\n\n3 2 1 3\n# end"));
}

TEST_CASE("normals, colours and texture coordinates of an OFF are named") {
  using Words = std::vector<std::string>;
  const auto vertices = [](std::string_view more) {
    std::string text;
    for (const auto xyz : {"0 0 0", "1 0 0", "0 1 0", "1 1 0.5"}) {
      text += std::string(xyz) + std::string(more) + "\n";
    }
    return text + std::string(k_faces);
  };
  const auto names = [&](std::string_view word, std::string_view more) {
    const ReadFile read = read_bytes(std::string(word) + "\n4 2 0\n" + vertices(more));
    check_square(read);
    Words told = read.info.skipped;
    for (const Channel& channel : read.info.channels) {
      told.push_back(channel.name + std::to_string(static_cast<int>(channel.type)));
    }
    return told;
  };
  CHECK(names("COFF", " 255 0 0 255") == Words{"red1", "green1", "blue1"});
  CHECK(names("COFF", " 0.5 0.5 0.5") == Words{"red4", "green4", "blue4"});
  CHECK(names("NOFF", " 0 0 1") == Words{"nx4", "ny4", "nz4"});
  const Words levels{"nx4", "ny4", "nz4", "red1", "green1", "blue1"};
  const Words shares{"nx4", "ny4", "nz4", "red4", "green4", "blue4"};
  CHECK(names("CNOFF", " 0 0.5 1.0 1 1 1 1") == levels);
  const Words normal_last{"red1", "green1", "blue1", "alpha1", "nx4", "ny4", "nz4"};
  CHECK(names("NCOFF", " 10 20 30 255 0 0.5 1.0") == normal_last);
  CHECK(names("CNOFF", " 0 0 1 1 0.5 1 1") == shares);
  CHECK(names("NCSTOFF", " 9 8 7 255 0 0 1 0.5 0.5").size() == 9);
  CHECK(names("CSTNOFF", " 0 0 1 9 8 7 0.5 0.5").size() == 8);
  CHECK(names("STOFF", " 0 0") == Words{"vertex.s", "vertex.t"});
  CHECK(stderr_of([&] { names("COFF", " 255 0 0 255"); }).empty());
}

TEST_CASE("values after the corners of an OFF face are told once") {
  const std::string text =
      "OFF\n4 2 0\n" + std::string(k_square_text) + "3 0 1 2 255 0 0\n3 2 1 3 0 255 0\n";
  const std::string told = stderr_of([&] { check_square(read_bytes(text)); });
  CHECK(std::count(told.begin(), told.end(), '\n') == 1);
  CHECK(
      told.find("there are values after the corners of faces, colours maybe; they are not read") !=
      std::string::npos);
}

TEST_CASE("polygons of an OFF are triangles, and small faces are counted") {
  const ReadFile read =
      read_bytes("OFF\n4 3 0\n" + std::string(k_square_text) + "4 0 1 3 2\n2 0 1\n3 2 1 3\n");
  CHECK(read.mesh.triangles == std::vector<Triangle>{{0, 1, 3}, {0, 3, 2}, {2, 1, 3}});
  CHECK(read.small_faces == 1);
}

TEST_CASE("a malformed OFF is refused with its line") {
  CHECK(refusal(off("OFF BINARY\n4 2 0\n")) ==
        "m.ply: line 1: binary OFF is not read: write it as ascii OFF, or as PLY");
  CHECK(refusal(off("4OFF\n4 2 0\n")) ==
        "m.ply: line 1: this OFF is not of three dimensions, and cannot be read");
  CHECK(refusal(off("nOFF 3\n4 2 0\n")).starts_with("m.ply: line 1: this OFF is not of three"));
  CHECK(refusal("OFF\n# none\n") == "m.ply: line 3: the file ends before its count of vertices");
  CHECK(refusal("OFF\n8") == "m.ply: line 2: the file ends before its count of faces");
  CHECK(refusal(off("OFF\n4 x 0\n")) == "m.ply: line 2: the count of faces is 'x'");
  CHECK(refusal(off("OFF\n4 -2 0\n")) == "m.ply: line 2: the count of faces is '-2'");
  CHECK(refusal(off("OFF\n4 2 0 1\n")) ==
        "m.ply: line 2: there is more than the counts on this line");
  CHECK(refusal(off("OFF\n4 3 0\n")).starts_with("m.ply: truncated: the file ends on line 9"));
  CHECK(refusal(off("OFF\n400 2 0\n")).starts_with("m.ply: truncated, or the header is wrong"));
  CHECK(refusal(replaced(off("OFF\n4 2 0\n"), "2 1 3", "2 1 4")) ==
        "m.ply: face 1 on line 8: vertex index 4 is out of range: there are 4 vertices");
  CHECK(refusal(off("NOFF\n4 2 0\n") + "# a comment that is long enough") ==
        "m.ply: vertex 2 on line 7: the line ends before its last value");
}

TEST_CASE("threads do not change what is read of an OFF with comments and colours") {
  const Quiet quiet;
  std::string text = "OFF\n20000 20000 0\n";
  for (int i = 0; i < 20'000; ++i)
    text += std::to_string(i) + " 0 " + std::to_string(i % 7) + " # v\n";
  for (int i = 0; i < 20'000; ++i) text += "3 " + std::to_string(i) + " 1 2 0.5 0.5 0.5\n# f\n";
  const TempFolder folder;
  write_file(folder / "m", text);
  const Mesh one = read_mesh(*open_mesh(folder / "m", {.threads = 1}));
  const Mesh many = read_mesh(*open_mesh(folder / "m", {.threads = 5}));
  CHECK(one.triangles.size() == 20'000);
  CHECK(one.positions[19'999] == Vec3{19'999, 0, 19'999 % 7});
  CHECK(many.positions == one.positions);
  CHECK(many.triangles == one.triangles);
}
