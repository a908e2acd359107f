// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdint>

#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/finished_pieces.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>
#include <meshfarm/pipeline/sink_need.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/bake_stage.hpp"
#include "pipeline/texture_bake.hpp"

namespace meshfarm {
namespace {

/// The maximum for a Simplifier.
constexpr std::uint64_t k_most_triangles = UINT32_MAX / 3 - 1;
/// The stitched mesh and its simplifier: measured, of the whole process, 140 to 180.
constexpr std::uint64_t k_bytes_per_triangle = 180;
constexpr std::uint64_t k_process_bytes = std::uint64_t{32} << 20;

std::string counted(std::uint64_t triangles) {
  return triangles < 10'000'000 ? std::to_string(triangles)
                                : std::to_string(triangles / 1'000'000) + " million";
}

/// The result with its charts, then the picture as it is put together.
std::uint64_t bytes_of_bake(const RunOptions& options, double triangles) {
  constexpr double k_bytes_per_charted_triangle = 350;
  constexpr double k_bytes_per_texel = 22;
  const double side = options.texture_size != 0 ? options.texture_size : k_most_chosen_side;
  return static_cast<std::uint64_t>(k_bytes_per_charted_triangle * triangles +
                                    k_bytes_per_texel * side * side);
}

/// For a finish in pieces, which holds the result while attributes are fitted to it.
SinkNeed need_of_pieces(const Manifest& manifest, const RunOptions& options) {
  constexpr std::uint64_t k_held_bytes = 90;
  constexpr std::uint64_t k_bytes_of_channel = 40;
  const std::uint64_t triangles =
      std::min(manifest.triangles(), target_triangles(manifest, options));
  const std::uint64_t channels = chosen_columns(manifest, options).size();
  return {triangles, k_process_bytes + (k_held_bytes + k_bytes_of_channel * channels) * triangles};
}

}  // namespace

std::optional<SinkNeed> sink_need(const Manifest& manifest, const RunOptions& options) {
  if (options.error.value > 0) return std::nullopt;
  const auto all = static_cast<double>(manifest.triangles());
  const auto target = static_cast<double>(target_triangles(manifest, options));
  // All parts use the last level with enough triangles: it has up to one step too many.
  const double times = options.allocation == Allocation::uniform
                           ? 1.0
                           : k_level_step * provision(std::min(1.0, target / std::max(1.0, all)));
  const double stitched =
      std::min(all, times * target + static_cast<double>(manifest.boundary_triangles));
  const auto triangles = static_cast<std::uint64_t>(stitched);
  std::uint64_t bytes = k_bytes_per_triangle * triangles;
  if (bakes_texture(manifest, options)) bytes = std::max(bytes, bytes_of_bake(options, target));
  return SinkNeed{triangles, k_process_bytes + bytes};
}

std::string check_sink_need(const Manifest& manifest, const RunOptions& options,
                            std::optional<std::uint64_t> free_bytes) {
  auto need = sink_need(manifest, options);
  if (!need) return {};
  if (why_finish_here(manifest, options).empty()) {
    if (!has_attributes(manifest)) return {};
    need = need_of_pieces(manifest, options);
  }
  // At least the target is stitched, whatever the levels are.
  const std::uint64_t least = std::min(manifest.triangles(), target_triangles(manifest, options));
  if (least > k_most_triangles) {
    throw UsageError("a result of " + counted(least) +
                     " triangles is too large: the sink holds at most " +
                     counted(k_most_triangles) + "; ask for fewer");
  }
  if (need->triangles > k_most_triangles) {
    return "the sink may have to stitch " + counted(need->triangles) +
           " triangles and can hold at most " + counted(k_most_triangles) +
           ": it may fail at the end; ask for fewer";
  }
  if (!free_bytes || need->bytes <= *free_bytes) return {};
  return "the sink will take about " + std::to_string(need->bytes >> 20) + " MiB, but only " +
         std::to_string(*free_bytes >> 20) +
         " MiB are free here: run it where there is more memory, or ask for fewer triangles";
}

}  // namespace meshfarm
