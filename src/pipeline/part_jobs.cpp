// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/part_jobs.hpp"

#include <algorithm>

#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/finished_pieces.hpp>
#include <meshfarm/pipeline/sweep_job.hpp>

#include "pipeline/rung_input.hpp"

namespace meshfarm {
namespace {

/// The unchanged part, its two hierarchies, its sample points, up to five per triangle, and the
/// places of the triangles that were found to be near.
constexpr std::uint64_t k_bound_bytes_per_triangle = 560;

/// For a part that is not built yet: its maximum size in tenths of the average, its bytes per
/// triangle as a file, and the work to build a triangle, as a fraction (1/4) of that to simplify
/// it.
constexpr std::uint64_t k_largest_part = 12;
constexpr std::uint64_t k_part_bytes = 24;
constexpr std::uint64_t k_build_share = 4;
/// To prove the bound: a copy of the part, and a hierarchy of it.
constexpr std::uint64_t k_proof_bytes_per_triangle = 100;

/// Approximate memory of a simplify job: the part's file and its mesh (20 and 40 bytes per
/// triangle), the simplifier (50 to 70), and the ladder, whose rungs shrink by a third or more from
/// each to the next.
std::uint64_t memory_of(const PartEntry& part, std::uint64_t first_rung) {
  constexpr std::uint64_t k_process = std::uint64_t{16} << 20;
  const std::uint64_t ladder = 60 * std::min(part.triangles, first_rung);
  return k_process + part.file.size + 110 * part.triangles + ladder;
}

/// The same when starting from a rung of this many bytes.
std::uint64_t memory_of_rung(std::uint64_t bytes, std::uint64_t triangles) {
  constexpr std::uint64_t k_process = std::uint64_t{16} << 20;
  return k_process + bytes + 170 * triangles;
}

/// The window before and after it is simplified, and the triangles sent on from it.
std::uint64_t memory_of_sweep(std::uint64_t window_triangles) {
  constexpr std::uint64_t k_process = std::uint64_t{16} << 20;
  return k_process + 150 * window_triangles;
}

}  // namespace

std::uint64_t memory_to_build(std::uint64_t average_triangles) {
  PartEntry likely;
  likely.triangles = k_largest_part * average_triangles / 10;
  likely.file.size = k_part_bytes * likely.triangles;
  return memory_of(likely, likely.triangles);
}

Extent extent_of_part(std::uint32_t part, std::uint64_t bytes) {
  return extent_named("part", part, bytes);
}

PartJobs::PartJobs(const Manifest& manifest, const RunOptions& options,
                   const BundlesOfMesh* bundles)
    : manifest_(manifest),
      options_(options),
      bundles_(bundles),
      finishes_here_(!why_finish_here(manifest, options).empty()) {}

std::uint64_t PartJobs::target() const {
  return target_triangles(manifest_, options_);
}

double PartJobs::ratio() const {
  return std::min(1.0, static_cast<double>(target()) /
                           static_cast<double>(std::max<std::uint64_t>(1, manifest_.triangles())));
}

double PartJobs::wanted() const {
  return provision(ratio()) * static_cast<double>(target());
}

double PartJobs::free_share() const {
  double free = 0;
  for (const PartEntry& part : manifest_.parts) {
    free += estimate_free(part.triangles, part.boundary_vertices);
  }
  return free / static_cast<double>(std::max<std::uint64_t>(1, manifest_.triangles()));
}

/// A proof needs the whole unchanged stream in memory: it is climbed like a part.
bool PartJobs::is_sampled(std::uint32_t part) const {
  return !options_.certify && !manifest_.samples.empty() &&
         !manifest_.samples[part].file.name.empty();
}

/// What is climbed: the part, or a sample of a long stream.
const PartEntry& PartJobs::climbed(std::uint32_t part) const {
  return is_sampled(part) ? manifest_.samples[part] : manifest_.parts[part];
}

Job PartJobs::climb(std::uint32_t part, double headroom, TopologyMode topology) const {
  SimplifyParameters parameters = parameters_of(topology);
  if (bundles_ != nullptr) return build_and_climb(part, headroom, std::move(parameters));
  const PartEntry& entry = climbed(part);
  set_share_of(parameters, part, headroom);
  if (by_error()) set_error_bound(parameters, part);
  Job job{std::string(k_simplify_kind),
          {entry.file},
          encode_parameters(parameters),
          entry.triangles,
          memory_of(entry, parameters.start_triangles) +
              memory_of_channels(parameters.lines, entry.triangles) +
              memory_of_bound(entry.triangles)};
  if (!is_sampled(part)) job.extent = extent_of_part(part, entry.file.size);
  // So that other sweeps need not wait for this stream's.
  if (by_error() && is_sampled(part)) job.after = manifest_.parts[part].triangles;
  return job;
}

Job PartJobs::climb_on(std::uint32_t part, const ChosenRung& from, const Rung& rung,
                       TopologyMode topology) const {
  SimplifyParameters parameters = parameters_of(topology);
  set_share_of(parameters, part, k_first_headroom);
  parameters.foreseen_triangles = 0;
  parameters.from = RungOfLadder{from.rung, rung.level};
  Job job;
  job.kind = k_simplify_kind;
  const std::uint64_t bytes = add_rung_input(from, true, job);
  job.parameters = encode_parameters(parameters);
  job.cost = rung.triangles;
  job.memory =
      memory_of_rung(bytes, rung.triangles) + memory_of_channels(parameters.lines, rung.triangles);
  return job;
}

SimplifyParameters PartJobs::parameters_of(TopologyMode topology) const {
  SimplifyParameters parameters;
  parameters.allocation = options_.allocation;
  parameters.cost_unit = cost_unit(manifest_.box.diagonal());
  parameters.lines = lines_of(manifest_, options_);
  parameters.lines.topology = topology;
  return parameters;
}

void PartJobs::set_share_of(SimplifyParameters& parameters, std::uint32_t part,
                            double headroom) const {
  const PartEntry& entry = climbed(part);
  if (manifest_.scheme == Scheme::cut) {
    set_share(parameters, share_rule(headroom), entry.shared_triangles, entry.shared_boundary);
    return;
  }
  const ShareRule rule{ratio(), headroom, end_of_ladders(), manifest_.triangles(),
                       sample_counts(manifest_, options_).all()};
  set_share(parameters, rule, entry.triangles, entry.boundary_vertices);
}

/// Memory to keep a bound, and to prove it.
std::uint64_t PartJobs::memory_of_bound(std::uint64_t triangles) const {
  return (by_error() ? k_bound_bytes_per_triangle * triangles : 0) +
         (options_.certify ? k_proof_bytes_per_triangle * triangles : 0);
}

/// The size of a part to build is only known on average.
Job PartJobs::build_and_climb(std::uint32_t part, double headroom,
                              SimplifyParameters parameters) const {
  const std::uint64_t parts = std::max<std::uint64_t>(1, manifest_.parts.size());
  const std::uint64_t average = manifest_.input_triangles / parts + 1;
  parameters.build =
      PartToBuild{bundles_of_parts(*bundles_, {part, part + 1}), part, share_rule(headroom)};
  if (by_error()) set_error_bound(parameters, part);
  Job job{std::string(k_simplify_kind),
          {},
          encode_parameters(parameters),
          average + average / k_build_share,
          memory_to_build(average) + memory_of_bound(k_largest_part * average / 10)};
  for (const VertexBundleRef& each : bundles_->vertices) job.reads += each.file.size / parts;
  for (const TriangleBundleRef& each : bundles_->triangles) job.reads += each.file.size / parts;
  job.extent = extent_of_part(part, job.reads);
  return job;
}

/// In terms of the input's triangles that have positions.
ShareRule PartJobs::share_rule(double headroom) const {
  const std::uint64_t all = manifest_.input_triangles - manifest_.dropped_not_finite;
  const auto some = static_cast<double>(std::max<std::uint64_t>(1, all));
  double ratio = options_.ratio;
  if (options_.triangles != 0) ratio = static_cast<double>(options_.triangles) / some;
  if (manifest_.uvs) ratio = static_cast<double>(target()) / some;
  if (by_error()) ratio = 1;
  return {std::min(1.0, ratio), headroom, end_of_ladders(), all,
          sample_counts(manifest_, options_).all()};
}

/// A multiple of what is kept for the finish. A finish in pieces needs the counts down to the
/// target.
double PartJobs::end_of_ladders() const {
  constexpr double k_of_target = 0.5;
  return finishes_here_ ? k_level_step : k_of_target;
}

double PartJobs::least_of(std::uint32_t part) const {
  return ratio() * static_cast<double>(manifest_.parts[part].triangles) / k_shares_per_floor;
}

void PartJobs::set_error_bound(SimplifyParameters& parameters, std::uint32_t part) const {
  parameters.allocation = Allocation::threshold;
  // The level found on a sample is applied to its stream by cost alone.
  const double share = is_sampled(part) ? k_error_share : k_bound_share_of_parts;
  parameters.max_error = share * options_.error.in(manifest_.box);
  parameters.start_triangles = climbed(part).triangles;
  parameters.share_triangles = 0;
  if (options_.certify) parameters.certified_error = options_.error.in(manifest_.box);
}

Job PartJobs::sweep(std::uint32_t part, std::int32_t level, TopologyMode topology) const {
  const PartEntry& entry = manifest_.parts[part];
  SweepParameters parameters;
  parameters.level = level;
  parameters.max_cost = sweep_cost(parameters.level);
  if (!climbs_samples()) parameters.ratio = ratio();
  parameters.window_triangles = manifest_.window_triangles;
  parameters.samples = samples_for(manifest_, options_, entry.triangles);
  parameters.max_error = by_error() ? k_error_share * options_.error.in(manifest_.box) : 0;
  parameters.lines = lines_of(manifest_, options_);
  // A single window can't tell what is fair.
  parameters.lines.topology =
      topology == TopologyMode::simplify ? TopologyMode::simplify : TopologyMode::keep;
  return {std::string(k_sweep_kind),
          {entry.file},
          encode_parameters(parameters),
          entry.triangles,
          memory_of_sweep(manifest_.window_triangles) +
              memory_of_channels(parameters.lines, manifest_.window_triangles)};
}

/// A level below 0 is the unchanged part: not even collapses of cost 0 are allowed.
double PartJobs::sweep_cost(std::int32_t level) const {
  return level < 0 ? -1 : level_cost(level, cost_unit(manifest_.box.diagonal()));
}

}  // namespace meshfarm
