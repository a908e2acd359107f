// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstring>
#include <limits>

#include <doctest/doctest.h>

#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

template <class T>
void put(std::string& bytes, T value) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

/// The soup of a square's two triangles, with `claimed` as the header's count.
std::string square_stl(std::uint32_t claimed = 2, std::string header = "by a test") {
  header.resize(80);
  put(header, claimed);
  for (const Triangle& t : k_square_triangles) {
    for (int i = 0; i < 3; ++i) put(header, 0.0F);
    for (const std::uint32_t v : t) {
      const Vec3 p = k_square_vertices[v];
      for (const double x : {p.x, p.y, p.z}) put(header, static_cast<float>(x));
    }
    put(header, std::uint16_t{0x1234});
  }
  return header;
}

/// Reads the bytes as a file of this name.
ReadFile read_as(const char* name, std::string_view bytes) {
  const TempFolder folder;
  write_file(folder / name, bytes);
  return read_path(folder / name);
}

std::string refusal_as(const char* name, std::string_view bytes) {
  const TempFolder folder;
  write_file(folder / name, bytes);
  try {
    read_path(folder / name);
  } catch (const DataError& error) {
    return std::string(error.what()).substr(folder.path().string().size() + 1);
  }
  return "";
}

void check_soup(const ReadFile& read) {
  CHECK(read.info.format == "STL binary");
  CHECK(read.info.vertices == 6);
  CHECK(read.info.faces == 2);
  CHECK(read.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}});
  REQUIRE(read.mesh.positions.size() == 6);
  for (std::size_t i = 0; i < 6; ++i) {
    CHECK(read.mesh.positions[i] == k_square_vertices[k_square_triangles[i / 3][i % 3]]);
  }
}

}  // namespace

TEST_CASE("a binary STL is told by its size, whatever its name and its header are") {
  check_soup(read_as("m", square_stl()));
  check_soup(read_as("m.stl", square_stl()));
  check_soup(read_as("m.STL", square_stl(2, "solid but not text\nfacet normal")));
  check_soup(read_as("m", square_stl(2, "solid but not text\nfacet normal")));
}

TEST_CASE("the size of a binary STL says more than its count") {
  const Quiet quiet;
  check_soup(read_as("m.stl", square_stl(0)));
  check_soup(read_as("m.stl", square_stl(7)));
  // The count only matters where the size fits no number of triangles.
  check_soup(read_as("m.stl", square_stl(2) + "tail"));
}

TEST_CASE("a count that is not the size's is told") {
  const std::string told = stderr_of([] { read_as("m.stl", square_stl(7)); });
  CHECK(told.find("the header of this STL counts 7 triangles, but its size is that of 2, which are "
                  "read") != std::string::npos);
}

TEST_CASE("a binary STL that is cut off is refused") {
  const std::string whole = square_stl();
  CHECK(refusal_as("m.stl", whole.substr(0, 180)) ==
        "m.stl: the header of this STL counts 2 triangles, and would end at byte 184, but the file "
        "ends at byte 180, in triangle 1");
  CHECK(refusal_as("m.stl", whole.substr(0, 83)) ==
        "m.stl: truncated: a binary STL has 84 bytes at least, but the file ends at byte 83");
  CHECK(refusal_as("m.stl", "") ==
        "m.stl: truncated: a binary STL has 84 bytes at least, but the file ends at byte 0");
  CHECK(refusal_as("m", whole.substr(0, 180)).starts_with("m: unknown format"));
}

TEST_CASE("a corner of a binary STL that is not finite has no position") {
  std::string bytes = square_stl();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + 84 + 12, &nan, sizeof nan);
  const ReadFile read = read_as("m.stl", bytes);
  CHECK_FALSE(has_position(read.mesh.positions[0]));
  CHECK(read.mesh.triangles == std::vector<Triangle>{{3, 4, 5}});
}

TEST_CASE("an STL without triangles is read") {
  std::string bytes = square_stl(0);
  bytes.resize(84);
  CHECK(read_as("m.stl", bytes).mesh.positions.empty());
  CHECK(read_as("m", bytes).mesh.positions.empty());
}
