// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "gltf_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

/// The JSON of a square with other accessors and views, each given as text.
std::string square_with(std::string_view accessors, std::string_view views, std::size_t bytes) {
  const std::string head = k_square_json.substr(0, k_square_json.find("\"accessors\""));
  return head + "\"accessors\":[" + std::string(accessors) + "],\"bufferViews\":[" +
         std::string(views) + "],\"buffers\":[{\"byteLength\":" + std::to_string(bytes) + "}]}";
}

/// The values of all channels, in the order of the scan.
std::vector<float> values_of(const std::string& glb) {
  const TempFolder folder;
  write_file(folder / "m.glb", glb);
  const auto source = open_mesh(folder / "m.glb");
  std::vector<float> values;
  std::uint64_t points = 0;
  source->scan_channels([&](const ChannelPoints& batch) {
    values.insert(values.end(), batch.values.begin(), batch.values.end());
    points += batch.points.size();
  });
  CHECK(points == source->info().vertices);
  return values;
}

constexpr std::string_view k_primitive = R"({"attributes":{"POSITION":0},"indices":1})";

}  // namespace

TEST_CASE("a GLB is read, by content") {
  const ReadFile read = read_bytes(square_glb());  // as m.ply
  check_square(read);
  CHECK(read.info.format == "GLB");
  CHECK(read.info.compression == "none");
  CHECK(read.info.skipped.empty());
}

TEST_CASE("indices of 8 and 32 bits, and none") {
  const std::string positions = k_square_binary.substr(0, 48);
  std::string narrow = with(k_square_json, "5123", "5121");
  narrow = with(with(narrow, "\"byteLength\":12", "\"byteLength\":6"), "\"byteLength\":60",
                "\"byteLength\":54");
  check_square(read_glb(narrow, positions + raw<std::uint8_t>({0, 1, 2, 2, 1, 3})));
  std::string wide = with(k_square_json, "5123", "5125");
  wide = with(with(wide, "\"byteLength\":12", "\"byteLength\":24"), "\"byteLength\":60",
              "\"byteLength\":72");
  check_square(read_glb(wide, positions + raw<std::uint32_t>({0, 1, 2, 2, 1, 3})));
  const ReadFile soup =
      read_glb(with(with(k_square_json, ",\"indices\":1", ""), "\"count\":4", "\"count\":3"));
  CHECK(soup.mesh.triangles == std::vector<Triangle>{{0, 1, 2}});
}

TEST_CASE("interleaved attributes are read by their stride and offsets") {
  std::string bytes = "....";
  for (const Vec3& p : k_square_vertices) {
    bytes +=
        raw<float>({9, static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
  }
  bytes += raw<std::uint16_t>({7, 7, 0, 1, 2, 2, 1, 3});
  const std::string json = square_with(
      R"({"bufferView":0,"byteOffset":4,"componentType":5126,"count":4,"type":"VEC3"},)"
      R"({"bufferView":1,"byteOffset":4,"componentType":5123,"count":6,"type":"SCALAR"})",
      R"({"buffer":0,"byteOffset":4,"byteLength":64,"byteStride":16},)"
      R"({"buffer":0,"byteOffset":68,"byteLength":16})",
      84);
  check_square(read_glb(json, bytes));
}

TEST_CASE("quantised positions are whole numbers, or levels of them if they are normalized") {
  const auto json = [](int type, std::string_view more, std::size_t row) {
    return square_with("{\"bufferView\":0,\"componentType\":" + std::to_string(type) +
                           ",\"count\":3,\"type\":\"VEC3\"" + std::string(more) + "}",
                       "{\"buffer\":0,\"byteLength\":" + std::to_string(3 * row) +
                           ",\"byteStride\":" + std::to_string(row) + "}",
                       3 * row);
  };
  const auto points = [](std::string text, const std::string& bytes) {
    text = with(std::move(text), ",\"indices\":1", "");
    text = with(std::move(text), "{\"asset\"",
                R"({"extensionsRequired":["KHR_mesh_quantization"],"asset")");
    return read_glb(text, bytes);
  };
  const ReadFile whole = points(json(5122, "", 8), raw<std::int16_t>({-7, 0, 300, 0,  //
                                                                      0, 1, 0, 0,     //
                                                                      2, 0, 0, 0}));
  CHECK(whole.mesh.positions == std::vector<Vec3>{{-7, 0, 300}, {0, 1, 0}, {2, 0, 0}});
  CHECK(whole.info.positions == PositionType::float32);
  const ReadFile levels = points(json(5120, ",\"normalized\":true", 4),
                                 raw<std::int8_t>({-128, -127, 127, 0, 0, 1, 0, 0, 64, 0, 0, 0}));
  CHECK(levels.mesh.positions ==
        std::vector<Vec3>{{-1, -1, 1}, {0, 1 / 127.0, 0}, {64 / 127.0, 0, 0}});
  CHECK(levels.info.positions == PositionType::float64);
  const ReadFile large = points(json(5123, ",\"normalized\":true", 8),
                                raw<std::uint16_t>({65535, 0, 13107, 0, 0, 0, 0, 0, 1, 0, 0, 0}));
  CHECK(large.mesh.positions ==
        std::vector<Vec3>{{1, 0, 13107 / 65535.0}, {0, 0, 0}, {1 / 65535.0, 0, 0}});
}

TEST_CASE("strips and fans become triangles, the way round that they have") {
  const std::string strip = with(k_square_json, "\"indices\":1", "\"mode\":5");
  CHECK(read_glb(strip).mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}});
  const std::string fan = with(k_square_json, "\"indices\":1", "\"mode\":6");
  CHECK(read_glb(fan).mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}});
  // In 0 1 2 2 1 3, triangles with two equal corners only join strips, and are left out.
  const std::string joined = with(k_square_json, "\"indices\":1", "\"indices\":1,\"mode\":5");
  CHECK(read_glb(joined).mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {1, 2, 3}});
}

