// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

std::string with_line_ends(std::string text, std::string_view line_end) {
  std::string result;
  for (const char c : text) c == '\n' ? result += line_end : result += c;
  return result;
}

/// An ascii square whose header has `lines` in place of the first property.
std::string ply_square_with(std::string_view lines) {
  return replaced(ascii_square(), "property float x\n", lines);
}

}  // namespace

TEST_CASE("the header tells what is in the file") {
  const ReadFile read = read_bytes(ascii_square());
  check_square(read);
  CHECK(read.info.format == "PLY ascii");
  CHECK(read.info.compression == "none");
  CHECK(read.info.faces == 2);
  CHECK(read.info.positions == PositionType::float32);
  CHECK(read.info.skipped.empty());
  CHECK(read_bytes(binary_square().text()).info.format == "PLY binary little endian");
  CHECK(read_bytes(binary_square(BinaryFile::Order::big).text()).info.format ==
        "PLY binary big endian");
}

TEST_CASE("lines may end in LF, CR LF or CR") {
  check_square(read_bytes(with_line_ends(ascii_square(), "\r\n")));
  check_square(read_bytes(with_line_ends(ascii_square(), "\r")));
  const BinaryFile file = binary_square();
  const std::string header = file.text().substr(0, file.header_bytes());
  const std::string body = file.text().substr(file.header_bytes());
  check_square(read_bytes(with_line_ends(header, "\r\n") + body));
  check_square(read_bytes(with_line_ends(header, "\r") + body));
  check_square(read_bytes(replaced(header, "end_header\n", "end_header\r\n") + body));
}

TEST_CASE("a binary body that begins with a line end keeps it") {
  for (const std::uint32_t first : {0x40bef60aU, 0x40bef60dU, 0x40be0a0dU}) {
    float x;
    std::memcpy(&x, &first, sizeof x);
    BinaryFile file(BinaryFile::Order::little, mesh_elements(1, 0));
    file.floats({x, 2, 3});
    const std::string header = file.text().substr(0, file.header_bytes());
    const std::string body = file.text().substr(file.header_bytes());
    for (const std::string_view line_end : {"\n", "\r"}) {
      const ReadFile read = read_bytes(with_line_ends(header, line_end) + body);
      CHECK(read.mesh.positions == std::vector<Vec3>{{x, 2, 3}});
    }
  }
}

TEST_CASE("line ends before the first line, blank lines and stray blanks are let pass") {
  check_square(read_bytes("\n" + ascii_square()));
  check_square(read_bytes("\r\n\n" + ascii_square()));
  check_square(read_bytes(ply_square_with("\n \t\nproperty   float\tx \n")));
  check_square(read_bytes(replaced(ascii_square(), "element face", "\t element\tface ")));
  check_square(read_bytes(replaced(ascii_square(), "ply\n", "ply  \n")));
}

TEST_CASE("comments and obj_info may stand anywhere") {
  check_square(
      read_bytes(ply_square_with("comment element face 7\nproperty float x\nobj_info n 1\n")));
  check_square(read_bytes(replaced(ascii_square(), "end_header", "comment\nobj_info\nend_header")));
}

TEST_CASE("a comment that lacks its keyword is let pass before the first element only, and told") {
  const std::string bytes = replaced(ascii_square(), "1.0\n", "1.0\nCreated by hand\n");
  const std::string told = stderr_of([&] { check_square(read_bytes(bytes)); });
  CHECK(told.find("header line 3: taken for a comment: 'Created by hand'") != std::string::npos);
  CHECK(refusal(ply_square_with("propertx float x\n")) ==
        "m.ply: header line 4: unknown keyword 'propertx'");
}

TEST_CASE("what is not used is skipped and listed") {
  std::string bytes = ply_square_with("property uchar red\nproperty float x\n");
  bytes = replaced(bytes, "vertex_indices\n",
                   "vertex_indices\nproperty list uchar float uv\nelement material 0\n"
                   "property int id\n");
  bytes = replaced(bytes, "element face 2\n", "element face 0\nproperty int flags\n");
  bytes.resize(bytes.find("end_header\n") + 11);
  bytes += "7 0 0 0\n7 1 0 0\n7 0 1 0\n7 1 1 0\n";
  const ReadFile read = read_bytes(bytes);
  CHECK(read.mesh.positions.size() == 4);
  CHECK(read.info.skipped ==
        std::vector<std::string>{"face.flags", "face.uv", "material (0 elements)"});
}

TEST_CASE("positions are as wide as the header's types ask for") {
  const auto positions = [](std::string_view type) {
    return read_bytes(ply_square_with("property " + std::string(type) + " x\n")).info.positions;
  };
  for (const auto narrow : {"float", "float32", "char", "uint8", "short", "uint16"}) {
    CHECK(positions(narrow) == PositionType::float32);
  }
  for (const auto wide : {"double", "float64", "int", "uint32", "int64", "uint64"}) {
    CHECK(positions(wide) == PositionType::float64);
  }
}

