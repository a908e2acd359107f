// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <vector>

#include <doctest/doctest.h>

#include "render/pieces.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

/// Every triangle has its own corners. Those of one strip touch, but are far apart in the list, so
/// that only equal positions join them.
struct Strips {
  static constexpr std::uint64_t k_strips = 7;
  static constexpr std::uint64_t k_triangles = 30'000;
  static constexpr std::uint64_t k_stride = 12'347;  // coprime to k_triangles

  std::vector<ScreenPoint> places;
  std::vector<WideTriangle> triangles;

  Strips() {
    for (std::uint64_t i = 0; i < k_triangles; ++i) {
      const std::uint64_t at = i * k_stride % k_triangles;
      const auto strip = static_cast<float>(at % k_strips);
      const auto along = static_cast<float>(at / k_strips);
      const std::uint64_t first = places.size();
      for (const float step : {0.0F, 1.0F, 2.0F}) places.push_back({along + step, strip, -0.0F});
      triangles.push_back({first, first + 1, first + 2});
    }
  }
};

}  // namespace

TEST_CASE("vertices at one place are one piece, in memory and in scratch files") {
  const Strips strips;
  const test::TempFolder folder;
  std::vector<std::vector<std::uint32_t>> colours;
  for (const std::uint64_t memory : {std::uint64_t{0}, std::uint64_t{1} << 24}) {
    CAPTURE(memory);
    const ArrayRoom room{folder.path(), memory};
    PagedArray<ScreenPoint> places(strips.places.size(), room);
    places.write(0, strips.places);
    Pieces pieces(places, room, memory / 8);
    pieces.join(strips.triangles);
    PagedArray<std::uint32_t> painted(strips.places.size(), room);
    CHECK(pieces.colour(painted) == Strips::k_strips);
    PagedArray<std::uint32_t>::View view(painted);
    std::vector<std::uint32_t>& all = colours.emplace_back();
    for (std::uint64_t v = 0; v < strips.places.size(); ++v) all.push_back(view.get(v));
    std::vector<std::uint32_t> of_strip(Strips::k_strips, 0);
    std::uint64_t wrong = 0;
    for (std::uint64_t v = 0; v < strips.places.size(); ++v) {
      std::uint32_t& colour = of_strip[static_cast<std::size_t>(strips.places[v].y)];
      if (colour == 0) colour = all[v];
      wrong += all[v] != colour ? 1 : 0;
    }
    CHECK(wrong == 0);
  }
  CHECK(colours.front() == colours.back());
}
