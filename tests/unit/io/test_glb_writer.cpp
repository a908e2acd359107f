// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>

#include <doctest/doctest.h>
#include <support/meshes.hpp>

#include <meshfarm/io/convert_mesh.hpp>
#include <meshfarm/io/mesh_format.hpp>

#include "gltf_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

std::uint32_t word_at(const std::string& bytes, std::size_t at) {
  std::uint32_t word = 0;
  REQUIRE(at + 4 <= bytes.size());
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

struct Glb {
  std::string json;  // without the blanks at the end
  std::string binary;
};

/// The chunks; checks their lengths.
Glb chunks_of(const std::string& bytes) {
  REQUIRE(bytes.starts_with("glTF"));
  CHECK(word_at(bytes, 4) == 2);
  CHECK(word_at(bytes, 8) == bytes.size());
  const std::uint32_t json = word_at(bytes, 12);
  CHECK(json % 4 == 0);
  Glb made{bytes.substr(20, json), ""};
  made.json.resize(made.json.find_last_not_of(' ') + 1);
  if (bytes.size() == 20 + json) return made;
  made.binary = bytes.substr(28 + json);
  CHECK(word_at(bytes, 20 + json) == made.binary.size());
  CHECK(made.binary.size() % 4 == 0);
  return made;
}

Glb written_glb(const Mesh& mesh, PositionType positions, const std::vector<Channel>& channels = {},
                std::span<const float> values = {}) {
  const TempFolder folder;
  write_mesh(folder / "m.glb", mesh, positions, channels, values);
  return chunks_of(read_file(folder / "m.glb"));
}

void convert_to_glb(const std::filesystem::path& from, const std::filesystem::path& to) {
  convert_mesh(*open_mesh(from), to, [](double) {});
}

Channel colour(const char* name, ChannelType type = ChannelType::uint8) {
  return {name, type, ChannelRole::colour};
}

Channel normal(const char* name) {
  return {name, ChannelType::float32, ChannelRole::normal};
}

}  // namespace

TEST_CASE("a GLB of floats holds their bits, with the bounds and no translation") {
  const Glb glb = written_glb({k_square_vertices, k_square_triangles}, PositionType::float32);
  CHECK(glb.binary == k_square_binary);
  CHECK(glb.json ==
        R"({"asset":{"version":"2.0","generator":"meshfarm"},"scene":0,"scenes":[{"nodes":[0]}],)"
        R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},)"
        R"("indices":1,"material":0}]}],"materials":[{"pbrMetallicRoughness":)"
        R"({"metallicFactor":0}}],"accessors":[{"bufferView":0,"byteOffset":0,)"
        R"("componentType":5126,"count":4,"type":"VEC3","min":[0.0,0.0,0.0],"max":[1.0,1.0,0.5]},)"
        R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}],)"
        R"("bufferViews":[{"buffer":0,"byteLength":48,"byteStride":12,"target":34962},)"
        R"({"buffer":0,"byteOffset":48,"byteLength":12,"target":34963}],)"
        R"("buffers":[{"byteLength":60}]})");
}

TEST_CASE("a mesh comes back from GLB as it was, to the bit of its floats") {
  const TempFolder folder;
  for (const int sides : {30, 300}) {  // indices of 16 and of 32 bits
    Mesh mesh = torus(sides, 250);
    for (Vec3& p : mesh.positions) p = rounded(p, PositionType::float32);
    write_mesh(folder / "a.ply", mesh, PositionType::float32);
    convert_to_glb(folder / "a.ply", folder / "b.glb");
    convert_to_glb(folder / "b.glb", folder / "c.ply");
    CHECK(read_file(folder / "c.ply") == read_file(folder / "a.ply"));
    CHECK(read_path(folder / "b.glb").info.skipped.empty());
    convert_to_glb(folder / "b.glb", folder / "d.glb");
    CHECK(read_file(folder / "d.glb") == read_file(folder / "b.glb"));
  }
}

