// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <meshfarm/pipeline/finished_pieces.hpp>
#include <meshfarm/pipeline/sink_need.hpp>

#include "pipeline/bake_stage.hpp"

namespace meshfarm {
namespace {

/// Up to this many stitched triangles the sink finishes sooner by itself.
constexpr std::uint64_t k_comfortable = 20'000'000;

/// Margin of the boxes: a fraction of their diagonals, but at most this many sides of the result's
/// triangles. By their diagonals, most of many slabs, which are long and thin, would be near each
/// other.
constexpr double k_margin_of_boxes = 0.05;
constexpr double k_margin_in_sides = 32;

double side_of_triangles(const FinishedPiece& piece) {
  const auto triangles = static_cast<double>(std::max<std::uint64_t>(1, piece.triangles));
  return std::sqrt(2 * piece.area / triangles);
}

bool touch(const PieceOfResult& one, const PieceOfResult& other) {
  const Box& a = one.divided.box;
  const Box& b = other.divided.box;
  const double sides = side_of_triangles(one.finished) + side_of_triangles(other.finished);
  const double margin =
      std::min(k_margin_of_boxes * (a.diagonal() + b.diagonal()), k_margin_in_sides * sides);
  const auto meet = [margin](double a_lo, double a_hi, double b_lo, double b_hi) {
    return a_lo <= b_hi + margin && b_lo <= a_hi + margin;
  };
  return meet(a.lo.x, a.hi.x, b.lo.x, b.hi.x) && meet(a.lo.y, a.hi.y, b.lo.y, b.hi.y) &&
         meet(a.lo.z, a.hi.z, b.lo.z, b.hi.z);
}

std::string why_not_farmed(const Manifest& manifest, const RunOptions& options) {
  if (options.finish == Finish::boundary) return "only edges at seams are to change";
  if (options.allocation == Allocation::uniform) return "the parts have no common threshold";
  if (options.error.value > 0 && options.lines.topology == TopologyMode::simplify) {
    return "under a bound the topology is given up in the whole";
  }
  if (bakes_texture(manifest, options)) return "a new texture is laid out on the whole result";
  return {};
}

}  // namespace

void add_share(const PieceError& more, PieceError& error) {
  const double area = error.input_area + more.input_area;
  error.input_samples += more.input_samples;
  error.to_output.max = std::max(error.to_output.max, more.to_output.max);
  if (!(more.input_area > 0)) return;
  const auto mean = [&](double a, double b) {
    return (a * error.input_area + b * more.input_area) / area;
  };
  const Distance& d = more.to_output;
  error.to_output.rms = std::sqrt(mean(error.to_output.rms * error.to_output.rms, d.rms * d.rms));
  error.to_output.mean = mean(error.to_output.mean, d.mean);
  error.input_area = area;
}

std::string why_finish_here(const Manifest& manifest, const RunOptions& options) {
  if (options.finish_place == FinishPlace::here) return "it is asked for";
  std::string why = why_not_farmed(manifest, options);
  if (!why.empty() || options.finish_place == FinishPlace::farm) return why;
  const auto need = sink_need(manifest, options);
  if ((need ? need->triangles : manifest.triangles()) > k_comfortable) return {};
  return k_sink_holds_it;
}

bool holds_well(const RunOptions& options, std::uint64_t triangles) {
  return options.error.value > 0 && options.finish_place == FinishPlace::automatic &&
         triangles <= k_comfortable;
}

bool has_attributes(const Manifest& manifest) {
  return !manifest.channels.channels.empty() || manifest.labels || manifest.uvs;
}

std::vector<std::size_t> FinishedPieces::near(std::size_t piece) const {
  std::vector<std::size_t> near;
  if (pieces[piece].parts == 0) return near;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i == piece) continue;
    if (touch(pieces[i], pieces[piece])) near.push_back(i);
  }
  return near;
}

std::vector<std::size_t> FinishedPieces::seams_near(std::size_t piece) const {
  std::vector<std::size_t> near;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i == piece || pieces[i].parts > 0) continue;
    if (touch(pieces[i], pieces[piece])) near.push_back(i);
  }
  return near;
}

std::uint64_t FinishedPieces::triangles() const {
  std::uint64_t sum = 0;
  for (const PieceOfResult& each : pieces) {
    sum += each.finished.triangles + each.divided.gap_triangles;
  }
  return sum;
}

std::uint64_t FinishedPieces::vertices() const {
  std::uint64_t sum = 0;
  for (const PieceOfResult& each : pieces) sum += each.finished.vertices;
  return sum;
}

}  // namespace meshfarm
