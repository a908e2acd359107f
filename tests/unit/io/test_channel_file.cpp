// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include <meshfarm/io/channel_file.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/damage.hpp"
#include "support/memory_source.hpp"
#include "support/meshes.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

/// Each vertex has two channels: its number, and its height.
class ChannelSource final : public test::MemorySource {
 public:
  ChannelSource(const Mesh& mesh, PositionType positions) : MemorySource(mesh, positions) {
    points_.points = mesh.positions;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      points_.values.push_back(static_cast<float>(v));
      points_.values.push_back(static_cast<float>(mesh.positions[v].z));
    }
    info_.channels = {{"red", ChannelType::uint8, ChannelRole::colour},
                      {"height", ChannelType::float32, ChannelRole::quality}};
  }
  void scan_channels(const std::function<void(const ChannelPoints&)>& take) override {
    for (std::size_t i = 0; i < points_.points.size(); i += batch_) {
      const std::size_t end = std::min(points_.points.size(), i + batch_);
      const auto first = [](auto& all, std::size_t at) {
        return all.begin() + static_cast<std::ptrdiff_t>(at);
      };
      take({{first(points_.points, i), first(points_.points, end)},
            {first(points_.values, 2 * i), first(points_.values, 2 * end)}});
    }
  }
  ChannelPoints& points() { return points_; }
  void set_batch(std::size_t points) { batch_ = points; }

 private:
  std::size_t batch_ = SIZE_MAX / 2;
  ChannelPoints points_;
};

ChannelPoints read_all(const std::string& bytes, const StagedChannels& staged,
                       PositionType positions) {
  ChannelReader reader(fill_from(bytes, "channels"), staged, positions, "channels");
  ChannelPoints all;
  ChannelPoints block;
  while (reader.next(block)) {
    all.points.insert(all.points.end(), block.points.begin(), block.points.end());
    all.values.insert(all.values.end(), block.values.begin(), block.values.end());
  }
  return all;
}

struct StagedFile {
  StagedChannels staged;
  std::string bytes;
};

StagedFile staged_of(ChannelSource& source) {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  StagedFile made;
  made.staged = stage_channels(source, stage, [](std::uint64_t) {});
  made.bytes = stage.read(made.staged.file);
  return made;
}

}  // namespace

TEST_CASE("channels come back as they were staged, in blocks") {
  const Mesh mesh = test::icosphere(7);  // 163,842 vertices
  ChannelSource source(mesh, PositionType::float64);
  const auto [staged, bytes] = staged_of(source);
  CHECK(staged.points == mesh.positions.size());
  CHECK(staged.channels == source.info().channels);
  const ChannelPoints back = read_all(bytes, staged, PositionType::float64);
  CHECK(back.points == mesh.positions);
  REQUIRE(back.values.size() == 2 * mesh.positions.size());
  CHECK(back.values[2 * 200] == 200);
  CHECK(back.values[2 * 300] == 255);  // the type's maximum
  CHECK(back.values[2 * 300 + 1] == static_cast<float>(mesh.positions[300].z));
}

TEST_CASE("the file is the same whatever the batches that the points come in") {
  const Mesh mesh = test::icosphere(7);
  ChannelSource source(mesh, PositionType::float64);
  source.points().points[100'000].x = HUGE_VAL;
  const std::string whole = staged_of(source).bytes;
  for (const std::size_t batch : {1'000U, 65'536U, 100'001U}) {
    CAPTURE(batch);
    source.set_batch(batch);
    CHECK(staged_of(source).bytes == whole);
  }
}

TEST_CASE("without channels nothing is staged") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  test::MemorySource source(test::octahedron());
  const StagedChannels staged = stage_channels(source, stage, [](std::uint64_t) {});
  CHECK(staged.channels.empty());
  CHECK_FALSE(std::filesystem::exists(stage.path(ChannelsName{})));
}

TEST_CASE("vertices without a position are left out, values that are not finite are 0") {
  ChannelSource source(test::octahedron(), PositionType::float32);
  source.points().points[1] = k_no_position;
  source.points().values[2 * 2] = std::numeric_limits<float>::quiet_NaN();
  source.points().values[2 * 3 + 1] = std::numeric_limits<float>::infinity();
  const auto [staged, bytes] = staged_of(source);
  CHECK(staged.points == 5);
  const ChannelPoints back = read_all(bytes, staged, PositionType::float32);
  CHECK(back.values == std::vector<float>{0, 0, 0, 0, 3, 0, 4, 1, 5, -1});
}

TEST_CASE("a file of channels that is damaged, or another one, is refused") {
  ChannelSource source(test::octahedron(), PositionType::float32);
  const auto [staged, bytes] = staged_of(source);
  const auto read = [&staged = staged](std::string_view some) {
    return read_all(std::string(some), staged, PositionType::float32);
  };
  CHECK(read(bytes).points.size() == 6);
  test::check_refuses_damage(bytes, read);
  // Valid blocks that differ from what the manifest says.
  CHECK_THROWS_AS(read_all(bytes, staged, PositionType::float64), DataError);
  StagedChannels other = staged;
  other.points = 5;
  CHECK_THROWS_AS(read_all(bytes, other, PositionType::float32), DataError);
  other = staged;
  other.channels.pop_back();
  CHECK_THROWS_AS(read_all(bytes, other, PositionType::float32), DataError);
}

TEST_CASE("values are rounded to their types, and normals have length 1") {
  CHECK(rounded_to(ChannelType::uint8, -3) == 0);
  CHECK(rounded_to(ChannelType::uint8, 254.5F) == 255);
  CHECK(rounded_to(ChannelType::uint8, 300) == 255);
  CHECK(rounded_to(ChannelType::uint16, 70000) == 65535);
  CHECK(rounded_to(ChannelType::float32, 0.25F) == 0.25F);
  CHECK(rounded_to(ChannelType::uint16, std::numeric_limits<float>::quiet_NaN()) == 0);
  const Channel normal{"nx", ChannelType::float32, ChannelRole::normal};
  const std::vector<Channel> channels = {
      normal, {"red", ChannelType::uint8, ChannelRole::colour}, normal, normal};
  std::vector<float> values = {3, 9.7F, 0, 4, 0, 1, 0, 0};
  repair_values(channels, values);
  CHECK(values == std::vector<float>{0.6F, 10, 0, 0.8F, 0, 1, 0, 0});
}
