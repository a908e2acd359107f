// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A job has all that its group's seams touch: the strips of their pieces, and those of the pieces
// next to these, as triangles of the group may have a corner there. So a job's memory is that of
// some neighbouring pieces' strips, however many pieces there are.
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/regions.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/stitch/stitcher.hpp>
#include <meshfarm/util/byte_lists.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/piece_sections.hpp"

namespace meshfarm {
namespace {

constexpr std::uint32_t k_no_group = UINT32_MAX;

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

/// The strips that a group has to do with, joined by the triangles between them: those of the input
/// come last.
class JoinedStrips {
 public:
  JoinedStrips(const SeamParameters& parameters, const JobContext& context)
      : parameters_(parameters) {
    SeamTriangles seams(parameters, context);
    std::vector<std::uint8_t> own(parameters.strips.size(), 0);
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = group_of(i) == parameters.group ? 1 : 0;
    const std::vector<std::uint8_t> inner = seams.with_neighbours(std::move(own));
    const std::vector<std::uint8_t> near = seams.with_neighbours(inner);
    stitch(context, near, seams.at(near));
    group_.assign(mesh().positions.size(), k_no_group);
    begin_groups();
    for (std::size_t i = 0; i < inner.size(); ++i) {
      if (inner[i] != 0) spread(strips_[i], static_cast<std::uint32_t>(group_of(i)));
    }
  }

  const Mesh& mesh() const { return stitched_.mesh; }
  /// Of a component that is left out. In the strips there is nothing of it, but between them.
  bool is_dropped(const Triangle& t) const {
    return std::any_of(t.begin(), t.end(), [this](std::uint32_t v) { return dropped_[v] != 0; });
  }
  bool is_ours(std::uint32_t vertex) const { return group_[vertex] == parameters_.group; }
  /// Of the input.
  std::span<const Triangle> boundary_triangles() const {
    return std::span(mesh().triangles).last(stitched_.boundary_triangles);
  }
  SeamVertex name_of(std::uint32_t vertex) const {
    const auto next = std::upper_bound(
        strips_.begin(), strips_.end(), vertex,
        [](std::uint32_t wanted, const Strip& strip) { return wanted < strip.first_vertex; });
    const auto piece = static_cast<std::uint32_t>(next - strips_.begin() - 1);
    return {piece, vertex - strips_[piece].first_vertex};
  }
  /// Corners of gaps, in the order of the pieces.
  const std::vector<std::uint32_t>& shared() const { return shared_; }
  PositionType positions() const { return positions_; }

 private:
  struct Strip {
    std::uint32_t first_vertex = 0;
    std::uint32_t first_triangle = 0;
    std::uint32_t end_triangle = 0;
  };

  std::uint64_t group_of(std::size_t piece) const {
    return piece * parameters_.groups / parameters_.strips.size();
  }

  void stitch(const JobContext& context, const std::vector<std::uint8_t>& near,
              SeamTriangles::Some seams) {
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
    seams.columns.keep(parameters_.weigh.lines.columns);
    stitched_ = stitcher.finish(seams.triangles, seams.columns);
  }

  /// A corner of triangles of several groups is of the first of them.
  void begin_groups() {
    for (const Triangle& t : boundary_triangles()) {
      std::uint32_t piece = UINT32_MAX;
      for (const std::uint32_t v : t) piece = std::min(piece, name_of(v).piece);
      const auto group = static_cast<std::uint32_t>(group_of(piece));
      for (const std::uint32_t v : t) group_[v] = std::min(group_[v], group);
    }
  }

  /// From the seams ring by ring; what is not reached is of the piece's own group.
  void spread(const Strip& strip, std::uint32_t own) {
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
    const std::size_t number = static_cast<std::size_t>(&strip - strips_.data());
    const std::size_t end =
        number + 1 < strips_.size() ? strips_[number + 1].first_vertex : mesh().positions.size();
    for (std::size_t v = strip.first_vertex; v < end; ++v) {
      if (group_[v] == k_no_group) group_[v] = own;
    }
  }

  const SeamParameters& parameters_;
  StitchedMesh stitched_;
  std::vector<Strip> strips_;
  std::vector<std::uint32_t> shared_;
  std::vector<std::uint8_t> dropped_;  // a flag a vertex
  std::vector<std::uint32_t> group_;
  PositionType positions_ = PositionType::float32;
};

/// What of the joined strips is the group's.
struct GroupMesh {
  Mesh mesh;
  std::vector<SeamVertex> shared;  // its first vertices
  PieceGap gap;                    // the triangles whose first corner is the group's come first
  std::uint64_t gap_triangles = 0;
  Mesh between;
};

class GroupMaker {
 public:
  explicit GroupMaker(const JoinedStrips& strips)
      : strips_(strips), number_(strips.mesh().positions.size(), k_left_out) {}

