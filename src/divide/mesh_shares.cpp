// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/mesh_shares.hpp"

#include <algorithm>
#include <utility>

#include <sys/mman.h>

#include <meshfarm/util/errors.hpp>

#include "divide/seam_vertices.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_packed_bytes = 8;  // per triangle; some are escaped
constexpr const char* k_changed = "the input has other vertices than before: it was changed";

}  // namespace

std::uint64_t MeshShares::memory_for(const Options& options) {
  return options.vertices *
             (sizeof(SharePlace) + 3 * static_cast<std::uint64_t>(options.positions) +
              (options.appearances ? sizeof(Appearance) : 0)) +
         options.triangles * (k_packed_bytes + options.columns.bytes());
}

MeshShares::Memory::Memory(const Options& options) {
  std::uint64_t left = options.memory_bytes;
  const std::uint64_t all = options.vertices * sizeof(SharePlace);
  map = all <= left ? all : 0;
  left -= map;
  vertices = std::min(left, 3 * static_cast<std::uint64_t>(options.positions) * options.vertices);
  left -= vertices;
  appearances = std::min(left, options.appearances ? sizeof(Appearance) * options.vertices : 0);
  left -= appearances;
  labels = std::min(left, options.columns.labels ? sizeof(Label) * options.triangles : 0);
  left -= labels;
  uvs = std::min(left, options.columns.uvs ? sizeof(CornerUvs) * options.triangles : 0);
  triangles = left - uvs;
}

MeshShares::MeshShares(const Options& options) : MeshShares(options, Memory(options)) {}

MeshShares::MeshShares(const Options& options, const Memory& memory)
    : positions_(options.positions),
      regions_(options.seams == SeamsFor::shares_and_regions
                   ? std::optional<Regions>(options.shares)
                   : std::nullopt),
      map_(memory.map > 0
               ? MappedFile::memory(memory.map)
               : MappedFile::scratch(options.folder, options.vertices * sizeof(SharePlace))),
      is_in_memory_(memory.map > 0),
      has_appearances_(options.appearances),
      columns_(options.columns),
      vertices_(options.folder, options.shares, memory.vertices),
      appearances_(options.folder, options.appearances ? options.shares : 0, memory.appearances),
      labels_(options.folder, options.columns.labels ? options.shares : 0, memory.labels),
      uvs_(options.folder, options.columns.uvs ? options.shares : 0, memory.uvs),
      triangles_(options.folder, options.shares, memory.triangles),
      packers_(options.shares),
      seams_(options.folder, options.shares),
      region_seams_(by_region(options, true)),
      region_labels_(by_region(options, options.columns.labels)),
      region_uvs_(by_region(options, options.columns.uvs)),
      next_(options.shares, 0) {}

BucketFile MeshShares::by_region(const Options& options, bool wanted) const {
  return {options.folder, regions_ && wanted ? regions_->count() : 0};
}

void MeshShares::add_vertices(const VertexView& batch, std::span<const std::uint32_t> shares,
                              std::span<const std::uint32_t> points) {
  const std::span<SharePlace> map = map_.as_span<SharePlace>();
  if (batch.size() > map.size() - added_) throw DataError(k_changed);
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const std::uint32_t share = shares[i];
    if (share == k_no_share) {
      map[added_++] = {k_no_share, 0};
      continue;
    }
    if (next_[share] > 0xfffffffe) {
      throw DataError("a part would have 2^32 vertices or more; ask for more --parts");
    }
    const SharePlace place{share, static_cast<std::uint32_t>(next_[share])};
    if (!points.empty() && points[i] != k_no_point) {
      const auto [first, is_first] = points_.try_emplace(points[i], PointVertex{place, {}});
      PointVertex& vertex = first->second;
      if (!batch.appearances.empty()) {
        const Appearance& appearance = batch.appearances[i];
        vertex.least = is_first ? appearance : std::min(vertex.least, appearance);
      }
      if (!is_first) {
        map[added_++] = vertex.place;
        ++merged_;
        continue;
      }
    }
    map[added_++] = place;
    ++next_[share];
    put_position(share, batch.positions[i]);
    if (!batch.appearances.empty()) appearances_.put(share, batch.appearances[i]);
  }
  forget_pages(batch.size());
  if (added_ < map.size()) return;
  vertices_.finish();  // its buffers are no longer needed
  appearances_.finish();
}

