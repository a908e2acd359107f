// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <support/meshes.hpp>

#include <meshfarm/io/mesh_format.hpp>

#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

using PlyLabels = std::vector<Label>;

/// A square whose faces have these properties and records.
std::string ascii(std::string_view properties, std::string_view faces) {
  return "ply\nformat ascii 1.0\nelement vertex 4\n" + std::string(k_xyz) + "element face 2\n" +
         std::string(properties) + "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n" + std::string(faces);
}

/// The name of the labels that faces with these properties have; empty if there are none.
std::string name_with(std::string_view properties) {
  const std::string file = "ply\nformat ascii 1.0\nelement vertex 0\n" + std::string(k_xyz) +
                           "element face 1\n" + std::string(properties) + "end_header\n" +
                           "0 0 0 0 0 0 0 0\n";
  const TempFolder folder;
  write_file(folder / "m", file);
  const auto source = open_mesh(folder / "m");
  return source->info().labels ? source->info().labels->name : "";
}

std::string with_corners(std::string_view more) {
  return std::string(k_corners) + std::string(more);
}

BinaryFile binary(BinaryFile::Order order, std::string_view properties) {
  BinaryFile file(order, "element vertex 5\n" + std::string(k_xyz) + "element face 4\n" +
                             std::string(properties));
  file.floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 9, 9, 9});
  return file;
}

}  // namespace

TEST_CASE("a whole number that faces have is their label, by its name or because it is alone") {
  CHECK(name_with(with_corners("property int flags\nproperty uchar region\n")) == "region");
  CHECK(name_with(with_corners("property short class\nproperty uchar region\n")) == "class");
  CHECK(name_with("property int material_index\n" + std::string(k_corners)) == "material_index");
  CHECK(name_with(with_corners("property ushort patch\nproperty float weight\n")) == "patch");
  CHECK(name_with(with_corners("property int flags\n")).empty());
  CHECK(name_with(with_corners("property uchar red\n")).empty());
  CHECK(name_with(with_corners("property int one\nproperty int two\n")).empty());
  CHECK(name_with(with_corners("property float label\n")).empty());
  CHECK(name_with(with_corners("property int64 label\n")).empty());
  CHECK(name_with(with_corners("property list uchar int label\n")).empty());
  CHECK(name_with(k_corners).empty());
}

TEST_CASE("ascii labels are those of all triangles of a face") {
  const ReadFile read = read_bytes(ascii(with_corners("property int label\nproperty float q\n"),
                                         "4 0 1 3 2 -1 0.5\n3 0 1 2 7 0\n"));
  CHECK(read.mesh.columns.labels == PlyLabels{UINT32_MAX, UINT32_MAX, 7});
  CHECK(read.info.labels == LabelMeaning{"label", {}});
  CHECK(read.info.skipped == std::vector<std::string>{"face.q"});
  const ReadFile early = read_bytes(
      ascii("property uchar label\n" + std::string(k_corners), "5 3 0 1 2\n4 3 0 1 3\n"));
  CHECK(early.mesh.columns.labels == PlyLabels{5, 4});
  CHECK(read_bytes(ascii(k_corners, "3 0 1 2\n3 0 1 3\n")).mesh.columns.labels.empty());
}

TEST_CASE("a label that is no whole number of 32 bits is refused") {
  const std::string properties = with_corners("property int label\n");
  CHECK(refusal(ascii(properties, "3 0 1 2 7\n3 0 1 2 x\n")) ==
        "m.ply: face 1 on line 16: label is 'x', which is not a whole number");
  CHECK(refusal(ascii(properties, "3 0 1 2 4294967296\n3 0 1 2 1\n")) ==
        "m.ply: face 0 on line 15: label is 4294967296, which has more than 32 bits");
}

TEST_CASE("ascii labels are the same however many threads read them") {
  std::string faces;
  PlyLabels labels;
  std::string file = "ply\nformat ascii 1.0\nelement vertex 4\n" + std::string(k_xyz) +
                     "element face 30000\n" + with_corners("property ushort label\n") +
                     "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
  for (int i = 0; i < 30'000; ++i) {
    const bool is_triangle = i % 3 != 0;
    file += (is_triangle ? "3 0 1 2 " : "4 0 1 3 2 ") + std::to_string(i / 5) + "\n";
    labels.insert(labels.end(), is_triangle ? 1 : 2, static_cast<Label>(i / 5));
  }
  const TempFolder folder;
  write_file(folder / "m", file);
  for (const unsigned threads : {1U, 4U}) {
    CHECK(read_mesh(*open_mesh(folder / "m", {.threads = threads})).columns.labels == labels);
  }
}

