// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <support/meshes.hpp>

#include <meshfarm/io/mesh_format.hpp>

#include "io/label_materials.hpp"
#include "io/obj_names.hpp"
#include "io/srgb.hpp"
#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

using Labels = std::vector<Label>;
using NamesInFile = std::vector<std::string>;

constexpr std::string_view k_labelled_square = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.5\n";

NamesInFile names_of(const std::optional<LabelMeaning>& labels) {
  NamesInFile names;
  if (!labels) return names;
  for (const Material& material : labels->materials) names.push_back(material.name);
  return names;
}

ReadFile read_obj(std::string_view statements) {
  return read_bytes(std::string(k_labelled_square) + std::string(statements));
}

float linear(double level) {
  return static_cast<float>(linear_of_srgb(level));
}

/// Many statements, some of them with names.
std::string long_obj(std::string_view word, Labels& labels) {
  std::string text(k_labelled_square);
  for (int i = 0; i < 60'000; ++i) {
    if (i % 7000 == 6999) text += std::string(word) + " part" + std::to_string(i / 7000 % 3) + "\n";
    text += i % 5 == 0 ? "f 1 2 4 3\n" : "f 1 2 3 # one of many, so that there are blocks\n";
    const Label label = i < 6999 ? 0 : static_cast<Label>((i - 6999) / 7000 % 3 + 1);
    labels.insert(labels.end(), i % 5 == 0 ? 2 : 1, label);
  }
  return text;
}

}  // namespace

TEST_CASE("names are those that faces use, in the order of their use") {
  ObjNames all;
  all.begin_text();
  ObjNames first;
  first.set("unused");
  first.set("b");
  first.face();
  first.set("a");
  ObjNames second;
  second.face();  // still in a
  second.set("c");
  ObjNames third;
  third.set("b");
  third.face();
  for (const ObjNames* piece : {&first, &second, &third}) all.add(*piece);
  CHECK(all.names() == NamesInFile{"b", "a"});
  CHECK(all.label_of("a") == Label{1});
  CHECK_FALSE(all.label_of("c"));
  ObjNames without;
  without.face();
  ObjNames one;
  one.begin_text();
  one.add(without);
  CHECK(one.names() == NamesInFile{""});
}

TEST_CASE("materials of an OBJ are labels, those before the first have a name of their own") {
  const Quiet quiet;
  const ReadFile read = read_obj(
      "f 1 2 3\nusemtl never\nusemtl red one\nf 1 2 4 3\nusemtl default\nf 2 4 3\nusemtl red one\n"
      "g x\nf 1 2 3\ng y\nf 1 2 3\n");
  CHECK(read.mesh.columns.labels == Labels{0, 1, 1, 2, 1, 1});
  REQUIRE(read.info.labels);
  CHECK(read.info.labels->name == "material");
  CHECK(names_of(read.info.labels) == NamesInFile{"default_2", "red one", "default"});
  CHECK(read.info.skipped == NamesInFile{"groups (2)"});
  const ReadFile one = read_obj("usemtl stone\nf 1 2 3\n");
  CHECK(one.mesh.columns.labels == Labels{0});
  CHECK(names_of(one.info.labels) == NamesInFile{"stone"});
}

TEST_CASE("groups of an OBJ are labels if there are more than one and no materials") {
  const ReadFile read = read_obj("o one\ng a b\nf 1 2 3\ng c\nf 1 2 3\nf 2 3 4\ng a b\nf 1 2 3\n");
  CHECK(read.mesh.columns.labels == Labels{0, 1, 1, 0});
  REQUIRE(read.info.labels);
  CHECK(read.info.labels->name == "group");
  CHECK(names_of(read.info.labels) == NamesInFile{"a b", "c"});
  CHECK(read.info.skipped == NamesInFile{"objects (1)"});
  CHECK(names_of(read_obj("g a\no one\nf 1 2 3\no two\nf 1 2 3\n").info.labels) ==
        NamesInFile{"one", "two"});
  CHECK(names_of(read_obj("f 1 2 3\ng a\nf 1 2 3\n").info.labels) == NamesInFile{"default", "a"});
  CHECK_FALSE(read_obj("g a\nf 1 2 3\ng b\n").info.labels);
  CHECK_FALSE(read_obj("f 1 2 3\nusemtl a\n").info.labels);
  CHECK_FALSE(read_obj("f 1 2 3\n").info.labels);
}

TEST_CASE("materials have the colours of their libraries") {
  const TempFolder folder;
  write_file(folder / "a b.mtl", "newmtl red\nKd 1 0.5 0\nd 0.25\nnewmtl other\nKd 0 0 0\n");
  write_file(folder / "c.mtl",
             "newmtl red\nKd 0 0 1\nnewmtl glass\nTr 0.75\nKd 0 0 0\nmap_Kd none.png\n");
  write_file(folder / "m.obj", "mtllib a b.mtl\nmtllib c.mtl\n" + std::string(k_labelled_square) +
                                   "usemtl glass\nf 1 2 3\nusemtl red\nf 1 2 3\nusemtl lost\n"
                                   "f 1 2 3\n");
  const ReadFile read = read_path(folder / "m.obj");
  CHECK(read.info.skipped.empty());
  REQUIRE(read.info.labels);
  CHECK(read.info.labels->materials == std::vector<Material>{{"glass", {1, 1, 1, 0.25F}},
                                                             {"red", {1, linear(0.5), 0, 0.25F}},
                                                             {"lost", {1, 1, 1, 1}}});
  const auto plain = open_mesh(folder / "m.obj", {.labels = false});
  CHECK(plain->info().skipped == NamesInFile{"material libraries (2)", "uses of materials (3)"});
}

