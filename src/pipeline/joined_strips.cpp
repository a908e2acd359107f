// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/joined_strips.hpp"

#include <set>
#include <utility>

#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/regions.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/piece_sections.hpp"

namespace meshfarm {
namespace {

constexpr std::uint32_t k_no_group = UINT32_MAX;

}  // namespace

/// The boundary triangles at some of the pieces.
class SeamTriangles {
 public:
  explicit SeamTriangles(const SeamParameters& parameters, const JobContext& context)
      : all_parts_(parameters.all_parts),
        regions_(context.stage, parameters.boundary, parameters.all_parts) {
    for (std::uint32_t piece = 0; piece < parameters.strips.size(); ++piece) {
      const auto first = static_cast<std::uint32_t>(piece_of_part_.size());
      piece_of_part_.insert(piece_of_part_.end(), parameters.strips[piece].parts, piece);
      parts_.push_back({first, static_cast<std::uint32_t>(piece_of_part_.size())});
    }
  }

  std::uint32_t piece_of(const BoundaryCorner& corner) const {
    if (corner.part >= piece_of_part_.size()) throw DataError("a boundary triangle of no part");
    return piece_of_part_[corner.part];
  }

  struct Some {
    std::vector<BoundaryTriangle> triangles;
    TriangleColumns columns;
  };
  Some at(const std::vector<std::uint8_t>& pieces) {
    std::set<std::uint32_t> touched;
    for (std::size_t piece = 0; piece < pieces.size(); ++piece) {
      if (pieces[piece] == 0) continue;
      const std::vector<std::uint32_t> more = Regions(all_parts_).touched_by({parts_[piece]});
      touched.insert(more.begin(), more.end());
    }
    Some some;
    for (const std::uint32_t region : touched) regions_.read(region, some.triangles, some.columns);
    keep_triangles(some.triangles, some.columns, [&](std::size_t i) {
      const BoundaryTriangle& t = some.triangles[i];
      return std::any_of(t.begin(), t.end(),
                         [&](const BoundaryCorner& c) { return pieces[piece_of(c)] != 0; });
    });
    return some;
  }

  /// The pieces, and those that share a boundary triangle with one of them.
  std::vector<std::uint8_t> with_neighbours(std::vector<std::uint8_t> pieces) {
    for (const BoundaryTriangle& t : at(pieces).triangles) {
      for (const BoundaryCorner& corner : t) pieces[piece_of(corner)] = 1;
    }
    return pieces;
  }

 private:
  std::uint32_t all_parts_;
  BoundaryRegions regions_;
  std::vector<std::uint32_t> piece_of_part_;
  std::vector<PartRange> parts_;  // of each piece
};

JoinedStrips::JoinedStrips(const SeamParameters& parameters, const JobContext& context)
    : parameters_(parameters) {
  SeamTriangles seams(parameters, context);
  std::vector<std::uint8_t> own(parameters.strips.size(), 0);
  for (std::size_t i = 0; i < own.size(); ++i) own[i] = group_of(i) == parameters.group ? 1 : 0;
  const std::vector<std::uint8_t> inner = seams.with_neighbours(std::move(own));
  const std::vector<std::uint8_t> near = seams.with_neighbours(inner);
  stitch(context, near, seams);
  group_.assign(mesh().positions.size(), k_no_group);
  begin_groups();
  for (std::size_t i = 0; i < inner.size(); ++i) {
    if (inner[i] != 0) spread(strips_[i], static_cast<std::uint32_t>(group_of(i)));
  }
}

SeamVertex JoinedStrips::name_of(std::uint32_t vertex) const {
  const auto next = std::upper_bound(
      strips_.begin(), strips_.end(), vertex,
      [](std::uint32_t wanted, const Strip& strip) { return wanted < strip.first_vertex; });
  const auto piece = static_cast<std::uint32_t>(next - strips_.begin() - 1);
  return {piece, vertex - strips_[piece].first_vertex};
}

std::uint32_t JoinedStrips::vertex_of(const SeamVertex& name) const {
  const std::size_t next = name.piece + std::size_t{1};
  if (next <= strips_.size()) {
    const std::uint32_t first = strips_[name.piece].first_vertex;
    const std::size_t end =
        next < strips_.size() ? strips_[next].first_vertex : mesh().positions.size();
    if (name.vertex < end - first) return first + name.vertex;
  }
  throw DataError("a gap names a vertex of a strip that is not there");
}

void JoinedStrips::stitch(const JobContext& context, const std::vector<std::uint8_t>& near,
                          SeamTriangles& seams) {
  Stitcher stitcher(parameters_.all_parts);
  Strip next;
  for (std::size_t i = 0; i < near.size(); ++i) {
    const SeamParameters::Strip& each = parameters_.strips[i];
    next.end_triangle = next.first_triangle;
    strips_.push_back(next);
    if (near[i] == 0) {
      stitcher.skip(each.parts);
      continue;
    }
    const PieceStrip strip = decode_strip(read_section(context, each.ref), each.ref.file.name);
    positions_ = strip.mesh.positions;
    stitcher.add(strip.mesh, each.parts);
    for (const std::uint32_t v : strip.shared) shared_.push_back(next.first_vertex + v);
    dropped_.resize(next.first_vertex + strip.mesh.mesh.positions.size(), 0);
    for (const std::uint32_t v : strip.dropped) dropped_[next.first_vertex + v] = 1;
    next.first_vertex += static_cast<std::uint32_t>(strip.mesh.mesh.positions.size());
    next.first_triangle += static_cast<std::uint32_t>(strip.mesh.mesh.triangles.size());
    strips_.back().end_triangle = next.first_triangle;
  }
  SeamTriangles::Some between = seams.at(near);
  between.columns.keep(parameters_.weigh.lines.columns);
  stitched_ = stitcher.finish(between.triangles, between.columns);
}

/// A corner of triangles of several groups belongs to the first of these groups.
void JoinedStrips::begin_groups() {
  for (const Triangle& t : boundary_triangles()) {
    std::uint32_t piece = UINT32_MAX;
    for (const std::uint32_t v : t) piece = std::min(piece, name_of(v).piece);
    const auto group = static_cast<std::uint32_t>(group_of(piece));
    for (const std::uint32_t v : t) group_[v] = std::min(group_[v], group);
  }
}

/// Spreads groups from the seams ring by ring; vertices not reached belong to the piece's own
/// group.
void JoinedStrips::spread(const Strip& strip, std::uint32_t own) {
  const std::span<const Triangle> triangles =
      std::span(mesh().triangles).first(strip.end_triangle).subspan(strip.first_triangle);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> reached;
  do {
    reached.clear();
    for (const auto& [a, b, c] : triangles) {
      const std::uint32_t group = std::min({group_[a], group_[b], group_[c]});
      if (group == k_no_group) continue;
      for (const std::uint32_t v : {a, b, c}) {
        if (group_[v] == k_no_group) reached.emplace_back(v, group);
      }
    }
    for (const auto& [v, group] : reached) group_[v] = std::min(group_[v], group);
  } while (!reached.empty());
  const auto number = static_cast<std::size_t>(&strip - strips_.data());
  const std::size_t end =
      number + 1 < strips_.size() ? strips_[number + 1].first_vertex : mesh().positions.size();
  for (std::size_t v = strip.first_vertex; v < end; ++v) {
    if (group_[v] == k_no_group) group_[v] = own;
  }
}

}  // namespace meshfarm
