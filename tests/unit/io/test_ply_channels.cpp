// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/io/mesh_format.hpp>

#include "ply_test_files.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

struct ReadChannels {
  MeshFileInfo info;
  ChannelPoints all;
};

ReadChannels read_channels(std::string_view bytes, const OpenOptions& options = {}) {
  const TempFolder folder;
  write_file(folder / "m.ply", bytes);
  const auto source = open_mesh(folder / "m.ply", options);
  ReadChannels read{source->info(), {}};
  source->scan_channels([&](const ChannelPoints& batch) {
    read.all.points.insert(read.all.points.end(), batch.points.begin(), batch.points.end());
    read.all.values.insert(read.all.values.end(), batch.values.begin(), batch.values.end());
  });
  return read;
}

std::vector<std::string> names(const std::vector<Channel>& channels) {
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  return names;
}

constexpr std::string_view k_vertex =
    "element vertex 2\nproperty uchar red\nproperty float x\nproperty list uchar int ring\n"
    "property float y\nproperty double quality\nproperty float z\nproperty ushort blue\n"
    "property int label\nproperty float s\nproperty float nx\n";

}  // namespace

TEST_CASE("colours and other floats are channels; labels, texture and half a normal are not") {
  for (const BinaryFile::Order order : {BinaryFile::Order::little, BinaryFile::Order::big}) {
    BinaryFile file(order, k_vertex);
    file.bytes({200}).floats({1}).bytes({2}).ints({7, 8}).floats({2}).put<double>({0.25});
    file.floats({3}).put<std::uint16_t>({60'000}).ints({5}).floats({0.5, 1});
    file.bytes({100}).floats({4}).bytes({0}).floats({5}).put<double>({-1});
    file.floats({6}).put<std::uint16_t>({1}).ints({5}).floats({0.5, 1});
    const ReadChannels read = read_channels(file.text());
    CHECK(names(read.info.channels) == std::vector<std::string>{"red", "quality", "blue"});
    CHECK(read.info.channels[0].type == ChannelType::uint8);
    CHECK(read.info.channels[1].type == ChannelType::float32);
    CHECK(read.info.channels[1].role == ChannelRole::quality);
    CHECK(read.info.channels[2].type == ChannelType::uint16);
    CHECK(read.info.skipped ==
          std::vector<std::string>{"vertex.ring", "vertex.label", "vertex.s", "vertex.nx"});
    CHECK(read.all.points == std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}});
    CHECK(read.all.values == std::vector<float>{200, 0.25F, 60'000, 100, -1, 1});
    const MeshFileInfo without = read_channels(file.text(), {.channels = false}).info;
    CHECK(without.channels.empty());
    CHECK(without.skipped.size() == 7);
  }
}

TEST_CASE("ascii channels are read in the same way, and a wrong one is told with its line") {
  const std::string head = "ply\nformat ascii 1.0\n" + std::string(k_vertex) + "end_header\n";
  const ReadChannels read =
      read_channels(head + "200 1 2 7 8 2 .25 3 60000 5 .5 1\n100 4 0 5 -1 6 1 five half 1\n");
  CHECK(read.all.points == std::vector<Vec3>{{1, 2, 3}, {4, 5, 6}});
  CHECK(read.all.values == std::vector<float>{200, 0.25F, 60'000, 100, -1, 1});
  CHECK_THROWS_WITH_AS(
      read_channels(head + "200 1 2 7 8 2 .25 3 60000 5 .5 1\nreddish 4 0 5 -1 6 1 5 .5 1\n"),
      doctest::Contains("line 16"), DataError);
}

TEST_CASE("a PLY file has the values that it was given, in their types") {
  const TempFolder folder;
  const Mesh mesh = octahedron();
  const std::vector<Channel> channels = {{"red", ChannelType::uint8, ChannelRole::colour},
                                         {"depth", ChannelType::uint16, ChannelRole::quality},
                                         {"heat", ChannelType::float32, ChannelRole::quality}};
  std::vector<float> values;
  for (int i = 0; i < 6; ++i) {
    const auto value = static_cast<float>(i);
    values.insert(values.end(), {value, 1000 * value, value / 8});
  }
  write_mesh(folder / "m.ply", mesh, PositionType::float32, channels, values);
  CHECK(kept_channels(folder / "m.ply", channels) == channels);
  const std::string bytes = read_file(folder / "m.ply");
  CHECK(bytes.find("float z\nproperty uchar red\nproperty ushort depth\nproperty float heat\n") !=
        std::string::npos);
  // `depth` is an integer, so it may be a label.
  const ReadChannels read = read_channels(bytes);
  CHECK(names(read.info.channels) == std::vector<std::string>{"red", "heat"});
  CHECK(read.all.points == mesh.positions);
  CHECK(read.all.values[2 * 5] == 5);
  CHECK(read.all.values[2 * 5 + 1] == 0.625F);
  CHECK(read_bytes(bytes).mesh.triangles == mesh.triangles);
  values.pop_back();
  CHECK_THROWS_AS(write_mesh(folder / "m.ply", mesh, PositionType::float32, channels, values),
                  UsageError);
  CHECK_THROWS_AS(write_mesh(folder / "m.ply", mesh, PositionType::float32, channels), UsageError);
}