TEST_CASE("vertex_index is another name of the corners") {
  check_square(read_bytes(replaced(ascii_square(), "vertex_indices", "vertex_index")));
}

TEST_CASE("a mesh may have no faces") {
  const std::string points = "ply\nformat ascii 1.0\nelement vertex 2\n" + std::string(k_xyz) +
                             "end_header\n1 2 3\n4 5 6\n";
  const ReadFile read = read_bytes(points);
  CHECK(read.mesh.positions == std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}});
  CHECK(read.mesh.triangles.empty());
  CHECK(read.info.faces == 0);
  const std::string no_list = replaced(points, "end_header", "element face 0\nend_header");
  CHECK(read_bytes(no_list).mesh.triangles.empty());
  CHECK(refusal(replaced(no_list, "face 0", "face 1")) ==
        "m.ply: element face has no list vertex_indices");
  CHECK(refusal(ply_square_with("property float x\n").replace(0, 0, "")).empty());
  CHECK(refusal(replaced(ascii_square(), "list uchar int", "int")) ==
        "m.ply: element face has no list vertex_indices");
}

TEST_CASE("an empty mesh is read") {
  const ReadFile read =
      read_bytes("ply\nformat ascii 1.0\n" + mesh_elements(0, 0) + "end_header\n");
  CHECK(read.mesh.positions.empty());
  CHECK(read.mesh.triangles.empty());
}

TEST_CASE("malformed headers are refused with the line") {
  const auto changed = [](std::string_view from, std::string_view to) {
    return refusal(replaced(ascii_square(), from, to));
  };
  CHECK(changed("property float x\n", "") == "m.ply: the vertices have no x");
  CHECK(changed("float y", "float why") == "m.ply: the vertices have no y");
  CHECK(changed("property float z", "property list uchar float z") ==
        "m.ply: the vertices have no z");
  CHECK(changed("element vertex", "element corner") == "m.ply: the header has no element vertex");
  CHECK(changed("float x", "real x") == "m.ply: header line 4: unknown type 'real'");
  CHECK(changed("list uchar int", "list uchar string") ==
        "m.ply: header line 8: unknown type 'string'");
  CHECK(changed("list uchar int", "list list int") == "m.ply: header line 8: unknown type 'list'");
  CHECK(changed("float y", "float x") ==
        "m.ply: header line 5: element 'vertex' has a second property 'x'");
  CHECK(changed("element face", "element vertex") ==
        "m.ply: header line 7: a second element 'vertex'");
  CHECK(changed("vertex 4", "vertex four") ==
        "m.ply: header line 3: the count of element 'vertex' is 'four'");
  CHECK(changed("vertex 4", "vertex -4") ==
        "m.ply: header line 3: the count of element 'vertex' is '-4'");
  CHECK(changed("vertex 4", "vertex 18446744073709551616") ==
        "m.ply: header line 3: the count of element 'vertex' is '18446744073709551616'");
  CHECK(changed("vertex 4", "vertex") ==
        "m.ply: header line 3: an element line is: element NAME COUNT");
  CHECK(changed("float x", "float") ==
        "m.ply: header line 4: a property line is: property [list TYPE] TYPE NAME");
  CHECK(changed("element vertex 4\n", "") == "m.ply: header line 3: a property before any element");
  CHECK(changed("ascii", "text") == "m.ply: header line 2: unknown format 'text'");
  CHECK(changed("1.0", "2.0") == "m.ply: header line 2: unknown version '2.0'");
  CHECK(changed(" 1.0", "") == "m.ply: header line 2: a format line has three words");
  CHECK(changed("format ascii 1.0\n", "").ends_with(": there is no format line"));
  CHECK(changed("element vertex", "format ascii 1.0\nelement vertex") ==
        "m.ply: header line 3: a second format line");
  CHECK(changed("float x", "fl\x01oat x") == "m.ply: header line 4: unknown type 'fl?oat'");
}

TEST_CASE("a header has an end, and a bounded length") {
  CHECK(refusal("ply\n") == "m.ply: the header has no end_header within 4 bytes");
  CHECK(refusal("ply") == "m.ply: the header has no end_header within 3 bytes");
  CHECK(refusal(replaced(ascii_square(), "end_header\n", "")).find("unknown keyword '0'") !=
        std::string::npos);
  std::string endless = "ply\nformat ascii 1.0\n";
  while (endless.size() < 2 << 20) endless += "comment and another comment\n";
  CHECK(refusal(endless) == "m.ply: the header has no end_header within 1048576 bytes");
  std::string many = "ply\nformat ascii 1.0\nelement vertex 0\n";
  for (int i = 0; i < 5000; ++i) many += "property int p" + std::to_string(i) + "\n";
  CHECK(refusal(many + "end_header\n") == "m.ply: header line 4100: too many properties");
}
