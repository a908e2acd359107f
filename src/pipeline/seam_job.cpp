// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A job reads all that its group's seams touch: the strips of their pieces, and those of the pieces
// next to these, as triangles of the group may have a corner there. So a job's memory is that of a
// few neighbouring pieces' strips, however many pieces there are.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/util/byte_lists.hpp>

#include "pipeline/bounded_group.hpp"
#include "pipeline/joined_strips.hpp"
#include "pipeline/piece_sections.hpp"

namespace meshfarm {
namespace {

/// The group's part of the joined strips.
struct GroupMesh {
  Mesh mesh;
  std::vector<SeamVertex> shared;  // its first vertices
  PieceGap gap;                    // triangles whose first corner is the group's come first
  std::uint64_t gap_triangles = 0;
  Mesh between;
  std::vector<std::uint32_t> number;  // of the strips' vertices in the mesh, or k_left_out
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
      if (strips_.ours_of(all.triangles[i]) != 3 || strips_.is_dropped(all.triangles[i])) continue;
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
    made_.number = std::move(number_);
    return std::move(made_);
  }

 private:
  bool is_between_groups(const Triangle& t) const {
    const int ours = strips_.ours_of(t);
    return (ours == 1 || ours == 2) && !strips_.is_dropped(t);
  }

  void share(std::uint32_t v) {
    if (!strips_.is_ours(v) || number_[v] != k_left_out) return;
    number_[v] = static_cast<std::uint32_t>(made_.shared.size());
    made_.shared.push_back(strips_.name_of(v));
  }

  /// Shares the corners of gaps to pieces and to other groups.
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

/// Simplifies as far as the bound allows.
WeighedMesh bounded(GroupMesh group, const JoinedStrips& strips, const SeamParameters& parameters,
                    const JobContext& context) {
  const auto shared = static_cast<std::uint32_t>(group.shared.size());
  WeighedMesh made;
  made.weight.before = group.mesh.triangles.size();
  const BoundedFinish finish = simplify_group(
      {std::move(group.mesh), shared, std::move(group.number)}, strips, parameters, context);
  made.ladder = encode_piece(finish.mesh, shared, strips.positions());
  made.rungs = {finish.mesh.triangles.size()};
  made.dropped_degenerate = finish.dropped_degenerate;
  made.dropped_duplicate = finish.dropped_duplicate;
  made.turned = finish.turned;
  return made;
}

/// The group weighed, or simplified if a bound decides how far.
WeighedMesh finished(GroupMesh group, std::optional<JoinedStrips> strips,
                     const SeamParameters& parameters, const JobContext& context) {
  if (parameters.bound) return bounded(std::move(group), *strips, parameters, context);
  const PositionType positions = strips->positions();
  strips.reset();
  return weigh(std::move(group.mesh), static_cast<std::uint32_t>(group.shared.size()), positions,
               parameters.weigh, context);
}

}  // namespace

JobOutput join_seams(const Job& job, const JobContext& context) {
  const SeamParameters parameters = decode_seam_parameters(job.parameters);
  std::optional<JoinedStrips> strips(std::in_place, parameters, context);
  GroupMesh group = GroupMaker(*strips).make();
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
  const SplitSamples split = split_samples(std::move(samples), parameters.weigh.samples);
  made.samples = file.add(encode_samples(split.measured));
  made.between = file.add(encode_surface(group.between));
  made.gap = file.add(encode_gap(group.gap));
  made.strip = file.add(encode_list(group.shared));
  file.add_weighed(finished(std::move(group), std::move(strips), parameters, context), made);
  return file.publish(job, context, encode_summary(made));
}

}  // namespace meshfarm
