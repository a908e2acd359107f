// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Vertex colours, in the formats that support them.
#include <doctest/doctest.h>

#include <meshfarm/io/convert_mesh.hpp>
#include <meshfarm/io/mesh_format.hpp>

#include "ply_test_files.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

const std::vector<Channel> k_colour = {{"red", ChannelType::uint8, ChannelRole::colour},
                                       {"green", ChannelType::uint8, ChannelRole::colour},
                                       {"blue", ChannelType::uint8, ChannelRole::colour}};

struct Coloured {
  MeshFileInfo info;
  ChannelPoints all;
};

Coloured read(const std::filesystem::path& path) {
  const auto source = open_mesh(path);
  Coloured read;
  source->scan_vertices([](std::span<const Vec3>) {});
  read.info = source->info();
  source->scan_channels([&](const ChannelPoints& batch) {
    read.all.points.insert(read.all.points.end(), batch.points.begin(), batch.points.end());
    read.all.values.insert(read.all.values.end(), batch.values.begin(), batch.values.end());
  });
  return read;
}

Coloured read_text_file(std::string_view text) {
  const TempFolder folder;
  write_file(folder / "m", text);
  return read(folder / "m");
}

}  // namespace

TEST_CASE("colours come back from PLY, OBJ and OFF, and from one by way of another") {
  const TempFolder folder;
  const Mesh mesh = icosphere(4);  // 2,562 vertices
  std::vector<float> values;
  for (std::size_t i = 0; i < 3 * mesh.positions.size(); ++i) {
    values.push_back(static_cast<float>(i * 7 % 256));
  }
  const auto check = [&](const std::filesystem::path& path) {
    CAPTURE(path.string());
    const Coloured back = read(path);
    CHECK(back.info.channels == k_colour);
    CHECK(back.all.points.size() == mesh.positions.size());
    REQUIRE(back.all.values.size() == values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      REQUIRE(rounded_to(ChannelType::uint8, back.all.values[i]) == values[i]);
    }
  };
  for (const char* name : {"m.ply", "m.obj", "m.off"}) {
    CHECK(kept_channels(folder / name, k_colour) == k_colour);
    write_mesh(folder / name, mesh, PositionType::float64, k_colour, values);
    check(folder / name);
    for (const char* other : {"n.ply", "n.obj", "n.off"}) {
      const Converted made = convert_mesh(*open_mesh(folder / name), folder / other, [](double) {});
      CHECK(made.channels == k_colour);
      check(folder / other);
    }
  }
  CHECK(kept_channels(folder / "m.stl", k_colour).empty());
  CHECK(
      convert_mesh(*open_mesh(folder / "m.ply"), folder / "m.stl", [](double) {}).channels.empty());
}

TEST_CASE("of other channels OBJ and OFF keep the colour only") {
  const TempFolder folder;
  std::vector<Channel> channels = {{"heat", ChannelType::float32, ChannelRole::quality}};
  channels.insert(channels.end(), k_colour.begin(), k_colour.end());
  CHECK(kept_channels(folder / "m.obj", channels) == k_colour);
  CHECK(kept_channels(folder / "m.ply", channels) == channels);
  const std::vector<float> values = {9, 255, 0, 51, 9, 0, 255, 0, 9, 0, 0, 255, 9, 1, 2, 3};
  write_mesh(folder / "m.obj", tetrahedron(), PositionType::float32, channels, values);
  CHECK(read_file(folder / "m.obj").starts_with("v 0 0 0 1 0 0.2\nv 1 0 0 0 1 0\n"));
  write_mesh(folder / "m.off", tetrahedron(), PositionType::float32, channels, values);
  CHECK(read_file(folder / "m.off")
            .starts_with("COFF\n4 4 0\n0 0 0 255 0 51 255\n1 0 0 0 255 0 255\n"));
  // Two components do not make a colour.
  channels.pop_back();
  CHECK(kept_channels(folder / "m.obj", channels).empty());
}

TEST_CASE("colours as floats stay floats in OFF, and OBJ vertices without one are white") {
  const Coloured off = read_text_file("COFF\n2 0 0\n0 0 0 1 0 0\n1 0 0 0.5 0.25 1 1\n");
  CHECK(off.info.channels[0].type == ChannelType::float32);
  CHECK(off.all.values == std::vector<float>{1, 0, 0, 0.5F, 0.25F, 1});
  const Coloured obj = read_text_file("v 0 0 0 1 0 0.2\nv 1 0 0\nv 2 0 0 1 0 1 0\nv 3 0 0 1\n");
  CHECK(obj.info.channels == k_colour);
  CHECK(obj.all.points == std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}});
  std::vector<float> rounded;
  for (const float value : obj.all.values) {
    rounded.push_back(rounded_to(ChannelType::uint8, value));
  }
  CHECK(rounded == std::vector<float>{255, 0, 51, 255, 255, 255, 255, 0, 255, 255, 255, 255});
  CHECK(read_text_file("v 0 0 0\nv 1 0 0 1\n").info.channels.empty());
}

TEST_CASE("an appearance is the colour, over the whole range of its type") {
  const std::vector<Channel> channels = {{"heat", ChannelType::float32, ChannelRole::quality},
                                         {"red", ChannelType::uint8, ChannelRole::colour},
                                         {"green", ChannelType::uint16, ChannelRole::colour},
                                         {"blue", ChannelType::float32, ChannelRole::colour}};
  const AppearanceColumns columns(channels);
  CHECK_FALSE(columns.empty());
  CHECK(columns.of(std::vector<float>{7, 255, 1234, 0.5F}) == Appearance{65535, 1234, 32768, 0});
  CHECK(columns.of(std::vector<float>{7, 0, 65535, 2}) == Appearance{0, 65535, 65535, 0});
  CHECK(columns.of(std::vector<float>{7, 1, 0, -1}) == Appearance{257, 0, 0, 0});
  CHECK(AppearanceColumns(std::span(channels).first(1)).empty());
}
