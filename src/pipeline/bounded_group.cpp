// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/bounded_group.hpp"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/input_surface.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/bound_proof.hpp"
#include "pipeline/piece_sections.hpp"

namespace meshfarm {
namespace {

/// The manifest as earlier jobs have cut it, if they have.
Manifest read_manifest(const JobContext& context, const GroupBound& bound) {
  Manifest manifest = decode_manifest(context.stage.read(ManifestName{}), "the manifest");
  if (!bound.bundles) return manifest;
  manifest.cutting.reset();
  manifest.parts.resize(bound.bundles->parts);
  manifest.bundles = bound.bundles;
  return manifest;
}

class GroupFinish {
 public:
  GroupFinish(GroupToBound group, const JoinedStrips& strips, const SeamParameters& parameters,
              const JobContext& context)
      : strips_(strips),
        parameters_(parameters),
        context_(context),
        shared_(group.shared),
        number_(std::move(group.number)),
        pieces_(pieces_of_group()) {
    mesh_ = std::move(group.mesh);
    of_group_ = static_cast<std::uint32_t>(mesh_.positions.size());
    before_ = mesh_.triangles.size();
    options_ = {.max_error = parameters.bound->max_error,
                .certified_error = parameters.bound->certified_error,
                .positions = strips.positions(),
                .lines = parameters.weigh.lines,
                .threads = 1,
                .progress = [this](std::uint64_t left) {
                  if (context_.progress(before_ - std::min(left, before_))) return;
                  throw IncompleteError("the job was given up");
                }};
  }

  BoundedFinish run() {
    SeamMesh alone;
    alone.mesh = std::move(mesh_);
    alone.locked = shared_;
    Mesh input = input_near(cells_round_changes(alone, options_));
    mesh_ = std::move(alone.mesh);
    if (!input.triangles.empty()) {
      const double reach = std::max(options_.max_error, options_.certified_error);
      const NearCells near(input.positions, input.triangles, reach);
      add_strips(near);
      for (std::size_t piece = 0; piece < pieces_.size(); ++piece) {
        if (pieces_[piece] != 0) add_piece(piece, near);
      }
    }
    SeamMesh seams = with_surroundings();
    const std::uint32_t end = seams.locked;
    BoundedFinish finish = simplify_seams(std::move(seams), std::move(input), options_);
    keep_group(end, finish.mesh);
    return finish;
  }

 private:
  /// Flags the pieces that the group has vertices of.
  std::vector<std::uint8_t> pieces_of_group() const {
    std::vector<std::uint8_t> pieces(parameters_.strips.size(), 0);
    for (std::uint32_t v = 0; v < number_.size(); ++v) {
      if (number_[v] != k_left_out) pieces[strips_.name_of(v).piece] = 1;
    }
    return pieces;
  }

  /// The input of the group's parts and between them.
  Mesh input_near(const NearCells& near) const {
    std::vector<std::uint32_t> parts;
    std::uint32_t part = 0;
    for (std::size_t piece = 0; piece < pieces_.size(); ++piece) {
      for (std::uint32_t i = 0; i < parameters_.strips[piece].parts; ++i, ++part) {
        if (pieces_[piece] != 0) parts.push_back(part);
      }
    }
    Mesh input;
    const Manifest manifest = read_manifest(context_, *parameters_.bound);
    InputSurface::show_parts(context_.stage, manifest, parts, [&](const SurfacePiece& piece) {
      add_near(piece.positions, piece.triangles, near, input);
      options_.progress(before_);
    });
    std::vector<Triangle> between;
    const auto all = strips_.boundary_triangles();
    std::copy_if(all.begin(), all.end(), std::back_inserter(between),
                 [&](const Triangle& t) { return strips_.ours_of(t) > 0; });
    add_near(strips_.mesh().positions, between, near, input);
    return input;
  }

  std::uint32_t place_of(std::uint32_t strip_vertex) {
    std::uint32_t& at = number_[strip_vertex];
    if (at == k_left_out) {
      at = static_cast<std::uint32_t>(mesh_.positions.size());
      append_vertex(VertexView(strips_.mesh()), strip_vertex, mesh_);
    }
    return at;
  }

  /// Adds what other groups may change, and the triangles between.
  void add_strips(const NearCells& near) {
    const Mesh& all = strips_.mesh();
    for (const std::uint32_t i : near.touching(all.positions, all.triangles)) {
      const Triangle& t = all.triangles[i];
      if (strips_.ours_of(t) == 3 || strips_.is_dropped(t)) continue;
      mesh_.triangles.push_back({place_of(t[0]), place_of(t[1]), place_of(t[2])});
      mesh_.columns.append(all.columns, i);
    }
    end_of_strips_ = static_cast<std::uint32_t>(mesh_.positions.size());
  }

