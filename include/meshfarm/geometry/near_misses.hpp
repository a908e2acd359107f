// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

/// Finds out, from a sample of a mesh, whether corners that belong together miss each other by
/// little, as after coordinates were rounded: many vertices then have another one very near that is
/// in none of their triangles, and none somewhat farther away. All vertices have to be added, then
/// all triangles if look() says so. What is found does not depend on the order.
/// Memory: up to about 70 MB.
class NearMisses {
 public:
  /// distance() is at most this share of the diagonal.
  static constexpr double k_most_of_diagonal = 1e-5;

  /// `box`: of all vertices.
  explicit NearMisses(const Box& box);

  /// Takes vertices in their order; those without a position are left out.
  void add(std::span<const Vec3> batch);
  /// Whether many vertices have others very near: only then triangles are needed.
  bool look();
  void add(std::span<const std::array<std::uint64_t, 3>> triangles);
  /// How far corners that belong together may be apart, for merge_near(); 0 if no corners miss
  /// each other.
  double distance() const;

 private:
  struct Sampled {
    Vec3 position;
    std::uint64_t cell = 0;  // its hash
    std::uint64_t vertex = 0;
  };
  struct Pair {
    std::uint32_t a = 0;  // places, a < b
    std::uint32_t b = 0;
    bool has_triangle = false;
  };

  void thin_out();
  void number_places();
  /// Calls take(i, j, distance) for places in a cell that are at most `most` apart. Returns false
  /// if there are too many to look at.
  template <class Take>
  bool for_neighbours(double most, Take take) const;
  void list_pairs();
  void join(std::uint32_t a, std::uint32_t b);

  Vec3 corner_;
  double diagonal_;
  std::vector<Sampled> sample_;
  unsigned thinned_ = 0;  // one of 2^thinned cells is in the sample
  std::uint64_t vertices_ = 0;
  std::vector<std::uint32_t> places_;  // the first in the sample at each place
  double near_ = 0;                    // the greatest distance between very near places
  std::vector<Pair> pairs_;            // sorted
  std::unordered_map<std::uint64_t, std::uint32_t> place_of_;  // by vertex, of those in pairs
};

}  // namespace meshfarm
