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

constexpr std::uint64_t k_packed_bytes = 8;  // of a triangle, some of them escaped
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
      seams_for_(options.seams),
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
      next_(options.shares, 0) {}

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
  vertices_.finish();  // its buffers are of no more use
  appearances_.finish();
}

/// Unmaps the pages of the scratch file from time to time. What they hold stays in the page cache
/// as long as there is room for it, which counts for nobody's memory.
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
  // Where the input has no locality each look-up misses the caches: several are kept under way.
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
      put_seam_triangle({a, b, c});
      if (seams_for_ == SeamsFor::all) boundary_columns_.append(triangles.columns, i);
    }
  }
  forget_pages(batch.size());
}

/// To each of its shares, once.
void MeshShares::put_seam_triangle(const SeamTriangle& t) {
  if (seams_for_ == SeamsFor::all) boundary_.push_back(t);
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

Vec3 MeshShares::position_of(SharePlace vertex) const {
  if (positions_ == PositionType::float64)
    return vertices_.read_one<Vec3>(vertex.share, vertex.place);
  const auto p = vertices_.read_one<std::array<float, 3>>(vertex.share, vertex.place);
  return {p[0], p[1], p[2]};
}

SharedTriangles MeshShares::boundary(std::span<const BoundaryNumbers> numbers) const {
  SharedTriangles made;
  made.triangles.reserve(boundary_.size());
  number_seams(boundary_, boundary_columns_, numbers, made);
  return made;
}

void number_seams(std::span<const SeamTriangle> seams, const TriangleColumns& columns,
                  std::span<const BoundaryNumbers> numbers, SharedTriangles& made) {
  constexpr std::size_t k_looked_at = 4;
  // Neighbours in the file mostly have the same vertices, or the next.
  std::vector<std::size_t> last(numbers.size(), 0);
  const auto index = [&](const SharePlace& corner) {
    const std::vector<std::uint32_t>& places = numbers[corner.share].places;
    std::size_t& at = last[corner.share];
    for (std::size_t i = at; i < std::min(at + k_looked_at, places.size()); ++i) {
      if (places[i] == corner.place) return at = i;
    }
    at = static_cast<std::size_t>(std::lower_bound(places.begin(), places.end(), corner.place) -
                                  places.begin());
    if (at == places.size()) throw DataError("a boundary triangle of a vertex that is not there");
    return at;
  };
  for (std::size_t place = 0; place < seams.size(); ++place) {
    const SeamTriangle& t = seams[place];
    BoundaryTriangle corners;
    BoundaryTriangle points;
    for (std::size_t i = 0; i < 3; ++i) {
      const BoundaryNumbers& of = numbers[t[i].share];
      const std::size_t at = index(t[i]);
      corners[i] = {t[i].share, of.numbers[at]};
      points[i] = {t[i].share, of.points.empty() ? of.numbers[at] : of.points[at]};
    }
    made.coincident += is_degenerate(points);
    if (is_degenerate(corners)) {
      ++made.degenerate;
    } else {
      made.triangles.push_back(corners);
      made.columns.append(columns, place);
    }
  }
}

}  // namespace meshfarm
