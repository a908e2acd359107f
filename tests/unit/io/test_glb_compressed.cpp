// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>

#include <doctest/doctest.h>
#include <support/meshes.hpp>

#include <meshfarm/io/mesh_format.hpp>

#include "gltf_test_files.hpp"
#include "io/glb_compressed.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

/// A written file, and what is read back from it.
struct Written {
  std::string bytes;
  Mesh mesh;
  MeshFileInfo info;
  std::vector<float> values;

  bool has(const std::string& text) const { return bytes.find(text) != std::string::npos; }
};

Written written(const Mesh& mesh, PositionType positions, Packing packing = Packing::compressed,
                const std::vector<Channel>& channels = {}, std::span<const float> values = {}) {
  const TempFolder folder;
  write_mesh(MeshOutput{folder / "m.glb", packing}, mesh, positions, channels, values);
  const auto source = open_mesh(folder / "m.glb");
  Written made{read_file(folder / "m.glb"), read_mesh(*source), source->info(), {}};
  source->scan_channels([&](const ChannelPoints& batch) {
    made.values.insert(made.values.end(), batch.values.begin(), batch.values.end());
  });
  return made;
}

/// The codec may rotate a triangle's corners.
std::vector<Triangle> from_least(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles)
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return triangles;
}

/// The largest change of a coordinate.
double greatest_move(const Mesh& a, const Mesh& b) {
  REQUIRE(a.positions.size() == b.positions.size());
  double greatest = 0;
  for (std::size_t i = 0; i < a.positions.size(); ++i) {
    const Vec3 d = a.positions[i] - b.positions[i];
    greatest = std::max({greatest, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  }
  return greatest;
}

/// A sphere of radius 0.1.
Mesh sphere(Vec3 centre, PositionType type) {
  Mesh mesh = icosphere(4);
  for (Vec3& p : mesh.positions) p = rounded(p * 0.1 + centre, type);
  return mesh;
}

constexpr const char* k_quantised = R"("KHR_mesh_quantization")";

}  // namespace

TEST_CASE("whole numbers come back from a compressed GLB as they were") {
  const Mesh mesh = grid(40, 30);
  const Written made = written(mesh, PositionType::float32);
  CHECK(made.mesh.positions == mesh.positions);
  CHECK(from_least(made.mesh.triangles) == from_least(mesh.triangles));
  CHECK(made.has(R"("scale":[0.0009765625,0.0009765625,0.0009765625])"));
  CHECK(made.has(R"("extensionsRequired":["EXT_meshopt_compression","KHR_mesh_quantization"])"));
  CHECK(made.info.skipped.empty());
  const std::size_t plain = written(mesh, PositionType::float32, Packing::plain).bytes.size();
  CHECK(made.bytes.size() < plain / 2);
  CHECK(made.bytes == written(mesh, PositionType::float32).bytes);
}

TEST_CASE("positions of a compressed GLB are half a step away at most") {
  const double step = std::ldexp(1.0, -18);  // for an extent of 0.2
  for (const PositionType type : {PositionType::float32, PositionType::float64}) {
    for (const Vec3 centre : {Vec3{}, Vec3{-3, 7, 0.01}, Vec3{1000.3, -2000, 77}}) {
      const Mesh mesh = sphere(centre, type);
      const Written made = written(mesh, type);
      CHECK(made.has(k_quantised));
      const double move = greatest_move(made.mesh, mesh);
      CHECK(move <= step / 2 * 1.0001);
      CHECK(from_least(made.mesh.triangles) == from_least(mesh.triangles));
      // Positions on the lattice stay there.
      CHECK(greatest_move(written(made.mesh, PositionType::float64).mesh, made.mesh) == 0);
    }
  }
}

TEST_CASE("doubles far from the origin keep their digits in a compressed GLB") {
  const Mesh mesh = sphere({412'345.678, 5'812'345.25, 0}, PositionType::float64);
  const Written made = written(mesh, PositionType::float64);
  CHECK(made.has(k_quantised));
  CHECK(greatest_move(made.mesh, mesh) <= std::ldexp(1.0, -19) * 1.01);
}

TEST_CASE("where the lattice is coarse beside the triangles positions are floats on a finer one") {
  const auto with_wide = [](double width) {
    Mesh mesh = sphere({}, PositionType::float32);
    append(mesh, Mesh{{{0, 0, 0}, {width, 0, 0}, {0, width, 0}}, {{0, 1, 2}}});
    return mesh;
  };
  for (const double width : {40.0, 160.0, 640.0}) {
    CAPTURE(width);
    const Mesh mesh = with_wide(width);
    const Written made = written(mesh, PositionType::float32);
    CHECK_FALSE(made.has(k_quantised));
    CHECK(made.has(R"("extensionsRequired":["EXT_meshopt_compression"])"));
    CHECK(made.has(R"("filter":"EXPONENTIAL")"));
    CHECK(greatest_move(made.mesh, mesh) > 0);
    CHECK(greatest_move(made.mesh, mesh) < 0.006 / 10);  // the smallest height is 0.006
    CHECK(from_least(made.mesh.triangles) == from_least(mesh.triangles));
    CHECK(greatest_move(written(made.mesh, PositionType::float64).mesh, made.mesh) == 0);
  }
  const Mesh mesh = with_wide(4000);
  const Written made = written(mesh, PositionType::float32);
  CHECK_FALSE(made.has(k_quantised));
  CHECK_FALSE(made.has("EXPONENTIAL"));
  CHECK(made.mesh.positions == mesh.positions);
  CHECK(from_least(made.mesh.triangles) == from_least(mesh.triangles));
}

TEST_CASE("no triangle loses its area or turns over on the lattice of a compressed GLB") {
  const double step = std::ldexp(1.0, -10);  // for an extent of 40
  const auto with_last = [](const Triangle& triangle, double width, double height) {
    Mesh mesh = grid(40, 30);
    append(mesh, Mesh{{{0, 0, 0}, {width, 0, 0}, {0, height, 0}}, {triangle}});
    return mesh;
  };
  // A few triangles may be low.
  CHECK(written(with_last({0, 1, 2}, 1, 2 * step), PositionType::float32).has(k_quantised));
  const Mesh low = with_last({0, 1, 2}, 1, step / 3);
  const Written made = written(low, PositionType::float32);
  CHECK(made.has(R"("filter":"EXPONENTIAL")"));
  CHECK(made.mesh.positions.back().y > 0);
  // A triangle without area has none to lose.
  CHECK(written(with_last({0, 1, 1}, 1, step / 3), PositionType::float32).has(k_quantised));
}

TEST_CASE("a mesh at one point, and one of any size, can be compressed") {
  const Mesh point{{{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}, {{0, 1, 2}}};
  CHECK(written(point, PositionType::float32).mesh.positions == point.positions);
  for (const double size : {1e-37, 1e37}) {
    Mesh mesh = icosphere(2);
    for (Vec3& p : mesh.positions) p = rounded(p * size, PositionType::float32);
    const Written made = written(mesh, PositionType::float32);
    CHECK_FALSE(made.has(k_quantised));
    CHECK(made.mesh.positions == mesh.positions);
  }
}

TEST_CASE("colours and their alpha come back from a compressed GLB as they were") {
  const Mesh mesh = icosphere(3);
  for (const ChannelType type : {ChannelType::uint8, ChannelType::uint16}) {
    std::vector<Channel> channels;
    for (const char* name : {"red", "green", "blue", "alpha"}) {
      channels.push_back({name, type, ChannelRole::colour});
    }
    std::vector<float> values;
    for (std::size_t i = 0; i < channels.size() * mesh.positions.size(); ++i) {
      values.push_back(static_cast<float>(i * 7 % 256));
    }
    const Written made =
        written(mesh, PositionType::float32, Packing::compressed, channels, values);
    CHECK(made.info.channels == channels);
    std::vector<float> levels;
    for (const float value : made.values) levels.push_back(std::round(value));
    CHECK(levels == values);
    CHECK(made.values ==
          written(mesh, PositionType::float32, Packing::plain, channels, values).values);
  }
}

TEST_CASE("normals of a compressed GLB are a degree away at most") {
  const Mesh mesh = icosphere(4);
  const std::vector<Channel> channels = {{"nx", ChannelType::float32, ChannelRole::normal},
                                         {"ny", ChannelType::float32, ChannelRole::normal},
                                         {"nz", ChannelType::float32, ChannelRole::normal}};
  std::vector<float> values;
  for (const Vec3& p : mesh.positions) {
    for (const double x : {p.x, p.y, p.z}) values.push_back(static_cast<float>(x));
  }
  const Written made = written(mesh, PositionType::float32, Packing::compressed, channels, values);
  REQUIRE(made.values.size() == values.size());
  double worst = 0;
  for (std::size_t i = 0; i < values.size(); i += 3) {
    const Vec3 a{values[i], values[i + 1], values[i + 2]};
    const Vec3 b{made.values[i], made.values[i + 1], made.values[i + 2]};
    worst = std::max(worst, std::atan2(length(cross(a, b)), dot(a, b)) * 57.3);
  }
  CHECK(worst < 1.2);
}

TEST_CASE("indices of 16 and of 32 bits are compressed, and a vertex need not have a position") {
  for (const std::uint32_t sides : {30, 300}) {
    Mesh mesh = torus(sides, 250);
    for (Vec3& p : mesh.positions) p = rounded(p, PositionType::float32);
    const Written made = written(mesh, PositionType::float32);
    CHECK(from_least(made.mesh.triangles) == from_least(mesh.triangles));
    CHECK(greatest_move(made.mesh, mesh) < 1e-4);
    CHECK(made.has(sides == 30 ? R"("byteStride":2)" : R"("byteStride":4,"mode":"TRIANGLES")"));
  }
  Mesh mesh = grid(4, 4);
  mesh.positions.push_back(k_no_position);
  const Written made = written(mesh, PositionType::float32);
  CHECK(made.mesh.positions.back() == mesh.positions.front());
}

TEST_CASE("what has no triangles, or is too large to be held in memory, is plain") {
  const Mesh points{grid(3, 3).positions, {}};
  CHECK(written(points, PositionType::float32).bytes ==
        written(points, PositionType::float32, Packing::plain).bytes);
  CHECK(written({}, PositionType::float32).bytes ==
        written({}, PositionType::float32, Packing::plain).bytes);
  const auto can = [](std::uint64_t vertices, std::uint64_t triangles) {
    return can_compress_glb(GltfLayout({.vertices = vertices, .triangles = triangles}));
  };
  CHECK(can(7'000'000, 14'000'000));
  CHECK_FALSE(can(8'000'000, 16'000'000));
  CHECK_FALSE(can(4, 0));
}

TEST_CASE("a coordinate that no float holds is refused by a compressed GLB, too") {
  const TempFolder folder;
  const Mesh mesh{{{0, 0, 0}, {1e300, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  CHECK_THROWS_WITH_AS(
      write_mesh(MeshOutput{folder / "m.glb", Packing::compressed}, mesh, PositionType::float64),
      doctest::Contains("glTF cannot hold a coordinate that is too large for a float"), DataError);
  CHECK(std::filesystem::is_empty(folder.path()));
}
