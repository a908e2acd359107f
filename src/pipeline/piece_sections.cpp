// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Sections of the files of a farmed finish, little endian; counts are u32:
//   gap     = surface | vertices x (piece u32 | vertex u32) | labels x u32 |
//             texture coordinates x 6 x f32: of each triangle, or none
//   strip   = result, a string | shared x u32 | dropped x u32
//   samples = sets x (area f64 | points x 3 x f64)
//   surface = positions x 3 x f64 | triangles x 3 x u32;  points = points x 3 x f64
//   shared  = vertices x (piece u32 | vertex u32);  vertices = vertices x u32
// A piece's mesh is a result (result_file.cpp).
#include "pipeline/piece_sections.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/util/byte_lists.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// Weighing ends after this many steps without a change: little is left to collapse, or it is
/// refused.
constexpr std::int32_t k_idle_steps = 12;
constexpr std::int32_t k_most_weigh_steps = 240;
/// A reduction by less than this fraction of the triangles is not worth a rung.
constexpr std::uint64_t k_worth_a_rung = 8;
/// A first step by count finds the cost to begin at.
constexpr std::uint64_t k_first_share = 20;

std::int32_t step_of(double cost, double unit) {
  std::int32_t step = 0;
  while (step < k_most_weigh_steps && step_cost(step, unit) < cost) ++step;
  return step;
}

ResultWriter::Vertices vertices_of(const Mesh& mesh, std::uint32_t locked, PositionType positions) {
  return {positions, !mesh.appearances.empty(), locked, mesh.columns.set()};
}

class Weighing {
 public:
  Weighing(Mesh mesh, std::uint32_t locked, PositionType positions,
           const WeighParameters& parameters, const JobContext& context)
      : locked_(locked),
        parameters_(parameters),
        context_(context),
        before_(mesh.triangles.size()),
        simplifier_(std::move(mesh), {.locked_vertices = locked,
                                      .positions = positions,
                                      .lines = parameters.lines,
                                      .was_simplified = true}),
        ladder_(vertices_of(simplifier_.mesh(), locked, positions),
                [this](std::string_view bytes) { made_.ladder += bytes; }) {}

  WeighedMesh run() {
    snapshot();
    made_.weight.before = simplifier_.triangles();
    made_.weight.has_open_border = simplifier_.has_free_border();
    if (!parameters_.is_weighed) return finished();
    const std::int32_t first = parameters_.first_step >= 0 ? parameters_.first_step : find_step();
    made_.weight.first_step = first;
    climb(first);
    return finished();
  }

 private:
  WeighedMesh finished() {
    ladder_.finish(VertexView(simplifier_.mesh()).part(0, locked_), {});
    made_.dropped_degenerate = simplifier_.dropped_degenerate();
    made_.dropped_duplicate = simplifier_.dropped_duplicate();
    made_.turned = simplifier_.turned();
    return std::move(made_);
  }

  std::int32_t find_step() {
    const std::uint64_t triangles = simplifier_.triangles();
    reduce({.triangles = triangles - triangles / k_first_share});
    return step_of(simplifier_.pass_cost(), parameters_.cost_unit);
  }

  void climb(std::int32_t step) {
    std::uint64_t last = 0;
    std::uint64_t kept = 0;
    std::int32_t idle = 0;
    for (; step < k_most_weigh_steps && idle < k_idle_steps; ++step) {
      const std::uint64_t before = simplifier_.triangles();
      reduce({.max_cost = step_cost(step, parameters_.cost_unit)});
      const std::uint64_t left = simplifier_.triangles();
      if (made_.weight.counts.empty()) {
        last = share_of(left, parameters_.last_share);
        kept = share_of(left, parameters_.kept_share);
      }
      made_.weight.counts.push_back(left);
      if (left <= last) return;
      const bool is_much_less = left < before_ - before_ / k_worth_a_rung;
      if (left <= kept && is_much_less && ladder_.rungs().size() == 1) snapshot();
      idle = left < before ? 0 : idle + 1;
    }
  }

  static std::uint64_t share_of(std::uint64_t triangles, double share) {
    return static_cast<std::uint64_t>(share * static_cast<double>(triangles));
  }

  void reduce(const SimplifyGoal& goal) {
    bool given_up = false;
    simplifier_.reduce(goal, [&](std::uint64_t left) {
      given_up = !context_.progress(before_ - std::min(left, before_));
      return !given_up;
    });
    if (given_up) throw IncompleteError("the job was given up");
  }

  void snapshot() {
    ladder_.add_rung(static_cast<std::int32_t>(ladder_.rungs().size()), simplifier_.mesh(),
                     simplifier_.free_triangles());
    made_.rungs.push_back(simplifier_.triangles());
  }

  std::uint32_t locked_;
  const WeighParameters& parameters_;
  const JobContext& context_;
  std::uint64_t before_;
  Simplifier simplifier_;
  WeighedMesh made_;
  ResultWriter ladder_;
};

void put_surface(ByteWriter& out, const std::vector<Vec3>& positions,
                 const std::vector<Triangle>& triangles) {
  put_list(out, positions);
  put_list(out, triangles);
}

bool names_others(const std::vector<Triangle>& triangles, std::size_t vertices) {
  return std::any_of(triangles.begin(), triangles.end(), [vertices](const Triangle& t) {
    return *std::max_element(t.begin(), t.end()) >= vertices;
  });
}

}  // namespace

