// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <map>

#include <doctest/doctest.h>
#include <support/meshes.hpp>

#include <meshfarm/io/channel_choice.hpp>
#include <meshfarm/io/convert_mesh.hpp>
#include <meshfarm/io/mesh_format.hpp>

#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

Converted convert_labels(const std::filesystem::path& from, const std::filesystem::path& to) {
  const auto source = open_mesh(from);
  return convert_mesh(*source, to, [](double) {});
}

/// The label of each triangle, independent of the triangles' order.
std::map<Triangle, Label> labelled(const Mesh& mesh) {
  REQUIRE(mesh.columns.labels.size() == mesh.triangles.size());
  std::map<Triangle, Label> made;
  for (std::size_t i = 0; i < mesh.columns.labels.size(); ++i)
    made[mesh.triangles[i]] = mesh.columns.labels[i];
  return made;
}

/// Bands around the torus, not in the order of their labels.
Mesh banded() {
  Mesh mesh = torus(40, 60);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    mesh.columns.labels.push_back(static_cast<Label>(i / 7 % 5));
  }
  return mesh;
}

const LabelMeaning k_five{"material",
                          {{"stone", {0.25F, 0.5F, 1, 1}},
                           {"glass", {1, 1, 1, 0.5F}},
                           {"steel"},
                           {"wood", {0.125F, 0, 0, 1}},
                           {"clay", {0.5F, 0.25F, 0.125F, 1}}}};

}  // namespace

TEST_CASE("labels are the same after a way through all formats that have them") {
  const TempFolder folder;
  const Mesh mesh = banded();
  write_mesh(folder / "a.obj", mesh, PositionType::float32, {}, {}, k_five);
  for (const auto& [from, to] : {std::pair("a.obj", "b.ply"), std::pair("b.ply", "c.glb"),
                                 std::pair("c.glb", "d.gltf"), std::pair("d.gltf", "e.obj")}) {
    const Converted made = convert_labels(folder / from, folder / to);
    CHECK(made.has_labels);
    CHECK(labelled(read_path(folder / to).mesh) == labelled(mesh));
  }
}

TEST_CASE("materials are the same after a way through the formats that name them") {
  const TempFolder folder;
  const Mesh mesh = banded();
  write_mesh(folder / "a.glb", mesh, PositionType::float32, {}, {}, k_five);
  convert_labels(folder / "a.glb", folder / "b.obj");
  convert_labels(folder / "b.obj", folder / "c.glb");
  const ReadFile read = read_path(folder / "c.glb");
  REQUIRE(read.info.labels);
  REQUIRE(read.info.labels->materials.size() == 5);
  for (std::size_t i = 0; i < 5; ++i) {
    CHECK(read.info.labels->materials[i].name == k_five.materials[i].name);
    for (std::size_t k = 0; k < 4; ++k) {
      CHECK(std::abs(read.info.labels->materials[i].colour[k] - k_five.materials[i].colour[k]) <
            1e-6F);
    }
  }
}

TEST_CASE("triangles that are left out take their labels with them") {
  const TempFolder folder;
  write_file(folder / "a.obj",
             "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nusemtl a\nf 1 2 3\nf 1 2 4\nusemtl b\nf 1 2 4\n"
             "f 1 2\nf 3 2 1\n");
  const Converted made = convert_labels(folder / "a.obj", folder / "a.ply");
  CHECK(made.dropped_not_finite == 2);
  CHECK(read_path(folder / "a.ply").mesh.columns.labels == std::vector<Label>{0, 1});
}

TEST_CASE("formats without a place for labels leave them out") {
  const TempFolder folder;
  write_mesh(folder / "a.glb", banded(), PositionType::float32, {}, {}, k_five);
  for (const char* name : {"b.stl", "b.off"}) {
    CHECK_FALSE(keeps_labels(folder / name));
    CHECK_FALSE(convert_labels(folder / "a.glb", folder / name).has_labels);
    CHECK_FALSE(read_path(folder / name).info.labels);
  }
  for (const char* name : {"m", "m.ply", "m.obj", "m.glb", "m.gltf"}) CHECK(keeps_labels(name));
  CHECK_THROWS_AS(keeps_labels("m.3mf"), DataError);
  CHECK(keeps_materials("m.obj"));
  CHECK_FALSE(keeps_materials("m.ply"));
}

TEST_CASE("labels are chosen among the channels by their name") {
  const TempFolder folder;
  const std::vector<Channel> channels{{"heat", ChannelType::float32, ChannelRole::quality}};
  Mesh mesh = tetrahedron();
  mesh.columns.labels = {3, 3, 4, 3};
  write_mesh(folder / "m.ply", mesh, PositionType::float32, channels, std::vector<float>(4),
             LabelMeaning{"region", {}});
  const auto chosen = [&](std::string_view words) {
    return with_channels(open_mesh(folder / "m.ply"), parse_choice(words, "--attributes"));
  };
  CHECK(read_mesh(*chosen("auto")).columns.labels == mesh.columns.labels);
  const auto only = chosen("region");
  CHECK(only->info().channels.empty());
  CHECK(read_mesh(*only).columns.labels == mesh.columns.labels);
  for (const char* words : {"none", "heat"}) {
    const auto without = chosen(words);
    CHECK_FALSE(without->info().labels);
    CHECK(without->info().skipped.front() == "region");
    CHECK(read_mesh(*without).columns.labels.empty());
  }
  CHECK_THROWS_WITH_AS(chosen("cold"),
                       "--attributes: there is no channel 'cold'; there are: region, heat",
                       UsageError);
}