TEST_CASE("primitives of one mesh share the vertices that are the same") {
  const std::string twice = std::string(k_primitive) + "," + std::string(k_primitive);
  const ReadFile read = read_glb(with(k_square_json, k_primitive, twice));
  CHECK(read.mesh.positions == k_square_vertices);
  CHECK(read.info.faces == 4);
  CHECK(read.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {0, 1, 2}, {2, 1, 3}});
}

TEST_CASE("what is no triangle, or no channel, is left out and named") {
  const std::string more =
      std::string(k_primitive) +
      R"(,{"attributes":{"POSITION":0},"mode":1},{"attributes":{"POSITION":0},"mode":0},)"
      R"({"attributes":{}},{"attributes":{"POSITION":0,"TEXCOORD_0":7,"_x\ny":8},"indices":1,)"
      R"("targets":[{}]})";
  std::string json = with(k_square_json, k_primitive, more);
  json = with(json, "\"scene\":0", R"("scene":0,"materials":[{},{}],"images":[{}])");
  json = with(json, "\"meshes\":[", R"("meshes":[{"primitives":[]},)");
  json = with(json, "\"mesh\":0", "\"mesh\":1");
  const ReadFile read = read_glb(json);
  CHECK(read.mesh.positions == k_square_vertices);
  CHECK(read.mesh.triangles.size() == 4);
  CHECK(read.info.skipped == std::vector<std::string>{"TEXCOORD_0 (1)", "_x?y (1)", "images (1)",
                                                      "lines (1)", "materials (2)",
                                                      "meshes outside the scene (1)",
                                                      "morph targets (1)", "points (1)",
                                                      "primitives without positions (1)"});
}

TEST_CASE("a position that is not finite is none") {
  std::string bytes = k_square_binary;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + 4, &nan, sizeof nan);
  const ReadFile read = read_glb(k_square_json, bytes);
  CHECK_FALSE(has_position(read.mesh.positions[0]));
  CHECK(read.mesh.triangles == std::vector<Triangle>{{2, 1, 3}});
}

TEST_CASE("linear colours become those of sRGB, and what has none is white") {
  const std::string accessors =
      R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
      R"({"bufferView":1,"componentType":5123,"count":3,"type":"VEC4","normalized":true})";
  const std::string views =
      R"({"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24})";
  std::string json = with(square_with(accessors, views, 60), k_primitive,
                          R"({"attributes":{"POSITION":0,"COLOR_0":1}})");
  const std::string bytes = raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) +
                            raw<std::uint16_t>({65535, 0, 14146, 65535,  // 14146 is 128 in sRGB
                                                0, 65535, 0, 0,          //
                                                0, 0, 65535, 13107});
  const std::vector<float> values = values_of(glb_file(json, bytes));
  const std::vector<float> expected = {255, 0, 128, 255, 0, 255, 0, 0, 0, 0, 255, 51};
  REQUIRE(values.size() == expected.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    CHECK(std::abs(values[i] - expected[i]) < 0.01F);
  }
  json = with(json, "\"COLOR_0\":1}}", "\"COLOR_0\":1}},{\"attributes\":{\"POSITION\":0}}");
  const std::vector<float> both = values_of(glb_file(json, bytes));
  REQUIRE(both.size() == 24);
  for (std::size_t i = 12; i < 24; ++i) CHECK(both[i] == 255);
  const ReadFile read = read_glb(json, bytes);
  REQUIRE(read.info.channels.size() == 4);
  CHECK(read.info.channels[3] == Channel{"alpha", ChannelType::uint8, ChannelRole::colour});
}

