// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/climb_stage.hpp"

#include <algorithm>
#include <utility>

#include <meshfarm/pipeline/budget.hpp>

#include "pipeline/run_stages.hpp"

namespace meshfarm {
namespace {

constexpr double k_more_headroom = 8;

/// Parts held back by their topology may have at most this share of all triangles at the chosen
/// level, and all parts together at most k_fair_excess times what is wanted: a few levels.
constexpr double k_fair_share = 0.1;
constexpr double k_fair_excess = 2;
/// At most this many collapses per triangle may be refused by the time the count is reached,
/// extrapolated from the chosen level. Where keeping the topology turned out to cost more than
/// is fair, it was 1.2 to 5 in six of seven cases; where it did not, up to 0.9.
constexpr double k_fair_refused = 1.1;
/// Refusals alone do not decide. At the same level, which is the same cost of the last collapse,
/// parts that keep their topology may have this many times the triangles of those that do not:
/// their distances from the input differ by about the same factor. Until the count has fallen by
/// k_least_way since the first rungs, which both have in common, this comparison says nothing, and
/// the topology is given up.
constexpr double k_fair_count = 1.2;
constexpr double k_least_way = 1.25;

/// If parts that continue to keep their topology come to more than this many levels above those
/// that do not, which is 16 times the cost, it was not fair after all. On a circuit board they came
/// to the top, and the error was seven times as great.
constexpr std::int32_t k_levels_too_far = 4;

/// At most this many triangles are compared with the result, to find which pieces and handles went.
constexpr double k_most_compared = 4e6;

/// The first choice, which may turn out not to be fair.
TopologyMode first_topology(const RunOptions& options, bool by_error) {
  if (options.lines.topology != TopologyMode::automatic) return options.lines.topology;
  if (by_error) return TopologyMode::keep;
  return options.allocation == Allocation::threshold ? TopologyMode::keep_while_fair
                                                     : TopologyMode::automatic;
}

/// Adds what a first job found about the part, as a second job has only seen a rung of it.
void add_to(const ResultSummary& before, ResultSummary& summary) {
  summary.dropped_degenerate += before.dropped_degenerate;
  summary.dropped_duplicate += before.dropped_duplicate;
  summary.turned += before.turned;
  summary.built = before.built;
}

}  // namespace

ClimbStage::ClimbStage(const Manifest& manifest, const RunOptions& options, const PartJobs& jobs,
                       PartResults& results, std::function<JobNeeds(std::uint32_t part)> needs)
    : manifest_(manifest),
      options_(options),
      jobs_(jobs),
      results_(results),
      needs_(std::move(needs)),
      headroom_(manifest.parts.size(), k_first_headroom),
      asked_(manifest.parts.size()),
      goes_on_(manifest.parts.size(), 0) {
  results_.topology = first_topology(options, jobs.by_error());
}

JobNeeds ClimbStage::ask(JobGraph& graph, const std::vector<std::uint32_t>& parts) {
  JobNeeds asked;
  for (const std::uint32_t part : parts) {
    const JobNeeds needs = goes_on_[part] != 0 ? JobNeeds{just(asked_[part])} : needs_(part);
    asked_[part] = job_name(RunStage::climb, jobs_asked_++);
    const auto make = [this, part](JobGraph&) { return climb(part); };
    graph.add(asked_[part], needs, make);
    asked.push_back(just(asked_[part]));
  }
  return asked;
}

/// If the topology is kept after all, no ladder may end because of refusals: a job that continues
/// does not predict them, and one that starts anew may not give up the topology.
Job ClimbStage::climb(std::uint32_t part) const {
  const TopologyMode topology = results_.topology;
  if (goes_on_[part] == 0) {
    return jobs_.climb(part, headroom_[part], keeps_after_all_ ? TopologyMode::keep : topology);
  }
  const ResultSummary& before = results_.summaries[part];
  ChosenRung from{.file = results_.files[part]};
  if (keeps_after_all_) from.rung = static_cast<std::uint32_t>(before.rungs.size() - 1);
  from.place = place_of(before, from.rung);
  return jobs_.climb_on(part, from, before.rungs[from.rung], topology);
}

void ClimbStage::take(const JobGraph& graph, const std::vector<std::uint32_t>& parts) {
  for (const std::uint32_t part : parts) {
    if (results_.files[part].name.empty()) climbed_.push_back(part);
    const ResultSummary before = std::exchange(results_.summaries[part], {});
    results_.take(part, graph, asked_[part]);
    if (std::exchange(goes_on_[part], 0) != 0) add_to(before, results_.summaries[part]);
    if (jobs_.is_sampled(part)) stand_for_stream(part);
  }
}

/// Scales the counts of a sample to the whole stream.
void ClimbStage::stand_for_stream(std::uint32_t part) {
  const double times =
      static_cast<double>(manifest_.parts[part].triangles) /
      static_cast<double>(std::max<std::uint64_t>(1, manifest_.samples[part].triangles));
  for (Rung& rung : results_.summaries[part].rungs) {
    for (std::uint64_t* count : {&rung.free_triangles, &rung.refused}) {
      *count = static_cast<std::uint64_t>(times * static_cast<double>(*count));
    }
  }
}

std::vector<std::uint32_t> ClimbStage::choose_level() {
  if (climbed_.empty()) return {};
  std::vector<ResultSummary> climbed;
  for (const std::uint32_t part : climbed_) climbed.push_back(results_.summaries[part]);
  results_.level = common_level(climbed, static_cast<std::uint64_t>(jobs_.wanted_free()));
  if (results_.topology == TopologyMode::keep_while_fair) {
    const bool is_held = is_held_back();
    if (given_up_ && (is_held || is_too_far())) {
      give_up_after_all();
    } else if (is_held || (!keeps_after_all_ && is_much_refused())) {
      if (!is_held) kept_ladders_ = results_;
      give_up_topology();
      return climbed_;
    }
  } else if (kept_ladders_) {
    std::vector<std::uint32_t> stopped;
    if (was_fair()) stopped = keep_after_all();
    kept_ladders_.reset();
    if (!stopped.empty()) return stopped;
  }
  std::vector<std::uint32_t> again;
  if (options_.allocation == Allocation::uniform) return again;
  for (const std::uint32_t part : climbed_) {
    if (results_.summaries[part].rungs.front().level <= results_.level) continue;
    headroom_[part] *= k_more_headroom;
    again.push_back(part);
  }
  return again;
}

/// Asks for all parts again, from their first rungs.
void ClimbStage::give_up_topology() {
  keep_coarsest();
  results_.topology = TopologyMode::simplify;
  keeps_after_all_ = false;
  headroom_.assign(headroom_.size(), k_first_headroom);
  goes_on_.assign(goes_on_.size(), 1);
}

/// Whether the parts that kept their topology had hardly more triangles, each at the level that it
/// reached.
bool ClimbStage::was_fair() const {
  double first = 0;
  double kept = 0;
  double others = 0;
  for (const std::uint32_t part : climbed_) {
    const ResultSummary& before = kept_ladders_->summaries[part];
    const std::int32_t level = std::min(kept_ladders_->level, before.rungs.back().level);
    first += static_cast<double>(before.rungs.front().free_triangles);
    kept += static_cast<double>(free_triangles_at(before, level));
    others += static_cast<double>(free_triangles_at(results_.summaries[part], level));
  }
  return first >= k_least_way * kept && kept <= k_fair_count * others;
}

/// Returns the parts that had stopped, to continue from their last rungs.
std::vector<std::uint32_t> ClimbStage::keep_after_all() {
  given_up_ = GivenUp{std::exchange(results_, std::move(*kept_ladders_)), std::move(kept_)};
  kept_.clear();
  keeps_after_all_ = true;
  std::vector<std::uint32_t> stopped;
  for (const std::uint32_t part : climbed_) {
    if (results_.summaries[part].end != LadderEnd::refusals) continue;
    goes_on_[part] = 1;
    stopped.push_back(part);
  }
  return stopped;
}

/// Whether parts that keep their topology after all had to go on to a much higher cost than those
/// that do not.
bool ClimbStage::is_too_far() const {
  return results_.level > given_up_->results.level + k_levels_too_far;
}

/// Goes back to the ladders that do not keep the topology.
void ClimbStage::give_up_after_all() {
  results_ = std::move(given_up_->results);
  kept_ = std::move(given_up_->kept);
  given_up_.reset();
  keeps_after_all_ = false;
}

/// Whether parts that keep their topology could not follow the others to the common level, or all
/// parts together miss the count by far, or not even their maximum reduction would reach the
/// target. If the topology is kept at too high a cost without any of this, the finish finds out.
bool ClimbStage::is_held_back() const {
  const auto all = static_cast<double>(results_.free_triangles(results_.level));
  double held = 0;
  double least = 0;
  bool any = false;
  for (std::uint32_t p = 0; p < results_.summaries.size(); ++p) {
    const ResultSummary& result = results_.summaries[p];
    const Rung& last = result.rungs.back();
    const auto left = static_cast<double>(last.free_triangles);
    least += result.goes_on() ? std::min(left, jobs_.least_of(p)) : left;
    if (!result.held_by_topology) continue;
    any = true;
    if (!result.goes_on() && last.level < results_.level) held += left;
  }
  // Once it is kept after all, the finish may do what single parts could not.
  if (any && !keeps_after_all_ && least > static_cast<double>(jobs_.target())) return true;
  return held > k_fair_share * all || (any && all > k_fair_excess * jobs_.wanted_free());
}

/// Whether most of the collapses that the parts try will be refused.
bool ClimbStage::is_much_refused() const {
  const auto all = static_cast<double>(results_.free_triangles(results_.level));
  const double share = jobs_.wanted_free() / all;
  double refused = 0;
  for (std::uint32_t p = 0; p < results_.summaries.size(); ++p) refused += refused_in(p, share);
  return refused > k_fair_refused * all;
}

/// Refusals by the time all parts are reduced to this share of their free triangles at the common
/// level.
double ClimbStage::refused_in(std::uint32_t part, double share) const {
  const ResultSummary& result = results_.summaries[part];
  const Rung& rung = result.rungs[rung_at(result.rungs, results_.level)];
  // Beyond the end of other ladders too little is left to extrapolate from.
  const std::uint64_t left = result.end == LadderEnd::refusals
                                 ? free_triangles_at(result, results_.level)
                                 : rung.free_triangles;
  return refused_by(rung, share * static_cast<double>(left));
}

/// A sample of a stream has no topology to compare, and meshes far larger than the result are not
/// worth the memory: the sink would hold all of them to tell what went.
void ClimbStage::keep_coarsest() {
  double triangles = 0;
  for (std::uint32_t p = 0; p < results_.summaries.size(); ++p) {
    if (jobs_.is_sampled(p)) return kept_.clear();
    const std::vector<Rung>& rungs = results_.summaries[p].rungs;
    const auto last = static_cast<std::uint32_t>(rungs.size() - 1);
    kept_.push_back(
        {.file = results_.files[p], .rung = last, .place = place_of(results_.summaries[p], last)});
    triangles += static_cast<double>(rungs.back().triangles);
  }
  if (triangles > std::max(k_most_compared, jobs_.wanted())) kept_.clear();
}

}  // namespace meshfarm