TEST_CASE("names go on across the blocks of a text, however many threads read it") {
  for (const char* word : {"usemtl", "g"}) {
    Labels labels;
    const TempFolder folder;
    write_file(folder / "m.obj", long_obj(word, labels));
    for (const unsigned threads : {1U, 2U, 5U}) {
      const auto source = open_mesh(folder / "m.obj", {.threads = threads});
      CHECK(names_of(source->info().labels) == NamesInFile{"default", "part0", "part1", "part2"});
      CHECK(read_mesh(*source).columns.labels == labels);
    }
  }
}

TEST_CASE("an OBJ is written with its materials and their library") {
  const TempFolder folder;
  Mesh mesh = tetrahedron();
  mesh.columns.labels = {1, 1, 3, 1};
  const LabelMeaning meaning{"material",
                             {{"unused"},
                              {"red wall", {1, linear(0.5), 0, 1}},
                              {"never"},
                              {"red#wall", {linear(0.8), 0, 0, 0.5F}}}};
  write_mesh(folder / "my m.obj", mesh, PositionType::float32, {}, {}, meaning);
  CHECK(read_file(folder / "my m.obj") ==
        "mtllib my m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red_wall\nf 1 3 2\nf 1 2 4\n"
        "usemtl red_wall_2\nf 1 4 3\nusemtl red_wall\nf 2 3 4\n");
  CHECK(read_file(folder / "my m.mtl") ==
        "newmtl red_wall\nKd 1 0.5 0\nd 1\nnewmtl red_wall_2\nKd 0.8 0 0\nd 0.5\n");
  const ReadFile read = read_path(folder / "my m.obj");
  CHECK(read.mesh.columns.labels == Labels{0, 0, 1, 0});
  CHECK(read.info.labels->materials ==
        std::vector<Material>{{"red_wall", {1, linear(0.5), 0, 1}},
                              {"red_wall_2", {linear(0.8), 0, 0, 0.5F}}});
}

TEST_CASE("groups are written as groups, and labels that are numbers as materials") {
  const TempFolder folder;
  Mesh mesh = tetrahedron();
  mesh.columns.labels = {1, 1, 0, 1};
  write_mesh(folder / "m.obj", mesh, PositionType::float32, {}, {},
             LabelMeaning{"group", {{"a"}, {"b"}}});
  CHECK(read_file(folder / "m.obj") ==
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng b\nf 1 3 2\nf 1 2 4\ng a\nf 1 4 3\ng b\nf 2 3 4\n");
  CHECK_FALSE(std::filesystem::exists(folder / "m.mtl"));
  mesh.columns.labels = {7, 7, UINT32_MAX, 7};
  write_mesh(folder / "n.obj", mesh, PositionType::float32, {}, {}, LabelMeaning{"region", {}});
  const ReadFile read = read_path(folder / "n.obj");
  CHECK(names_of(read.info.labels) == NamesInFile{"region_7", "region_4294967295"});
  CHECK(read.mesh.columns.labels == Labels{0, 0, 1, 0});
}

TEST_CASE("nothing of an OBJ is left behind if it is not whole") {
  const TempFolder folder;
  write_file(folder / "m.mtl", "old");
  {
    const auto sink = create_mesh(folder / "m.obj", {.vertices = 3,
                                                     .triangles = 1,
                                                     .comment = {},
                                                     .labels = LabelMeaning{"material", {{"a"}}}});
    sink->vertices(std::vector<Vec3>(3));
    CHECK_THROWS_AS(sink->commit(), DataError);
    CHECK_THROWS_AS(
        sink->triangles(std::vector<Triangle>{{0, 1, 2}}, TriangleColumns{.labels = {1}}),
        DataError);
    CHECK_THROWS_AS(sink->triangles(std::vector<Triangle>{{0, 1, 2}}), UsageError);
  }
  CHECK(read_file(folder / "m.mtl") == "old");
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("of very many numbers the last share a material") {
  LabelMaterials materials({"region", {}});
  for (Label label = 0; label < 70'000; ++label) materials.place_of(2 * label);
  CHECK(materials.all().size() == LabelMaterials::k_most_numbers + 1);
  CHECK(materials.all()[2].name == "region 4");
  CHECK(materials.all().back().name == "region others");
  CHECK(materials.place_of(4) == 2);
  CHECK(materials.place_of(131'080) == LabelMaterials::k_most_numbers);
  CHECK(stderr_of([&] {
          materials.warn_of_shared("m.obj");
        }).find("more than 65535 values of region") != std::string::npos);
}