TEST_CASE("colours are read as what they were made from, of several the finest") {
  const std::string positions = raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const std::string bytes = positions +
                            raw<std::uint8_t>({255, 0, 0, 9, 0, 255, 0, 9, 0, 0, 0, 9}) +
                            raw<std::uint16_t>({65535, 0, 0, 9, 0, 65535, 0, 9, 0, 0, 14146, 9}) +
                            raw<float>({1, 0, 0, 0, 2, 0, -1, 0, 0.25F});
  const std::string accessors =
      R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
      R"({"bufferView":1,"componentType":5121,"count":3,"type":"VEC3","normalized":true},)"
      R"({"bufferView":2,"componentType":5123,"count":3,"type":"VEC3","normalized":true},)"
      R"({"bufferView":3,"componentType":5126,"count":3,"type":"VEC3"},)"
      R"({"bufferView":2,"componentType":5123,"count":3,"type":"VEC3","normalized":true,)"
      R"("extras":{"srgbBits":16}},)"
      R"({"bufferView":3,"componentType":5126,"count":3,"type":"VEC3",)"
      R"("extras":{"srgbBits":32}})";
  const std::string views = R"({"buffer":0,"byteLength":36},)"
                            R"({"buffer":0,"byteOffset":36,"byteLength":12,"byteStride":4},)"
                            R"({"buffer":0,"byteOffset":48,"byteLength":24,"byteStride":8},)"
                            R"({"buffer":0,"byteOffset":72,"byteLength":36})";
  const std::string json = square_with(accessors, views, 108);
  const auto check = [&](std::initializer_list<int> colours, ChannelType type,
                         const std::vector<float>& expected) {
    std::string primitives;
    for (const int colour : colours) {
      if (!primitives.empty()) primitives += ",";
      primitives += R"({"attributes":{"POSITION":0,"COLOR_0":)" + std::to_string(colour) + "}}";
    }
    const std::string glb = glb_file(with(json, k_primitive, primitives), bytes);
    CAPTURE(primitives);
    for (const Channel& channel : read_bytes(glb).info.channels) CHECK(channel.type == type);
    std::vector<float> values = values_of(glb);
    values.resize(expected.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      CHECK(std::abs(values[i] - expected[i]) <= 1e-4F * expected[i]);
    }
  };
  const float dark = 65535.0F / 255 * 127.9981F;
  for (const int colour : {1, 2}) {
    const float last = colour == 1 ? 0.0F : 128.0F;
    check({colour}, ChannelType::uint8, {255, 0, 0, 0, 255, 0, 0, 0, last});
  }
  check({3}, ChannelType::uint8, {255, 0, 0, 0, 255, 0, 0, 0, 136.96F});
  check({4}, ChannelType::uint16, {65535, 0, 0, 0, 65535, 0, 0, 0, dark});
  check({5}, ChannelType::float32, {1, 0, 0, 0, 1, 0, 0, 0, 0.5371F});
  check({1, 2}, ChannelType::uint8, {255, 0, 0, 0, 255, 0, 0, 0, 0});
  check({2, 1, 4}, ChannelType::uint16, {65535, 0, 0, 0, 65535, 0, 0, 0, dark});
  check({1, 5, 4}, ChannelType::float32, {1, 0, 0, 0, 1, 0, 0, 0, 0});
}

TEST_CASE("normals are turned with their nodes, and dropped where not all vertices have them") {
  const std::string accessors =
      R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},)"
      R"({"bufferView":1,"componentType":5120,"count":3,"type":"VEC3","normalized":true})";
  const std::string views = R"({"buffer":0,"byteLength":36},)"
                            R"({"buffer":0,"byteOffset":36,"byteLength":12,"byteStride":4})";
  const std::string json = with(square_with(accessors, views, 48), k_primitive,
                                R"({"attributes":{"POSITION":0,"NORMAL":1}})");
  const std::string bytes = raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) +
                            raw<std::int8_t>({0, 0, 127, 0, 127, 0, 0, 0, 0, -127, 0, 0});
  CHECK(values_of(glb_file(json, bytes)) == std::vector<float>{0, 0, 1, 1, 0, 0, 0, -1, 0});
  // Under stretching a normal keeps its length; under mirroring it follows the surface.
  const std::string mirrored =
      with(json, "\"mesh\":0", R"("mesh":0,"scale":[-2,1,1],"translation":[5,0,0])");
  CHECK(values_of(glb_file(mirrored, bytes)) == std::vector<float>{0, 0, 1, -1, 0, 0, 0, -1, 0});
  const ReadFile half = read_glb(
      with(json, "\"NORMAL\":1}}", "\"NORMAL\":1}},{\"attributes\":{\"POSITION\":0}}"), bytes);
  CHECK(half.info.channels.empty());
  CHECK(half.info.skipped == std::vector<std::string>{"NORMAL (1)"});
}

TEST_CASE("without channels they count as skipped") {
  const TempFolder folder;
  write_file(folder / "m.glb",
             glb_file(with(k_square_json, "\"POSITION\":0", "\"POSITION\":0,\"NORMAL\":0"),
                      k_square_binary));
  const auto source = open_mesh(folder / "m.glb", {.channels = false});
  CHECK(source->info().channels.empty());
  CHECK(source->info().skipped == std::vector<std::string>{"NORMAL (1)"});
}