/// Unmaps the pages of the scratch file from time to time. Their contents stay in the page cache as
/// long as there is room, which is not counted as anybody's memory.
void MeshShares::forget_pages(std::size_t added) {
  constexpr std::size_t k_seldom = std::size_t{8} << 20;
  since_forgotten_ += added;
  if (since_forgotten_ < k_seldom || is_in_memory_) return;
  since_forgotten_ = 0;
  const std::span<SharePlace> map = map_.as_span<SharePlace>();
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

void MeshShares::add_triangles(const TriangleView& triangles) {
  const std::span<const WideTriangle> batch = triangles.corners;
  if (added_ < map_.as_span<const SharePlace>().size()) throw DataError(k_changed);
  const std::span<const SharePlace> map = map_.as_span<const SharePlace>();
  // If the input has no locality, each look-up misses the caches: several are kept in flight.
  constexpr std::size_t k_ahead = 16;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    if (i + k_ahead < batch.size()) {
      for (const std::uint64_t v : batch[i + k_ahead]) __builtin_prefetch(&map[v]);
    }
    const WideTriangle& t = batch[i];
    const SharePlace a = map[t[0]];
    const SharePlace b = map[t[1]];
    const SharePlace c = map[t[2]];
    if (a.share == k_no_share || b.share == k_no_share || c.share == k_no_share) {
      ++dropped_;
    } else if (a == b && b == c) {
      ++points_left_out_;
    } else if (a.share == b.share && b.share == c.share) {
      triangles_.append(a.share, packers_[a.share].pack({a.place, b.place, c.place}));
      if (columns_.labels) labels_.put(a.share, triangles.columns.labels[i]);
      if (columns_.uvs) uvs_.put(a.share, triangles.columns.uvs[i]);
    } else {
      put_seam_triangle({a, b, c}, triangles.columns, i);
    }
  }
  forget_pages(batch.size());
}

/// Adds the triangle to each of its shares, once.
void MeshShares::put_seam_triangle(const SeamTriangle& t, const TriangleColumnsView& columns,
                                   std::size_t place) {
  if (regions_) {
    const auto [least, greatest] = std::minmax({t[0].share, t[1].share, t[2].share});
    const std::uint32_t region = regions_->of(least, greatest);
    region_seams_.put(region, t);
    if (columns_.labels) region_labels_.put(region, columns.labels[place]);
    if (columns_.uvs) region_uvs_.put(region, columns.uvs[place]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const bool seen = (i > 0 && t[i].share == t[0].share) || (i > 1 && t[i].share == t[1].share);
    if (!seen) seams_.put(t[i].share, t);
  }
}

void MeshShares::finish() {
  triangles_.finish();
  labels_.finish();
  uvs_.finish();
  seams_.finish();
  region_seams_.finish();
  region_labels_.finish();
  region_uvs_.finish();
  map_ = {};
}

MeshShare MeshShares::read(std::uint32_t share, Weld weld) const {
  MeshShare read;
  read.type = positions_;
  if (positions_ == PositionType::float64) {
    read.positions = vertices_.read<Vec3>(share);
  } else {
    const auto floats = vertices_.read<std::array<float, 3>>(share);
    read.positions.reserve(floats.size());
    for (const auto& p : floats) read.positions.push_back({p[0], p[1], p[2]});
  }
  if (has_appearances_) {
    read.appearances = appearances_.read<Appearance>(share);
    for (const auto& [point, vertex] : points_) {
      if (vertex.place.share == share) read.appearances[vertex.place.place] = vertex.least;
    }
  }
  const auto packed = triangles_.read<char>(share);
  auto triangles = unpack_triangles({packed.data(), packed.size()});
  if (!triangles) throw Error("a share's triangles are not those that were put");
  read.triangles = std::move(*triangles);
  if (columns_.labels) read.columns.labels = labels_.read<Label>(share);
  if (columns_.uvs) read.columns.uvs = uvs_.read<CornerUvs>(share);
  const std::vector<SeamTriangle> outer = seam(share);
  for (const SeamTriangle& t : outer) {
    for (const SharePlace& corner : t) {
      if (corner.share == share) read.boundary.push_back(corner.place);
    }
  }
  if (weld == Weld::exact) {
    read.apart =
        find_apart(read, share, outer, [&](SharePlace vertex) { return position_of(vertex); });
  }
  return read;
}

std::vector<SeamTriangle> MeshShares::seam(std::uint32_t share) const {
  return seams_.read<SeamTriangle>(share);
}

Seams MeshShares::region(std::uint32_t region) const {
  Seams seams;
  seams.triangles = region_seams_.read<SeamTriangle>(region);
  if (columns_.labels) seams.columns.labels = region_labels_.read<Label>(region);
  if (columns_.uvs) seams.columns.uvs = region_uvs_.read<CornerUvs>(region);
  return seams;
}

Vec3 MeshShares::position_of(SharePlace vertex) const {
  if (positions_ == PositionType::float64)
    return vertices_.read_one<Vec3>(vertex.share, vertex.place);
  const auto p = vertices_.read_one<std::array<float, 3>>(vertex.share, vertex.place);
  return {p[0], p[1], p[2]};
}

}  // namespace meshfarm
