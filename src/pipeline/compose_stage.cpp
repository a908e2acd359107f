// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/compose_stage.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/compose_job.hpp>

#include "pipeline/finish_stage.hpp"
#include "pipeline/run_stages.hpp"
#include "pipeline/rung_input.hpp"

namespace meshfarm {
namespace {

/// How many are joined at once: with two there are more levels; with all, nothing is left to
/// distribute.
constexpr std::size_t k_most_joined = 4;

/// The sink joins and finishes this many triangles in about a second and 200 MB.
constexpr std::uint64_t k_worth_a_tree = 2'000'000;
/// A multiple of what the parts together keep: below it there is little left to simplify.
constexpr double k_worth_seams = 1.5;

/// The files as read, the joined mesh, the simplifier and the file that is written.
std::uint64_t memory_of_composition(std::uint64_t file_bytes, std::uint64_t triangles) {
  constexpr std::uint64_t k_process = std::uint64_t{16} << 20;
  return k_process + file_bytes + 150 * triangles;
}

/// Neighbours as one, before they are joined.
ComposedParts sum_of(const std::vector<ComposedParts>& parts, std::size_t first, std::size_t end) {
  ComposedParts sum = parts[first];
  for (std::size_t i = first + 1; i < end; ++i) {
    const ComposedParts& each = parts[i];
    sum.chosen.parts += each.chosen.parts;
    sum.chosen.dropped_degenerate += each.chosen.dropped_degenerate;
    sum.chosen.dropped_duplicate += each.chosen.dropped_duplicate;
    sum.chosen.turned += each.chosen.turned;
    sum.weight += each.weight;
  }
  return sum;
}

void take_output(ComposedParts& parts, const JobOutput& output) {
  const ResultSummary summary = decode_summary(output.summary, "summary of " + output.file.name);
  parts.chosen.file = output.file;
  parts.chosen.rung = 0;
  parts.chosen.place = place_of(summary, 0);
  parts.chosen.dropped_degenerate += summary.dropped_degenerate;
  parts.chosen.dropped_duplicate += summary.dropped_duplicate;
  parts.chosen.turned += summary.turned;
  parts.triangles = summary.rungs.front().triangles;
}

}  // namespace

void ComposeStage::begin(JobGraph& graph, const ComposeGoal& goal, std::vector<ComposedParts> parts,
                         Done done) {
  goal_ = goal;
  done_ = std::move(done);
  std::uint64_t triangles = 0;
  for (const ComposedParts& each : parts) {
    weight_ += each.weight;
    triangles += each.triangles;
  }
  most_triangles_ = most_triangles(triangles);
  Level& level = levels_.emplace_back();
  level.parts = std::move(parts);
  level.whole = true;
  while (level.taken < level.parts.size()) take(graph, 0);
  end_level(graph, 0);
}

bool ComposeStage::can_join() const {
  return goal_.level >= 0 && weight_ > 0 && options_.allocation == Allocation::threshold &&
         options_.finish == Finish::global && !(options_.error.value > 0) &&
         options_.composition != Composition::sink;
}

/// The capacity that simplifying the parts needed: a sweep's window, or the largest part. Pieces of
/// a result have a size that suits them instead.
std::uint64_t ComposeStage::most_triangles(std::uint64_t all_triangles) const {
  if (goal_.for_pieces) {
    const double seams = static_cast<double>(manifest_.boundary_triangles) /
                         static_cast<double>(std::max<std::uint64_t>(1, manifest_.triangles()));
    const std::uint64_t by_seams = std::clamp(static_cast<std::uint64_t>(k_least_by_seams * seams),
                                              k_least_piece, k_least_with_long_seams);
    const std::uint64_t least =
        manifest_.scheme == Scheme::stream ? k_least_with_long_seams : by_seams;
    return std::max(std::clamp(all_triangles / k_pieces_of_all, least, k_usual_piece),
                    2 * all_triangles / k_most_pieces);
  }
  std::uint64_t most = manifest_.window_triangles;
  if (manifest_.scheme == Scheme::stream) return most;
  for (const PartEntry& part : manifest_.parts) most = std::max(most, part.triangles);
  return most;
}

/// Judges by the results so far: the outcome may be clear before all are there.
bool ComposeStage::is_worth_it(const Level& level) const {
  if (!can_join()) return false;
  if (options_.composition == Composition::tree || goal_.for_pieces) return true;
  return level.triangles >= k_worth_a_tree &&
         static_cast<double>(level.triangles) > k_worth_seams * goal_.triangles;
}

/// Takes the next result of a level.
void ComposeStage::take(JobGraph& graph, std::size_t number) {
  Level& level = levels_[number];
  level.triangles += level.parts[level.taken++].triangles;
  // Results that were not joined on the level below don't fit now either.
  const bool any_new = number == 0 || levels_[number - 1].joins;
  if (any_new && is_worth_it(level)) join(graph, number);
}

/// Joins neighbours as long as they fit.
void ComposeStage::join(JobGraph& graph, std::size_t number) {
  Level& level = levels_[number];
  const std::uint64_t seam = manifest_.boundary_triangles / manifest_.parts.size();
  while (level.first < level.taken) {
    std::uint64_t triangles = level.parts[level.first].triangles;
    std::size_t end = level.first + 1;
    bool fits = true;
    for (; end < level.taken && end - level.first < k_most_joined; ++end) {
      triangles += seam + level.parts[end].triangles;
      fits = triangles <= most_triangles_;
      if (!fits) break;
    }
    const bool last = level.whole && end == level.parts.size();
    if (fits && !last && end - level.first < k_most_joined) return;  // the next one may fit, too
    close_group(graph, number, end);
  }
}

/// The group becomes one entry of the next level.
void ComposeStage::close_group(JobGraph& graph, std::size_t number, std::size_t end) {
  if (number + 1 == levels_.size()) levels_.emplace_back();
  Level& level = levels_[number];
  Level& next = levels_[number + 1];
  const std::size_t first = std::exchange(level.first, end);
  const std::size_t place = next.parts.size();
  next.parts.push_back(sum_of(level.parts, first, end));
  const std::size_t base = number * manifest_.parts.size();
  const JobName name = job_name(RunStage::compose, base + place);
  const bool joins = end - first > 1;
  level.joins = level.joins || joins;
  graph.add(name, {}, [this, number, first, end, joins](JobGraph&) {
    return joins ? std::optional(job_of(levels_[number], first, end)) : std::nullopt;
  });
  graph.then({jobs_of(RunStage::compose, base, place + 1)}, [=, this](JobGraph& so_far) {
    if (joins) take_output(levels_[number + 1].parts[place], so_far.output(name));
    take(so_far, number + 1);
  });
}

/// The work of joining a result of this size with others like it, level by level.
std::uint64_t ComposeStage::work_after(std::uint64_t triangles, std::uint64_t parts) const {
  std::uint64_t work = 0;
  while (parts < manifest_.parts.size() && k_most_joined * triangles <= most_triangles_) {
    triangles *= k_most_joined;
    parts *= k_most_joined;
    work += triangles;
  }
  return work;
}

Job ComposeStage::job_of(const Level& level, std::size_t first, std::size_t end) const {
  ComposeParameters parameters;
  for (std::size_t i = 0; i < first; ++i) parameters.first_part += level.parts[i].chosen.parts;
  parameters.all_parts = static_cast<std::uint32_t>(manifest_.parts.size());
  parameters.boundary = manifest_.boundary;
  parameters.level = goal_.level;
  parameters.max_cost = goal_.max_cost;
  parameters.samples_per_triangle =
      std::min(100.0, static_cast<double>(samples_for(manifest_, options_, manifest_.triangles())) /
                          static_cast<double>(std::max<std::uint64_t>(1, manifest_.triangles())));
  parameters.keeps_between = goal_.for_pieces;
  parameters.lines = lines_of(manifest_, options_);
  parameters.lines.topology = goal_.topology;
  Job job;
  job.kind = k_compose_kind;
  std::uint64_t weight = 0;
  std::uint64_t bytes = 0;
  std::uint64_t composed = 0;
  for (std::size_t i = first; i < end; ++i) {
    const ComposedParts& each = level.parts[i];
    parameters.inputs.push_back({each.chosen.parts, each.chosen.rung});
    composed += each.chosen.parts;
    bytes += add_rung_input(each.chosen, goal_.for_pieces && each.chosen.parts > 1, job);
    job.cost += each.triangles;
    weight += each.weight;
  }
  parameters.floor = static_cast<std::uint64_t>(goal_.triangles * static_cast<double>(weight) /
                                                static_cast<double>(weight_));
  job.after = work_after(parameters.floor, composed);
  job.parameters = encode_parameters(parameters);
  job.memory =
      memory_of_composition(bytes, job.cost) + memory_of_channels(parameters.lines, job.cost);
  return job;
}

/// All results of a level are there.
void ComposeStage::end_level(JobGraph& graph, std::size_t number) {
  levels_[number].whole = true;
  if (is_worth_it(levels_[number])) join(graph, number);
  if (!levels_[number].joins) return done_(graph, levels_[number].parts);
  const std::size_t base = number * manifest_.parts.size();
  const JobNeeds next = {jobs_of(RunStage::compose, base, levels_[number + 1].parts.size())};
  graph.then(next, [this, number](JobGraph& so_far) { end_level(so_far, number + 1); });
}

}  // namespace meshfarm
