// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/collapse_drift.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/bvh.hpp"

namespace meshfarm {

void DriftMeter::list_star(std::uint32_t a, std::uint32_t b, Vec3 position) {
  were_.clear();
  made_.clear();
  for (const std::uint32_t end : {a, b}) {
    for (const Corner& c : state_.adjacency->at(end)) {
      const std::uint32_t next = state_.target[c.next];
      const std::uint32_t prev = state_.target[c.prev];
      if (next == prev) continue;
      const Vec3 n = state_.positions[next];
      const Vec3 p = state_.positions[prev];
      were_.push_back({state_.positions[end], n, p});
      if (next != a && next != b && prev != a && prev != b) made_.push_back({position, n, p});
    }
  }
}

double DriftMeter::drift_of(std::uint32_t a, std::uint32_t b, Vec3 position, double least) {
  list_star(a, b, position);
  double greatest = least * least;
  // The nearest triangle is often the one in the same place, or its neighbour.
  const auto look = [&](Vec3 point, const std::vector<Facet>& facets, std::size_t first) {
    double squared = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < facets.size() && squared > greatest; ++i) {
      const Facet& facet = facets[(first + i) % facets.size()];
      squared = std::min(squared, squared_distance(point, facet.first, facet.next, facet.prev));
    }
    greatest = std::max(greatest, squared);
  };
  look(state_.positions[a], made_, 0);
  look(state_.positions[b], made_, 0);
  look(position, were_, 0);
  std::size_t made = 0;
  for (std::size_t were = 0; were < were_.size() && made < made_.size(); ++were) {
    const auto& [first, next, prev] = were_[were];
    look((first + next) * 0.5, made_, made);
    look((first + next + prev) * (1.0 / 3), made_, made);
    if (made_[made].next != next || made_[made].prev != prev) continue;
    look((position + next) * 0.5, were_, were);
    look((position + next + prev) * (1.0 / 3), were_, were);
    ++made;
  }
  return std::sqrt(greatest);
}

}  // namespace meshfarm
