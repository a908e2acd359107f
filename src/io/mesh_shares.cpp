// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include <sys/mman.h>

#include <meshfarm/io/mesh_shares.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr std::uint64_t k_packed_bytes = 8;  // of a triangle, some of them escaped

}  // namespace

std::uint32_t BoundaryNumbers::count() const {
  return numbers.empty() ? 0 : *std::max_element(numbers.begin(), numbers.end()) + 1;
}

std::uint64_t MeshShares::memory_for(std::uint64_t vertices, std::uint64_t triangles,
                                     PositionType positions) {
  return vertices * (sizeof(Place) + 3 * static_cast<std::uint64_t>(positions)) +
         triangles * k_packed_bytes;
}

MeshShares::Memory::Memory(const Options& options) {
  std::uint64_t left = options.memory_bytes;
  const std::uint64_t all = options.vertices * sizeof(Place);
  map = all <= left ? all : 0;
  left -= map;
  vertices = std::min(left, 3 * static_cast<std::uint64_t>(options.positions) * options.vertices);
  triangles = left - vertices;
}

MeshShares::MeshShares(const Options& options) : MeshShares(options, Memory(options)) {}

MeshShares::MeshShares(const Options& options, const Memory& memory)
    : positions_(options.positions),
      map_(memory.map > 0 ? MappedFile::memory(memory.map)
                          : MappedFile::scratch(options.folder, options.vertices * sizeof(Place))),
      is_in_memory_(memory.map > 0),
      vertices_(options.folder, options.shares, memory.vertices),
      triangles_(options.folder, options.shares, memory.triangles),
      packers_(options.shares),
      boundary_vertices_(options.folder, options.shares),
      next_(options.shares, 0) {}

void MeshShares::add_vertices(std::span<const Vec3> batch, std::span<const std::uint32_t> shares,
                              std::span<const std::uint32_t> points) {
  const std::span<Place> map = map_.as_span<Place>();
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const std::uint32_t share = shares[i];
    if (share == k_no_share) {
      map[added_++] = {k_no_share, 0};
      continue;
    }
    if (next_[share] > 0xfffffffe) {
      throw DataError("a part would have 2^32 vertices or more; ask for more --parts");
    }
    const Place place{share, static_cast<std::uint32_t>(next_[share])};
    if (!points.empty() && points[i] != k_no_point) {
      const auto [first, is_first] = points_.try_emplace(points[i], place);
      if (!is_first) {
        map[added_++] = first->second;
        ++merged_;
        continue;
      }
    }
    map[added_++] = place;
    ++next_[share];
    put_position(share, batch[i]);
  }
  forget_pages(batch.size());
  if (added_ == map.size()) vertices_.finish();  // its buffers are of no more use
}

/// Unmaps the pages of the scratch file from time to time. What they hold stays in the page cache
/// as long as there is room for it, which counts for nobody's memory.
void MeshShares::forget_pages(std::size_t added) {
  constexpr std::size_t k_seldom = std::size_t{8} << 20;
  since_forgotten_ += added;
  if (since_forgotten_ < k_seldom || is_in_memory_) return;
  since_forgotten_ = 0;
  const std::span<Place> map = map_.as_span<Place>();
  ::madvise(map.data(), map.size_bytes(), MADV_DONTNEED);  // advice: nothing is lost if it fails
}

void MeshShares::put_position(std::uint32_t share, Vec3 p) {
  if (positions_ == PositionType::float64) {
    vertices_.put(share, p);
  } else {
    vertices_.put(share, std::array<float, 3>{static_cast<float>(p.x), static_cast<float>(p.y),
                                              static_cast<float>(p.z)});
  }
}

void MeshShares::add_triangles(std::span<const WideTriangle> batch) {
  const std::span<const Place> map = map_.as_span<const Place>();
  // Where the input has no locality each look-up misses the caches: several are kept under way.
  constexpr std::size_t k_ahead = 16;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    if (i + k_ahead < batch.size()) {
      for (const std::uint64_t v : batch[i + k_ahead]) __builtin_prefetch(&map[v]);
    }
    const WideTriangle& t = batch[i];
    const Place a = map[t[0]];
    const Place b = map[t[1]];
    const Place c = map[t[2]];
    if (a.share == k_no_share || b.share == k_no_share || c.share == k_no_share) {
      ++dropped_;
    } else if (a.share == b.share && b.share == c.share) {
      triangles_.append(a.share, packers_[a.share].pack({a.place, b.place, c.place}));
    } else {
      boundary_.push_back({a, b, c});
      for (const Place& corner : {a, b, c}) boundary_vertices_.put(corner.share, corner.place);
    }
  }
  forget_pages(batch.size());
}

void MeshShares::finish() {
  triangles_.finish();
  boundary_vertices_.finish();
  map_ = {};
}

MeshShare MeshShares::read(std::uint32_t share) const {
  MeshShare read;
  read.type = positions_;
  if (positions_ == PositionType::float64) {
    read.positions = vertices_.read<Vec3>(share);
  } else {
    const auto floats = vertices_.read<std::array<float, 3>>(share);
    read.positions.reserve(floats.size());
    for (const auto& p : floats) read.positions.push_back({p[0], p[1], p[2]});
  }
  const auto packed = triangles_.read<char>(share);
  auto triangles = unpack_triangles({packed.data(), packed.size()});
  if (!triangles) throw Error("a share's triangles are not those that were put");
  read.triangles = std::move(*triangles);
  read.boundary = boundary_vertices_.read<std::uint32_t>(share);
  return read;
}

std::vector<BoundaryTriangle> MeshShares::boundary(std::span<const BoundaryNumbers> numbers,
                                                   std::uint64_t& degenerate) const {
  const auto numbered = [&](const Place& corner) -> BoundaryCorner {
    const BoundaryNumbers& of = numbers[corner.share];
    const auto at = std::lower_bound(of.places.begin(), of.places.end(), corner.place);
    return {corner.share, of.numbers[static_cast<std::size_t>(at - of.places.begin())]};
  };
  std::vector<BoundaryTriangle> triangles;
  triangles.reserve(boundary_.size());
  for (const std::array<Place, 3>& t : boundary_) {
    const BoundaryTriangle made = {numbered(t[0]), numbered(t[1]), numbered(t[2])};
    if (made[0] == made[1] || made[1] == made[2] || made[2] == made[0]) {
      ++degenerate;
    } else {
      triangles.push_back(made);
    }
  }
  return triangles;
}

}  // namespace meshfarm
