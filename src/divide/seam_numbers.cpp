// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/seam_numbers.hpp"

#include <algorithm>
#include <utility>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {

SeamNumbers::SeamNumbers(std::uint32_t shares, Load load)
    : load_(std::move(load)), loaded_(shares) {}

SharedTriangles SeamNumbers::number(const Seams& seams) {
  SharedTriangles made;
  made.triangles.reserve(seams.triangles.size());
  for (std::size_t place = 0; place < seams.triangles.size(); ++place) {
    BoundaryTriangle corners;
    BoundaryTriangle points;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [share, vertex] = seams.triangles[place][i];
      Loaded& loaded = of(share);
      const std::size_t at = loaded.find(vertex);
      const BoundaryNumbers& numbers = loaded.numbers;
      corners[i] = {share, numbers.numbers[at]};
      points[i] = {share, numbers.points.empty() ? numbers.numbers[at] : numbers.points[at]};
    }
    made.coincident += is_degenerate(points);
    if (is_degenerate(corners)) {
      ++made.degenerate;
    } else {
      made.triangles.push_back(corners);
      made.columns.append(seams.columns, place);
    }
  }
  return made;
}

void SeamNumbers::forget_unused() {
  std::erase_if(shares_, [this](std::uint32_t share) {
    if (std::exchange(loaded_[share]->used, false)) return false;
    loaded_[share].reset();
    return true;
  });
}

SeamNumbers::Loaded& SeamNumbers::of(std::uint32_t share) {
  if (share >= loaded_.size()) throw DataError("a boundary triangle of no part");
  std::unique_ptr<Loaded>& loaded = loaded_[share];
  if (!loaded) {
    loaded = std::make_unique<Loaded>(Loaded{load_(share)});
    shares_.push_back(share);
  }
  loaded->used = true;
  return *loaded;
}

/// Neighbours in the file mostly have the same vertices, or the next ones.
std::size_t SeamNumbers::Loaded::find(std::uint32_t place) {
  constexpr std::size_t k_looked_at = 4;
  const std::vector<std::uint32_t>& places = numbers.places;
  for (std::size_t i = last; i < std::min(last + k_looked_at, places.size()); ++i) {
    if (places[i] == place) return last = i;
  }
  last = static_cast<std::size_t>(std::lower_bound(places.begin(), places.end(), place) -
                                  places.begin());
  if (last == places.size() || places[last] != place)
    throw DataError("a boundary triangle of a vertex that is not there");
  return last;
}

}  // namespace meshfarm
