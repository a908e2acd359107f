// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/io/channel_pairs.hpp>
#include <meshfarm/io/mesh_format.hpp>

#include "support/meshes.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

const Channel k_red{"red", ChannelType::uint8, ChannelRole::colour};
const Channel k_green{"green", ChannelType::uint8, ChannelRole::colour};
const Channel k_blue{"blue", ChannelType::uint8, ChannelRole::colour};
const Channel k_alpha{"alpha", ChannelType::uint8, ChannelRole::colour};
const Channel k_nx{"nx", ChannelType::float32, ChannelRole::normal};
const Channel k_ny{"ny", ChannelType::float32, ChannelRole::normal};
const Channel k_nz{"nz", ChannelType::float32, ChannelRole::normal};
const Channel k_heat{"heat", ChannelType::float32, ChannelRole::quality};
const Channel k_cold{"cold", ChannelType::float32, ChannelRole::quality};

using PairColumns = std::vector<std::size_t>;
using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("channels are paired by name, and what belongs together stays together") {
  const std::vector<Channel> a = {k_heat, k_red, k_green, k_blue, k_alpha, k_nx, k_ny, k_nz};
  const std::vector<Channel> b = {k_nz, k_ny, k_nx, k_alpha, k_blue, k_green, k_red, k_cold};
  const ChannelPairs pairs = pair_channels(a, b);
  REQUIRE(pairs.pairs.size() == 3);
  CHECK(pairs.pairs[0].name == "colours");
  CHECK(pairs.pairs[0].columns == 3);
  CHECK(pairs.pairs[1].name == "normals");
  CHECK(pairs.pairs[1].role == ChannelRole::normal);
  CHECK(pairs.pairs[2].name == "alpha");
  CHECK(pairs.pairs[2].role == ChannelRole::colour);
  CHECK(pairs.columns_a == PairColumns{1, 2, 3, 5, 6, 7, 4});
  CHECK(pairs.columns_b == PairColumns{6, 5, 4, 2, 1, 0, 3});
  CHECK(pairs.only_a == Names{"heat"});
  CHECK(pairs.only_b == Names{"cold"});
}

TEST_CASE("components of half a colour or normal are channels by themselves") {
  const std::vector<Channel> a = {k_red, k_green, k_blue, k_nx};
  const std::vector<Channel> b = {k_red, k_blue, k_nx};
  const ChannelPairs pairs = pair_channels(a, b);
  REQUIRE(pairs.pairs.size() == 3);
  CHECK(pairs.pairs[1].name == "blue");
  CHECK(pairs.pairs[1].columns == 1);
  CHECK(pairs.pairs[2].role == ChannelRole::quality);
  CHECK(pairs.only_a == Names{"green"});
  CHECK(pair_channels(a, {}).pairs.empty());
  CHECK(pair_channels({}, {}).columns_a.empty());
}

TEST_CASE("columns come in their order, colours as shares of their range") {
  const test::TempFolder folder;
  const Mesh mesh = test::tetrahedron();
  const std::vector<float> values = {0, 1.5F, 51, 2.5F, 102, 3.5F, 255, 4.5F};
  write_mesh(folder.path() / "m.ply", mesh, PositionType::float32, {k_red, k_heat}, values);
  const auto source = open_mesh(folder.path() / "m.ply");
  CHECK(read_columns(*source, PairColumns{1, 0}) ==
        std::vector<float>{1.5F, 0, 2.5F, 51 / 255.0F, 3.5F, 102 / 255.0F, 4.5F, 1});
  CHECK(read_columns(*source, PairColumns{1}, 4) == std::vector<float>{1.5F, 2.5F, 3.5F, 4.5F});
}