  GroupMesh make() {
    share();
    auto count = static_cast<std::uint32_t>(made_.shared.size());
    for (std::uint32_t v = 0; v < number_.size(); ++v) {
      if (number_[v] == k_left_out && strips_.is_ours(v)) number_[v] = count++;
    }
    place_vertices(VertexView(strips_.mesh()), number_, count, made_.mesh);
    const Mesh& all = strips_.mesh();
    for (std::size_t i = 0; i < all.triangles.size(); ++i) {
      if (ours_of(all.triangles[i]) != 3 || strips_.is_dropped(all.triangles[i])) continue;
      made_.mesh.triangles.push_back(all.triangles[i]);
      made_.mesh.columns.append(all.columns, i);
    }
    renumber_corners(made_.mesh.triangles, number_);
    make_gap();
    std::vector<Triangle> between;
    for (const Triangle& t : strips_.boundary_triangles()) {
      if (strips_.is_ours(t[0])) between.push_back(t);
    }
    made_.between = surface_of(strips_.mesh(), between);
    return std::move(made_);
  }

 private:
  int ours_of(const Triangle& t) const {
    return static_cast<int>(
        std::count_if(t.begin(), t.end(), [this](std::uint32_t v) { return strips_.is_ours(v); }));
  }
  bool is_between_groups(const Triangle& t) const {
    const int ours = ours_of(t);
    return (ours == 1 || ours == 2) && !strips_.is_dropped(t);
  }

  void share(std::uint32_t v) {
    if (!strips_.is_ours(v) || number_[v] != k_left_out) return;
    number_[v] = static_cast<std::uint32_t>(made_.shared.size());
    made_.shared.push_back(strips_.name_of(v));
  }

  /// The corners of gaps with pieces, and with other groups.
  void share() {
    for (const std::uint32_t v : strips_.shared()) share(v);
    for (const Triangle& t : strips_.mesh().triangles) {
      if (!is_between_groups(t)) continue;
      for (const std::uint32_t v : t) share(v);
    }
  }

  void make_gap() {
    std::vector<std::uint32_t> place = number_;
    const auto add = [&](const Triangle& t) {
      Triangle& added = made_.gap.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t& at = place[t[k]];
        if (at == k_left_out) {
          at = static_cast<std::uint32_t>(made_.shared.size() + made_.gap.positions.size());
          made_.gap.positions.push_back(strips_.mesh().positions[t[k]]);
          made_.gap.vertices.push_back(strips_.name_of(t[k]));
        }
        added[k] = at;
      }
    };
    const Mesh& all = strips_.mesh();
    for (const bool wanted : {true, false}) {
      for (std::size_t i = 0; i < all.triangles.size(); ++i) {
        const Triangle& t = all.triangles[i];
        if (!is_between_groups(t) || strips_.is_ours(t[0]) != wanted) continue;
        add(t);
        made_.gap.columns.append(all.columns, i);
      }
      if (wanted) made_.gap_triangles = made_.gap.triangles.size();
    }
  }

  const JoinedStrips& strips_;
  std::vector<std::uint32_t> number_;
  GroupMesh made_;
};

Box box_of_group(const GroupMesh& group) {
  Box box;
  for (const auto* positions :
       {&group.mesh.positions, &group.gap.positions, &group.between.positions}) {
    for (const Vec3& p : *positions) box.add(p);
  }
  return box;
}

}  // namespace

JobOutput join_seams(const Job& job, const JobContext& context) {
  const SeamParameters parameters = decode_seam_parameters(job.parameters);
  std::optional<JoinedStrips> strips(std::in_place, parameters, context);
  GroupMesh group = GroupMaker(*strips).make();
  const PositionType positions = strips->positions();
  strips.reset();
  PieceFile file;
  DividedPiece made;
  made.box = box_of_group(group);
  made.strip_triangles = group.between.triangles.size();
  made.shared = group.shared.size();
  made.gap_triangles = group.gap_triangles;
  const auto wanted = static_cast<std::uint64_t>(
      std::ceil(parameters.samples_per_triangle * static_cast<double>(made.strip_triangles)));
  std::vector<SurfaceSamples> samples;
  if (wanted > 0)
    samples.push_back(sample_surface(group.between, {.samples = wanted, .threads = 1}));
  made.samples = file.add(encode_samples(samples));
  made.between = file.add(encode_surface(group.between));
  made.gap = file.add(encode_gap(group.gap));
  made.strip = file.add(encode_list(group.shared));
  file.add_weighed(weigh(std::move(group.mesh), static_cast<std::uint32_t>(made.shared), positions,
                         parameters.weigh, context),
                   made);
  return file.publish(job, context, encode_summary(made));
}

}  // namespace meshfarm