TEST_CASE("binary labels come in either byte order, before and after the corners") {
  for (const auto order : {BinaryFile::Order::little, BinaryFile::Order::big}) {
    BinaryFile after = binary(order, with_corners("property short region\n"));
    const auto add = [&](std::initializer_list<std::int32_t> corners, std::int16_t label) {
      after.bytes({static_cast<std::uint8_t>(corners.size())}).ints(corners);
      after.put<std::int16_t>({label});
    };
    add({0, 1, 2}, 300);
    add({0, 1, 2, 3}, -2);
    add({0, 1}, 9);
    add({2, 3, 4}, 4);
    const ReadFile read = read_bytes(after.text());
    CHECK(read.mesh.columns.labels == PlyLabels{300, UINT32_MAX - 1, UINT32_MAX - 1, 4});
    CHECK(read.mesh.triangles.size() == 4);
    BinaryFile before = binary(order, "property uint region\n" + std::string(k_corners));
    for (const std::uint32_t label : {7U, 0U, UINT32_MAX, 7U}) {
      before.put<std::uint32_t>({label}).bytes({3}).ints({0, 1, 2});
    }
    CHECK(read_bytes(before.text()).mesh.columns.labels == PlyLabels{7, 0, UINT32_MAX, 7});
    // With another list, records have no fixed size.
    BinaryFile listed =
        binary(order, with_corners("property list uchar uchar more\nproperty uchar label\n"));
    for (const std::uint8_t label : std::initializer_list<std::uint8_t>{1, 2, 3, 4}) {
      listed.bytes({3}).ints({0, 1, 2}).bytes({2, 77, 77, label});
    }
    CHECK(read_bytes(listed.text()).mesh.columns.labels == PlyLabels{1, 2, 3, 4});
  }
}

TEST_CASE("a face that is too long to be cut has its label in all of its triangles") {
  constexpr std::uint32_t k_corner_count = 70'000;
  for (const bool is_late : {true, false}) {
    BinaryFile file(BinaryFile::Order::little, "element vertex 3\n" + std::string(k_xyz) +
                                                   "element face 2\n" +
                                                   (is_late ? "" : "property int label\n") +
                                                   "property list uint int vertex_indices\n" +
                                                   (is_late ? "property int label\n" : ""));
    file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const auto add = [&](std::uint32_t count, std::int32_t label) {
      if (!is_late) file.ints({label});
      file.put<std::uint32_t>({count});
      for (std::uint32_t i = 0; i < count; ++i) file.ints({static_cast<std::int32_t>(i % 3)});
      if (is_late) file.ints({label});
    };
    add(3, 1);
    add(k_corner_count, 2);
    PlyLabels expected(k_corner_count - 1, 2);
    expected[0] = 1;
    const Quiet quiet;
    CHECK(read_bytes(file.text()).mesh.columns.labels == expected);
  }
}

TEST_CASE("labels that are not wanted count as skipped") {
  const TempFolder folder;
  write_file(folder / "m", ascii(with_corners("property int label\n"), "3 0 1 2 7\n3 1 2 3 7\n"));
  const auto source = open_mesh(folder / "m", {.labels = false});
  CHECK_FALSE(source->info().labels);
  CHECK(source->info().skipped == std::vector<std::string>{"face.label"});
  CHECK(read_mesh(*source).columns.labels.empty());
}

TEST_CASE("PLY labels have the smallest type that holds all materials") {
  const TempFolder folder;
  Mesh mesh = tetrahedron();
  mesh.columns.labels = {0, 1, 1, 0};
  const auto check = [&](std::size_t materials, const std::string& line, std::size_t bytes) {
    LabelMeaning meaning{"material", std::vector<Material>(materials)};
    write_mesh(folder / "m.ply", mesh, PositionType::float32, {}, {}, meaning);
    const std::string file = read_file(folder / "m.ply");
    const std::size_t at = file.find("vertex_indices\n" + line + "\nend_header\n");
    REQUIRE(at != std::string::npos);
    CHECK(file.size() == file.find("end_header\n") + 11 + std::size_t{48} + 4 * (13 + bytes));
    const ReadFile read = read_path(folder / "m.ply");
    CHECK(read.mesh.columns.labels == mesh.columns.labels);
    CHECK(read.mesh.triangles == mesh.triangles);
  };
  check(2, "property uchar material_index", 1);
  check(256, "property uchar material_index", 1);
  check(257, "property ushort material_index", 2);
  check(65'537, "property uint material_index", 4);
  mesh.columns.labels = {UINT32_MAX, 1, 1, 0};
  check(0, "property uint material_index", 4);
  write_mesh(folder / "m.ply", mesh, PositionType::float32, {}, {}, LabelMeaning{"my part", {}});
  CHECK(read_path(folder / "m.ply").info.labels == LabelMeaning{"my_part", {}});
  write_mesh(folder / "m.ply", mesh, PositionType::float32);
  CHECK(read_path(folder / "m.ply").info.labels == LabelMeaning{"label", {}});
}
