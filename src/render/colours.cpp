// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "render/colours.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace meshfarm {
namespace {

constexpr std::size_t k_levels = 4096;  // of light, spaced by square roots

/// Conversion between sRGB and light in both directions (IEC 61966-2-1).
struct Tables {
  std::array<float, 256> light{};
  std::array<float, 256> root{};  // of light
  std::vector<std::uint8_t> srgb;

  Tables() : srgb(k_levels + 1) {
    for (std::size_t i = 0; i < light.size(); ++i) {
      const double s = static_cast<double>(i) / 255;
      light[i] = static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
      root[i] = std::sqrt(light[i]);
    }
    for (std::size_t i = 0; i <= k_levels; ++i) {
      const double of_light = static_cast<double>(i) / k_levels;
      const double x = of_light * of_light;
      const double s = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
      srgb[i] = static_cast<std::uint8_t>(std::lround(255 * s));
    }
  }
};

const Tables& tables() {
  static const Tables k_tables;
  return k_tables;
}

/// The sRGB level for the square root of light, from 0 to 1.
std::uint8_t level_of(const Tables& table, float root) {
  return table.srgb[static_cast<std::size_t>(std::lrint(root * k_levels))];
}

constexpr std::array<Srgb, 12> k_palette = {{{92, 146, 204},
                                             {236, 156, 76},
                                             {110, 182, 110},
                                             {212, 100, 98},
                                             {156, 124, 198},
                                             {226, 206, 110},
                                             {96, 190, 196},
                                             {226, 146, 190},
                                             {168, 132, 106},
                                             {172, 198, 92},
                                             {134, 142, 156},
                                             {74, 128, 116}}};

constexpr std::array<Srgb, 6> k_scale = {
    {{44, 22, 98}, {48, 82, 158}, {34, 134, 156}, {62, 178, 128}, {150, 212, 84}, {250, 232, 72}}};

struct Lamp {
  Vec3 toward;  // of length 1
  double power = 0;
};

Lamp lamp(Vec3 toward, double power) {
  return {toward * (1 / length(toward)), power};
}

}  // namespace

Light light_of(const Srgb& colour) {
  const Tables& table = tables();
  return {table.light[colour[0]], table.light[colour[1]], table.light[colour[2]]};
}

Srgb srgb_of(Light light) {
  const Tables& table = tables();
  const auto level = [&](float one) {
    return level_of(table, std::sqrt(std::clamp(one, 0.0F, 1.0F)));
  };
  return {level(light.red), level(light.green), level(light.blue)};
}

Srgb dimmed(const Srgb& colour, float root_of_light) {
  const Tables& table = tables();
  return {level_of(table, table.root[colour[0]] * root_of_light),
          level_of(table, table.root[colour[1]] * root_of_light),
          level_of(table, table.root[colour[2]] * root_of_light)};
}

Srgb colour_of_number(std::uint64_t number) {
  return k_palette[number % k_palette.size()];
}

Srgb colour_on_scale(double place) {
  if (std::isnan(place)) return {150, 150, 150};
  const double at = std::clamp(place, 0.0, 1.0) * (k_scale.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(at), k_scale.size() - 2);
  const double share = at - static_cast<double>(below);
  Srgb colour{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double blend = k_scale[below][i] * (1 - share) + k_scale[below + 1][i] * share;
    colour[i] = static_cast<std::uint8_t>(std::lround(blend));
  }
  return colour;
}

Srgb colour_of_direction(Vec3 direction) {
  const auto level = [](double x) {
    return static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * std::clamp(x, -1.0, 1.0)));
  };
  return {level(direction.x), level(direction.y), level(direction.z)};
}

float light_on(Vec3 normal) {
  static const std::array<Lamp, 3> k_lamps = {lamp({-0.75, 0.6, 0.55}, 0.80),
                                              lamp({0.9, 0.1, 0.35}, 0.12), lamp({0, 0, 1}, 0.14)};
  double light = 0.09 + 0.06 * normal.y;
  for (const Lamp& one : k_lamps) light += one.power * std::max(0.0, dot(one.toward, normal));
  return static_cast<float>(light);
}

}  // namespace meshfarm
