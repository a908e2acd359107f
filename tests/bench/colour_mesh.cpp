// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Colours the vertices of a mesh by their position: colour_mesh INPUT OUTPUT.ply noise|stripes
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <string_view>
#include <vector>

#include <meshfarm/io/channel.hpp>
#include <meshfarm/io/mesh_sink.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/io/ply_writer.hpp>

namespace meshfarm::bench {
namespace {

using Colour = std::array<double, 3>;
using Colouring = Colour (*)(Vec3);  // point in the unit cube; components from 0 to 1

/// From 0 to 1, different for each grid corner and seed.
double random_at(std::array<std::int64_t, 3> corner, std::uint64_t seed) {
  std::uint64_t x = seed;
  for (const std::int64_t number : corner) {
    x = (x ^ static_cast<std::uint64_t>(number)) * 0x9E3779B97F4A7C15U;
    x ^= x >> 29;
  }
  return static_cast<double>(x >> 11) * 0x1p-53;
}

/// Value noise of one octave: smooth between the corners of the grid.
double value_noise(Vec3 p, std::uint64_t seed) {
  const std::array<double, 3> at{p.x, p.y, p.z};
  std::array<std::int64_t, 3> cell{};
  std::array<double, 3> t{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cell[axis] = static_cast<std::int64_t>(std::floor(at[axis]));
    const double x = at[axis] - std::floor(at[axis]);
    t[axis] = x * x * (3 - 2 * x);
  }
  double sum = 0;
  for (std::uint32_t corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::array<std::int64_t, 3> grid = cell;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool upper = (corner >> axis & 1U) != 0;
      weight *= upper ? t[axis] : 1 - t[axis];
      if (upper) ++grid[axis];
    }
    sum += weight * random_at(grid, seed);
  }
  return sum;
}

Colour noise(Vec3 p) {
  Colour made{};
  for (std::uint64_t i = 0; i < 3; ++i) {
    double sum = 0;
    for (std::uint64_t octave = 0; octave < 4; ++octave) {
      const auto scale = static_cast<double>(1U << octave);
      sum += value_noise(p * (4 * scale), 10 * i + octave) / scale;
    }
    made[i] = std::clamp((sum / 1.875 - 0.5) * 1.6 + 0.5, 0.0, 1.0);
  }
  return made;
}

Colour stripes(Vec3 p) {
  const bool odd = std::fmod(std::floor((p.x + 0.3 * p.y + 0.2 * p.z) * 20), 2) != 0;
  return odd ? Colour{0.1, 0.3, 0.8} : Colour{0.9, 0.2, 0.1};
}

void colour(const char* input, const char* output, Colouring colour_at) {
  const auto source = open_mesh(input);
  Box box;
  source->scan_vertices([&](std::span<const Vec3> batch) {
    for (const Vec3& p : batch) {
      if (has_position(p)) box.add(p);
    }
  });
  const Vec3 size = box.hi - box.lo;
  const double scale = 1 / std::max({size.x, size.y, size.z});
  MeshSinkOptions options;
  options.vertices = source->info().vertices;
  options.positions = source->info().positions;
  for (const char* name : {"red", "green", "blue"}) {
    options.channels.push_back({name, ChannelType::uint8, ChannelRole::colour});
  }
  source->scan_triangles(
      [&](std::span<const WideTriangle> batch) { options.triangles += batch.size(); });
  const auto sink = create_ply(output, options);
  std::vector<float> values;
  source->scan_vertices([&](std::span<const Vec3> batch) {
    values.clear();
    for (const Vec3& p : batch) {
      for (const double level : colour_at((p - box.lo) * scale)) {
        values.push_back(static_cast<float>(std::round(255 * level)));
      }
    }
    sink->vertices(batch, values);
  });
  source->scan_triangles([&](std::span<const WideTriangle> batch) { sink->triangles(batch); });
  sink->commit();
}

}  // namespace
}  // namespace meshfarm::bench

int main(int argc, char** argv) {
  using namespace meshfarm::bench;
  try {
    const std::string_view kind = argc == 4 ? argv[3] : "";
    if (kind != "noise" && kind != "stripes") {
      std::fprintf(stderr, "usage: colour_mesh INPUT OUTPUT.ply noise|stripes\n");
      return 2;
    }
    colour(argv[1], argv[2], kind == "noise" ? noise : stripes);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "colour_mesh: %s\n", error.what());
    return 1;
  }
}