  /// Adds what stays in a piece, and its gap: nobody changes these any more.
  void add_piece(std::size_t number, const NearCells& near) {
    const SeamParameters::Strip& strip = parameters_.strips[number];
    const std::string& name = strip.ref.file.name;
    const ResultMesh piece =
        decode_result(read_section(context_, {strip.ref.file, strip.mesh}), 0, name);
    const PieceGap gap = decode_gap(read_section(context_, {strip.ref.file, strip.gap}), name);
    const Mesh& inner = piece.mesh;
    std::vector<std::uint32_t> places(inner.positions.size(), k_left_out);
    const auto place_inside = [&](std::uint32_t v) {
      if (places[v] == k_left_out) {
        places[v] = static_cast<std::uint32_t>(mesh_.positions.size());
        append_vertex(VertexView(inner), v, mesh_);
      }
      return places[v];
    };
    for (const std::uint32_t i : near.touching(inner.positions, inner.triangles)) {
      const auto& [a, b, c] = inner.triangles[i];
      mesh_.triangles.push_back({place_inside(a), place_inside(b), place_inside(c)});
      mesh_.columns.append(inner.columns, i);
    }
    const std::uint32_t shared = piece.boundary_vertices;
    for (std::size_t i = 0; i < gap.triangles.size(); ++i) {
      Box box;
      for (const std::uint32_t v : gap.triangles[i]) {
        if (v >= shared + gap.positions.size()) throw DataError(name + ": impossible gap");
        box.add(v < shared ? inner.positions[v] : gap.positions[v - shared]);
      }
      if (!near.touch(box)) continue;
      Triangle& added = mesh_.triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = gap.triangles[i][k];
        added[k] =
            v < shared ? place_inside(v) : place_of(strips_.vertex_of(gap.vertices[v - shared]));
      }
      mesh_.columns.append(gap.columns, i);
    }
  }

  /// The vertices that stay: first the shared ones, then those of strips, then those of pieces.
  SeamMesh with_surroundings() {
    SeamMesh seams;
    std::vector<std::uint8_t> flags(mesh_.positions.size(), 0);
    std::fill(flags.begin() + shared_, flags.begin() + of_group_, std::uint8_t{1});
    seams.mesh = std::move(mesh_);
    seams.locked = put_last(seams.mesh, flags);
    seams.kept = shared_;
    seams.first_unsure = shared_;
    seams.end_unsure = shared_ + std::max(end_of_strips_, of_group_) - of_group_;
    return seams;
  }

  /// Drops the vertices of the surroundings: those before `end` that are not shared.
  void keep_group(std::uint32_t end, Mesh& mesh) const {
    std::vector<std::uint32_t> number(mesh.positions.size(), k_left_out);
    std::uint32_t count = 0;
    for (std::uint32_t v = 0; v < number.size(); ++v) {
      if (v < shared_ || v >= end) number[v] = count++;
    }
    Mesh kept;
    place_vertices(VertexView(mesh), number, count, kept);
    keep_triangles(mesh, [&](std::size_t i) {
      const Triangle& t = mesh.triangles[i];
      return std::all_of(t.begin(), t.end(),
                         [&](std::uint32_t v) { return number[v] != k_left_out; });
    });
    kept.triangles = std::move(mesh.triangles);
    kept.columns = std::move(mesh.columns);
    renumber_corners(kept.triangles, number);
    mesh = std::move(kept);
  }

  const JoinedStrips& strips_;
  const SeamParameters& parameters_;
  const JobContext& context_;
  std::uint32_t shared_;
  std::vector<std::uint32_t> number_;  // of the strips' vertices
  std::vector<std::uint8_t> pieces_;   // flags
  Mesh mesh_;                          // the group's, later with its surroundings
  std::uint32_t of_group_ = 0;         // the first vertices
  std::uint32_t end_of_strips_ = 0;    // those of other groups come after of_group_
  std::uint64_t before_ = 0;           // the group's triangles
  BoundedFinishOptions options_;
};

}  // namespace

BoundedFinish simplify_group(GroupToBound group, const JoinedStrips& strips,
                             const SeamParameters& parameters, const JobContext& context) {
  return GroupFinish(std::move(group), strips, parameters, context).run();
}

}  // namespace meshfarm
