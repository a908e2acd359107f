// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

#include <meshfarm/geometry/crossings.hpp>
#include <meshfarm/util/parallel.hpp>

#include "geometry/bvh.hpp"
#include "geometry/triangle_crossing.hpp"

namespace meshfarm {
namespace {

constexpr std::size_t k_leaves_a_chunk = 1024;

class CrossingFinder {
 public:
  CrossingFinder(const TriangleIndex& index, const CrossingOptions& options)
      : mesh_(index.mesh()),
        bvh_(index.bvh()),
        leaves_(bvh_.leaves()),
        crosses_(mesh_.triangles.size()),
        most_pairs_(std::max(options.pairs, options.pairs_a_triangle * crosses_.size())) {
    const std::uint64_t chunks = (leaves_.size() + k_leaves_a_chunk - 1) / k_leaves_a_chunk;
    parallel_for(chunks, options.threads, [&](std::uint64_t chunk) {
      const std::size_t first = chunk * k_leaves_a_chunk;
      look_at(
          std::span(leaves_).subspan(first, std::min(k_leaves_a_chunk, leaves_.size() - first)));
    });
  }

  std::optional<std::uint64_t> count() const {
    if (is_too_much()) return std::nullopt;
    return std::count(crosses_.begin(), crosses_.end(), true);
  }

 private:
  /// The triangles of leaves that lie together.
  struct Loaded {
    std::uint32_t first = 0;
    std::vector<CrossingTriangle> triangles;

    bool has(const Bvh::Leaf& leaf) const {
      return leaf.first >= first && leaf.first < first + triangles.size();
    }
    std::span<const CrossingTriangle> of(const Bvh::Leaf& leaf) const {
      return std::span(triangles).subspan(leaf.first - first, leaf.count);
    }
  };

  /// Depends only on the number of all pairs, not on the order in which threads find them.
  bool is_too_much() const { return pairs_.load(std::memory_order_relaxed) > most_pairs_; }

  void load(const Bvh::Leaf& leaf, std::vector<CrossingTriangle>& triangles) const {
    for (const std::uint32_t index : bvh_.triangles_of(leaf)) {
      const auto& [a, b, c] = mesh_.triangles[index];
      triangles.emplace_back(
          TriangleCorners{mesh_.positions[a], mesh_.positions[b], mesh_.positions[c]});
    }
  }

  struct LoadedLeaf {
    std::span<const std::uint32_t> indices;
    std::span<const CrossingTriangle> triangles;
    Box box{};  // of an own leaf
  };

  void look_at(std::span<const Bvh::Leaf> leaves) {
    Loaded loaded{leaves.front().first, {}};
    for (const Bvh::Leaf& leaf : leaves) load(leaf, loaded.triangles);
    std::vector<CrossingTriangle> beyond;
    std::vector<Bvh::Leaf> touching;
    for (const Bvh::Leaf& leaf : leaves) {
      if (is_too_much()) return;
      touching.clear();
      bvh_.find_touching(leaf, touching);
      LoadedLeaf own{bvh_.triangles_of(leaf), loaded.of(leaf)};
      for (const CrossingTriangle& t : own.triangles) {
        own.box.add(t.box.lo);
        own.box.add(t.box.hi);
      }
      std::uint64_t pairs = look_within(own);
      for (const Bvh::Leaf& other : touching) {
        if (other.first == leaf.first) continue;
        if (loaded.has(other)) {
          pairs += look_at_both(own, {bvh_.triangles_of(other), loaded.of(other)});
          continue;
        }
        beyond.clear();
        load(other, beyond);
        pairs += look_at_both(own, {bvh_.triangles_of(other), beyond});
      }
      pairs_.fetch_add(pairs, std::memory_order_relaxed);
    }
  }

  std::uint64_t look_within(const LoadedLeaf& own) {
    const std::size_t count = own.indices.size();
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t k = i + 1; k < count; ++k) look_at_pair(own, i, own, k);
    }
    return count * (count - 1) / 2;
  }

  std::uint64_t look_at_both(const LoadedLeaf& own, const LoadedLeaf& other) {
    std::uint64_t pairs = 0;
    for (std::size_t k = 0; k < other.indices.size(); ++k) {
      const Box& box = other.triangles[k].box;
      if (!do_touch(own.box, box)) continue;
      for (std::size_t i = 0; i < own.indices.size(); ++i) {
        if (!do_touch(own.triangles[i].box, box)) continue;
        ++pairs;
        look_at_pair(own, i, other, k);
      }
    }
    return pairs;
  }

  void look_at_pair(const LoadedLeaf& a, std::size_t i, const LoadedLeaf& b, std::size_t k) {
    std::atomic<bool>& a_crosses = crosses_[a.indices[i]];
    std::atomic<bool>& b_crosses = crosses_[b.indices[k]];
    if (a_crosses.load(std::memory_order_relaxed) && b_crosses.load(std::memory_order_relaxed)) {
      return;
    }
    if (!do_cross(a.triangles[i], b.triangles[k])) return;
    a_crosses.store(true, std::memory_order_relaxed);
    b_crosses.store(true, std::memory_order_relaxed);
  }

  const Mesh& mesh_;
  const Bvh& bvh_;
  std::vector<Bvh::Leaf> leaves_;
  std::vector<std::atomic<bool>> crosses_;  // of the triangles
  std::uint64_t most_pairs_;
  std::atomic<std::uint64_t> pairs_ = 0;
};

}  // namespace

std::optional<std::uint64_t> count_crossing_triangles(const TriangleIndex& index,
                                                      const CrossingOptions& options) {
  return CrossingFinder(index, options).count();
}

std::optional<std::uint64_t> count_crossing_triangles(const Mesh& mesh,
                                                      const CrossingOptions& options) {
  if (mesh.triangles.empty()) return 0;
  return count_crossing_triangles(TriangleIndex(mesh, options.threads), options);
}

}  // namespace meshfarm