TEST_CASE("indices have 16 bits where none is the number that begins a strip") {
  Mesh mesh{std::vector<Vec3>(65'535), {{0, 1, 65'534}}};
  CHECK(written_glb(mesh, PositionType::float32).binary.size() == 65'535 * 12 + 8);
  mesh.positions.push_back({});
  CHECK(written_glb(mesh, PositionType::float32).binary.size() == 65'536 * 12 + 12);
}

TEST_CASE("doubles far from the origin keep the digits that floats have near it") {
  const TempFolder folder;
  Mesh mesh{k_square_vertices, k_square_triangles};
  for (Vec3& p : mesh.positions) p = Vec3{412'345.678, 5'812'345.25, 0} + p * 0.001;
  write_mesh(folder / "m.glb", mesh, PositionType::float64);
  const ReadFile read = read_path(folder / "m.glb");
  CHECK(read.info.positions == PositionType::float64);
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(length(read.mesh.positions[i] - mesh.positions[i]) < 1e-9);
  }
  CHECK(read.mesh.positions[0] == mesh.positions[0]);
  CHECK(chunks_of(read_file(folder / "m.glb"))
            .json.find(R"("translation":[412345.678,5812345.25,0.0])") != std::string::npos);
}

TEST_CASE("colours are written linear with 16 bits, and come back") {
  const TempFolder folder;
  const Mesh mesh = icosphere(3);
  std::vector<Channel> channels = {colour("red"), colour("green"), colour("blue")};
  const auto check = [&] {
    std::vector<float> values;
    for (std::size_t i = 0; i < channels.size() * mesh.positions.size(); ++i) {
      values.push_back(static_cast<float>(i * 7 % 256));
    }
    write_mesh(folder / "a.ply", mesh, PositionType::float32, channels, values);
    convert_to_glb(folder / "a.ply", folder / "b.glb");
    convert_to_glb(folder / "b.glb", folder / "c.ply");
    CHECK(read_file(folder / "c.ply") == read_file(folder / "a.ply"));
  };
  check();
  channels.push_back(colour("alpha"));
  check();
  channels.insert(channels.begin(), {normal("nx"), normal("ny"), normal("nz")});
  CHECK(kept_channels("m.glb", channels) == channels);
  const Glb glb = written_glb({{{0, 0, 0}}, {}}, PositionType::float32, channels,
                              std::vector<float>{0, 0, 2, 255, 0, 128, 51});
  CHECK(glb.binary ==
        raw<float>({0, 0, 0, 0, 0, 1}) + raw<std::uint16_t>({65535, 0, 14146, 13107}));
}

TEST_CASE("colours of 16 bits come back as they were, and those of floats nearly") {
  const TempFolder folder;
  const Mesh mesh = icosphere(5);  // 10,242 vertices
  for (const ChannelType type : {ChannelType::uint16, ChannelType::float32}) {
    const std::vector<Channel> channels = {colour("red", type), colour("green", type),
                                           colour("blue", type), colour("alpha", type)};
    std::vector<float> values;
    for (std::size_t i = 0; i < channels.size() * mesh.positions.size(); ++i) {
      const auto level = static_cast<float>(i * 8191 % 65536);
      values.push_back(type == ChannelType::uint16 ? level : level / 65535);
    }
    write_mesh(folder / "a.ply", mesh, PositionType::float32, channels, values);
    convert_to_glb(folder / "a.ply", folder / "b.glb");
    convert_to_glb(folder / "b.glb", folder / "c.ply");
    if (type == ChannelType::uint16) {
      CHECK((read_file(folder / "c.ply") == read_file(folder / "a.ply")));
    }
    CHECK(read_path(folder / "b.glb").info.channels == channels);
    std::size_t at = 0;
    open_mesh(folder / "c.ply")->scan_channels([&](const ChannelPoints& batch) {
      float worst = 0;
      for (const float value : batch.values) {
        worst = std::max(worst, std::abs(value - values.at(at++)));
      }
      CHECK(worst < 1e-6F);
    });
    CHECK(at == values.size());
  }
}

TEST_CASE("an alpha that is no number is none") {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  const std::vector<Channel> channels = {
      colour("red", ChannelType::float32), colour("green", ChannelType::float32),
      colour("blue", ChannelType::float32), colour("alpha", ChannelType::float32)};
  const std::vector<float> values = {1, 1, 1, NAN, 1, 1, 1, 0.5F, 1, 1, 1, 7};
  const Glb glb = written_glb(mesh, PositionType::float32, channels, values);
  const auto alpha_of = [&](std::size_t vertex) {  // 12 bytes of position, 16 of colour
    return std::bit_cast<float>(word_at(glb.binary, 28 * vertex + 24));
  };
  CHECK(alpha_of(0) == 0);
  CHECK(alpha_of(1) == 0.5F);
  CHECK(alpha_of(2) == 1);
}

TEST_CASE("of other channels a GLB keeps the colour and the normal") {
  const std::vector<Channel> channels = {{"heat"},     colour("alpha"),
                                         normal("nx"), colour("red", ChannelType::float32),
                                         normal("ny"), colour("green", ChannelType::uint16),
                                         normal("nz"), colour("blue"),
                                         {"alpha"}};
  CHECK(kept_channels("m.glb", channels) ==
        std::vector<Channel>(channels.begin() + 1, channels.end() - 1));
  CHECK(kept_channels("m.glb", std::span(channels).first(5)).empty());
  const Glb glb = written_glb({{{1, 2, 3}}, {}}, PositionType::float32, channels,
                              std::vector<float>{9, 255, 0.6F, 1.5F, 0, 65535, 0.8F, -4, 9});
  CHECK(glb.binary == raw<float>({1, 2, 3, 0.6F, 0, 0.8F, 1, 1, 0, 1}));
}

TEST_CASE("a normal without a length, and a vertex without a position, are something valid") {
  const std::vector<Channel> channels = {normal("nx"), normal("ny"), normal("nz")};
  const Glb glb =
      written_glb({{k_no_position, {1, 2, 3}, k_no_position}, {}}, PositionType::float32, channels,
                  std::vector<float>{0, 0, 0, NAN, 0, 0, 0, -1, 0});
  CHECK(glb.binary == raw<float>({1, 2, 3, 0, 0, 1, 1, 2, 3, 0, 0, 1, 1, 2, 3, 0, -1, 0}));
  CHECK(glb.json.find(R"("min":[1.0,2.0,3.0],"max":[1.0,2.0,3.0])") != std::string::npos);
  for (const PositionType type : {PositionType::float32, PositionType::float64}) {
    CHECK(written_glb({{k_no_position}, {}}, type).binary == raw<float>({0, 0, 0}));
  }
}

TEST_CASE("a mesh without triangles is points, and one without vertices nothing") {
  CHECK(written_glb({k_square_vertices, {}}, PositionType::float32)
            .json.find(R"("attributes":{"POSITION":0},"mode":0)") != std::string::npos);
  for (const PositionType type : {PositionType::float32, PositionType::float64}) {
    const Glb none = written_glb({}, type);
    CHECK(none.json == R"({"asset":{"version":"2.0","generator":"meshfarm"},"scene":0,)"
                       R"("scenes":[{}]})");
    CHECK(none.binary.empty());
  }
}

TEST_CASE("a glTF has the bytes of a GLB in a file beside it") {
  const TempFolder folder;
  const Mesh mesh = icosphere(3);
  const std::vector<Channel> channels = {colour("red"), colour("green"), colour("blue")};
  const std::vector<float> values(3 * mesh.positions.size(), 100);
  const std::string name = "a b\xc3\xa9%.x";
  for (const PositionType type : {PositionType::float32, PositionType::float64}) {
    write_mesh(folder / (name + ".gltf"), mesh, type, channels, values);
    const Glb glb = written_glb(mesh, type, channels, values);
    CHECK((read_file(folder / (name + ".bin")) == glb.binary));
    CHECK(read_file(folder / (name + ".gltf")) ==
          with(glb.json, "\"buffers\":[{", R"("buffers":[{"uri":"a%20b%C3%A9%25.x.bin",)"));
    const ReadFile read = read_path(folder / (name + ".gltf"));
    CHECK(read.info.format == "glTF");
    CHECK(read.info.positions == type);
    CHECK(read.info.channels == channels);
    CHECK((read.mesh.triangles == mesh.triangles));
  }
  const std::filesystem::directory_iterator files(folder.path());
  CHECK(std::distance(begin(files), end(files)) == 2);
}

TEST_CASE("a glTF without vertices has no bytes beside it") {
  const TempFolder folder;
  write_mesh(folder / "m.gltf", {}, PositionType::float32);
  CHECK_FALSE(std::filesystem::exists(folder / "m.bin"));
  CHECK(read_path(folder / "m.gltf").mesh.positions.empty());
}

TEST_CASE("a glTF that is not committed leaves what was there before") {
  const TempFolder folder;
  const Mesh mesh{k_square_vertices, k_square_triangles};
  write_mesh(folder / "m.gltf", mesh, PositionType::float32);
  {
    const auto sink = create_mesh(folder / "m.gltf", {.vertices = 4, .triangles = 2});
    sink->vertices(mesh.positions);
    CHECK_THROWS_AS(sink->commit(), DataError);  // no triangles
  }
  check_square(read_path(folder / "m.gltf"));
  std::filesystem::remove(folder / "m.bin");
  std::filesystem::create_directory(folder / "m.bin");
  CHECK_THROWS_WITH_AS(create_mesh(folder / "m.gltf", {}), doctest::Contains("m.bin"), IoError);
}

TEST_CASE("a glTF of more than 4 GiB may be written, one of 2^32 vertices not") {
  const TempFolder folder;
  const auto create = [&](std::uint64_t vertices, std::uint64_t triangles) {
    create_mesh(folder / "m.gltf", {.vertices = vertices, .triangles = triangles});
  };
  const std::string told = stderr_of([&] { create(UINT32_MAX, 8'000'000'000); });
  CHECK(told.find("m.gltf: a glTF of more than 2 GiB is written") != std::string::npos);
  CHECK_THROWS_WITH_AS(create(1ULL << 32, 1),
                       ((folder / "m.gltf").string() +
                        ": a glTF file with 4294967296 vertices and 1 triangles cannot be written: "
                        "its indices have 32 bits")
                           .c_str(),
                       UsageError);
  CHECK_THROWS_AS(create(1, 1ULL << 62), UsageError);
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("more than 4 GiB are refused before anything is written") {
  const TempFolder folder;
  const auto create = [&](std::uint64_t vertices, std::uint64_t triangles) {
    create_mesh(folder / "m.glb", {.vertices = vertices, .triangles = triangles});
  };
  CHECK_THROWS_WITH_AS(create(1, 715'827'850),
                       ((folder / "m.glb").string() +
                        ": a GLB file with 1 vertices and 715827850 triangles cannot be written: "
                        "it would be longer than 4 GiB; a .gltf may be")
                           .c_str(),
                       UsageError);
  CHECK_THROWS_AS(create(1ULL << 62, 1), UsageError);
  // The check before anything is written.
  CHECK_THROWS_AS(check_fits(folder / "m.glb", {.vertices = 1, .triangles = 715'827'850}),
                  UsageError);
  for (const char* name : {"m.glb", "m.GLB"}) {
    check_fits(folder / name, {.vertices = 1, .triangles = 357'913'900});
  }
  check_fits(folder / "m.gltf", {.vertices = 1, .triangles = 715'827'850});
  check_fits(folder / "m", {.vertices = 1, .triangles = 715'827'850});
  CHECK_THROWS_AS(create(1, 1ULL << 63), UsageError);
  const std::string told = stderr_of([&] { create(100'000'000, 200'000'000); });
  CHECK(told.find("m.glb: a glTF of more than 2 GiB is written") != std::string::npos);
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("a coordinate that no float holds is refused") {
  const TempFolder folder;
  CHECK_THROWS_WITH_AS(
      write_mesh(folder / "m.glb", {{{0, 0, 0}, {1e300, 0, 0}}, {}}, PositionType::float64),
      doctest::Contains("m.glb: glTF cannot hold a coordinate that is too large for a float"),
      DataError);
  CHECK(std::filesystem::is_empty(folder.path()));
}
