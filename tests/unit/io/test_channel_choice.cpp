// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <numeric>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/io/channel_choice.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/meshes.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

const std::vector<Channel> k_channels = {{"heat", ChannelType::float32, ChannelRole::quality},
                                         {"red", ChannelType::uint8, ChannelRole::colour},
                                         {"nx", ChannelType::float32, ChannelRole::normal},
                                         {"ny", ChannelType::float32, ChannelRole::normal},
                                         {"nz", ChannelType::float32, ChannelRole::normal},
                                         {"green", ChannelType::uint8, ChannelRole::colour}};

using Columns = std::vector<std::size_t>;

Columns chosen(const std::string& text) {
  return chosen_columns(parse_choice(text, "--attributes"), k_channels);
}

}  // namespace

TEST_CASE("channels are chosen by name, and come in their own order") {
  CHECK(chosen("auto") == Columns{0, 1, 2, 3, 4, 5});
  CHECK(chosen("none").empty());
  CHECK(chosen("green,heat") == Columns{0, 5});
  CHECK(chosen("red,red") == Columns{1});
  CHECK(chosen("normals") == Columns{2, 3, 4});
  CHECK(chosen("nz,ny,nx,colours") == Columns{1, 2, 3, 4, 5});
}

TEST_CASE("a name that is not there is answered by those that are") {
  CHECK_THROWS_WITH_AS(
      chosen("red,blue"),
      "--attributes: there is no channel 'blue'; there are: heat, red, nx, ny, nz, "
      "green",
      UsageError);
  CHECK_THROWS_WITH_AS(chosen_columns(parse_choice("normals", "--attributes"), {}),
                       "--attributes: there is no channel 'normals'; there are: none", UsageError);
  CHECK_THROWS_WITH_AS(chosen("nx,nz"),
                       "--attributes: nx, ny and nz go together, or 'normals' for the three",
                       UsageError);
  for (const std::string text : {"", "red,", ",red", "red,,green"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(parse_choice(text, "--attributes"), UsageError);
  }
}

TEST_CASE("a source with chosen channels has the same mesh, their values, and skips the others") {
  const test::TempFolder folder;
  const Mesh mesh = test::tetrahedron();
  std::vector<float> values(24);
  std::iota(values.begin(), values.end(), 0.0F);
  write_mesh(folder.path() / "m.ply", mesh, PositionType::float32, k_channels, values);
  const auto source =
      with_channels(open_mesh(folder.path() / "m.ply"), parse_choice("green,heat", ""));
  CHECK(source->info().channels == std::vector<Channel>{k_channels[0], k_channels[5]});
  CHECK(source->info().skipped == std::vector<std::string>{"red", "nx", "ny", "nz"});
  std::vector<float> read;
  source->scan_channels([&](const ChannelPoints& batch) {
    read.insert(read.end(), batch.values.begin(), batch.values.end());
  });
  CHECK(read == std::vector<float>{0, 5, 6, 11, 12, 17, 18, 23});
  const Mesh same = read_mesh(*source);
  CHECK(same.positions == mesh.positions);
  CHECK(same.triangles == mesh.triangles);
  CHECK_THROWS_AS(with_channels(open_mesh(folder.path() / "m.ply"), parse_choice("alpha", "")),
                  UsageError);
}