std::string encode_gap(const PieceGap& gap) {
  ByteWriter out;
  put_surface(out, gap.positions, gap.triangles);
  put_list(out, gap.vertices);
  put_list(out, gap.columns.labels);
  put_list(out, gap.columns.uvs);
  return out.take();
}

PieceGap decode_gap(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  PieceGap gap;
  gap.positions = get_list<Vec3>(in);
  gap.triangles = get_list<Triangle>(in);
  gap.vertices = get_list<SeamVertex>(in);
  if (gap.vertices.size() != gap.positions.size()) in.fail("not each position is of a vertex");
  gap.columns.labels = get_list<Label>(in);
  gap.columns.uvs = get_list<CornerUvs>(in);
  const TriangleColumnsView columns = gap.columns;
  if (!columns.fits(columns.set(), gap.triangles.size())) in.fail("columns of other triangles");
  in.expect_end();
  return gap;
}

std::string encode_strip(const PieceStrip& strip) {
  ByteWriter out;
  out.put_string(encode_piece(strip.mesh.mesh, strip.mesh.boundary_vertices, strip.mesh.positions));
  put_list(out, strip.shared);
  put_list(out, strip.dropped);
  return out.take();
}

PieceStrip decode_strip(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  PieceStrip strip;
  strip.mesh = decode_result(in.get_string(), 0, what);
  strip.shared = get_list<std::uint32_t>(in);
  strip.dropped = get_list<std::uint32_t>(in);
  const auto is_none = [&](std::uint32_t v) { return v >= strip.mesh.mesh.positions.size(); };
  for (const auto* list : {&strip.shared, &strip.dropped}) {
    if (std::any_of(list->begin(), list->end(), is_none)) in.fail("no such vertex");
  }
  in.expect_end();
  return strip;
}

std::string encode_samples(const std::vector<SurfaceSamples>& samples) {
  ByteWriter out;
  out.put(static_cast<std::uint32_t>(samples.size()));
  for (const SurfaceSamples& each : samples) {
    out.put(each.area);
    put_list(out, each.points);
  }
  return out.take();
}

std::vector<SurfaceSamples> decode_samples(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  std::vector<SurfaceSamples> samples;
  const auto sets = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < sets; ++i) {
    const auto area = in.get<double>();
    samples.push_back({area, get_list<Vec3>(in)});
  }
  in.expect_end();
  return samples;
}

Mesh surface_of(const Mesh& mesh, std::span<const Triangle> triangles) {
  Mesh surface;
  std::vector<std::uint32_t> number(mesh.positions.size(), k_left_out);
  surface.triangles.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    Triangle& added = surface.triangles.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = t[k];
      if (number[v] == k_left_out) {
        number[v] = static_cast<std::uint32_t>(surface.positions.size());
        surface.positions.push_back(mesh.positions[v]);
      }
      added[k] = number[v];
    }
  }
  return surface;
}

Mesh last_triangles(const StitchedMesh& stitched) {
  const std::span<const Triangle> triangles = stitched.mesh.triangles;
  return surface_of(stitched.mesh, triangles.last(stitched.boundary_triangles));
}

std::string encode_surface(const Mesh& mesh) {
  ByteWriter out;
  put_surface(out, mesh.positions, mesh.triangles);
  return out.take();
}

Mesh decode_surface(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  Mesh surface;
  surface.positions = get_list<Vec3>(in);
  surface.triangles = get_list<Triangle>(in);
  in.expect_end();
  if (names_others(surface.triangles, surface.positions.size())) {
    in.fail("a triangle names a vertex that is not there");
  }
  return surface;
}

std::string read_section(const JobContext& context, const SectionRef& ref) {
  return context.stage.read(ref.file, ref.section);
}

std::string encode_piece(const Mesh& mesh, std::uint32_t locked, PositionType positions) {
  std::string file;
  ResultWriter result(vertices_of(mesh, locked, positions),
                      [&](std::string_view bytes) { file += bytes; });
  result.add_rung(0, mesh, 0);
  result.finish(VertexView(mesh).part(0, locked), {});
  return file;
}

void PieceFile::add_weighed(WeighedMesh weighed, DividedPiece& made) {
  made.mesh = add(weighed.ladder);
  made.rungs = std::move(weighed.rungs);
  made.weight = std::move(weighed.weight);
  made.dropped_degenerate += weighed.dropped_degenerate;
  made.dropped_duplicate += weighed.dropped_duplicate;
  made.turned += weighed.turned;
}

JobOutput PieceFile::publish(const Job& job, const JobContext& context, std::string summary) const {
  const ResultName name{key_of(job).value, context.attempt, context.incarnation};
  return {context.publish(name, file_), std::move(summary)};
}

double step_cost(std::int32_t step, double unit) {
  constexpr double k_root_of_two = 1.41421356237309505;
  return std::ldexp(unit, step / 2) * (step % 2 == 0 ? 1.0 : k_root_of_two);
}

std::uint64_t PieceWeight::at(std::int32_t step) const {
  if (step < first_step || counts.empty()) return before;
  const auto last = static_cast<std::int32_t>(counts.size()) - 1;
  return counts[static_cast<std::size_t>(std::min(step - first_step, last))];
}

bool PieceWeight::can_be_odd() const {
  return has_open_border || std::any_of(counts.begin(), counts.end(), [this](std::uint64_t count) {
           return (before - count) % 2 != 0;
         });
}

WeighedMesh weigh(Mesh mesh, std::uint32_t locked, PositionType positions,
                  const WeighParameters& parameters, const JobContext& context) {
  return Weighing(std::move(mesh), locked, positions, parameters, context).run();
}

}  // namespace meshfarm
