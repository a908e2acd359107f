// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>
#include <random>
#include <utility>

#include <meshfarm/geometry/generate.hpp>

namespace meshfarm {
namespace {

/// Fisher-Yates. How std::shuffle uses its random numbers differs between libraries.
template <class T>
void shuffle_all(std::vector<T>& values, std::mt19937_64& random) {
  for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[random() % i]);
}

}  // namespace

void shuffle(Mesh& mesh, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<std::uint32_t> place(mesh.positions.size());  // of each vertex
  std::iota(place.begin(), place.end(), 0U);
  shuffle_all(place, random);
  std::vector<Vec3> positions(mesh.positions.size());
  for (std::size_t v = 0; v < place.size(); ++v) positions[place[v]] = mesh.positions[v];
  mesh.positions = std::move(positions);
  for (Triangle& t : mesh.triangles) {
    t = {place[t[0]], place[t[1]], place[t[2]]};
    std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(random() % 3), t.end());
  }
  shuffle_all(mesh.triangles, random);
}

}  // namespace meshfarm
