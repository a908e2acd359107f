// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <meshfarm/pipeline/budget.hpp>

#include "pipeline/part_jobs.hpp"
#include "pipeline/part_results.hpp"

namespace meshfarm {

/// Every part, or a sample of a long stream, is simplified to a ladder: snapshots at rising cost
/// levels that are the same in all parts. One level is chosen for all parts from the counts of the
/// rungs.
class ClimbStage {
 public:
  /// All must outlive this. `needs`: what a part needs before it can be climbed.
  ClimbStage(const Manifest& manifest, const RunOptions& options, const PartJobs& jobs,
             PartResults& results, std::function<JobNeeds(std::uint32_t part)> needs);

  /// Asks for the ladders of these parts, again if they were asked for before.
  JobNeeds ask(JobGraph& graph, const std::vector<std::uint32_t>& parts);
  /// Call this once they are accepted.
  void take(const JobGraph& graph, const std::vector<std::uint32_t>& parts);
  /// Call this once all are accepted. Returns the parts to climb again: those that were simplified
  /// too far, with a finer start; or all, with their topology simplified, if it holds back so much
  /// of the mesh that the other parts would pay for it; or those that had stopped for that reason,
  /// if the others would not have paid after all. If these come to a much higher cost, what was
  /// made without the topology is taken.
  std::vector<std::uint32_t> choose_level();
  /// The rungs that kept their topology before it was given up; empty if it was not.
  const std::vector<ChosenRung>& kept() const { return kept_; }

 private:
  /// The ladders that gave up the topology, to come back to.
  struct GivenUp {
    PartResults results;
    std::vector<ChosenRung> kept;
  };

  Job climb(std::uint32_t part) const;
  void stand_for_stream(std::uint32_t part);
  bool is_held_back() const;
  bool is_much_refused() const;
  double refused_in(std::uint32_t part, double share) const;
  void give_up_topology();
  bool was_fair() const;
  std::vector<std::uint32_t> keep_after_all();
  bool is_too_far() const;
  void give_up_after_all();
  void keep_coarsest();

  const Manifest& manifest_;
  const RunOptions& options_;
  const PartJobs& jobs_;
  PartResults& results_;
  std::function<JobNeeds(std::uint32_t)> needs_;
  std::vector<double> headroom_;
  std::vector<JobName> asked_;         // the last job asked for, by part
  std::vector<std::uint8_t> goes_on_;  // continues from an existing rung, by part
  std::uint32_t jobs_asked_ = 0;
  std::vector<std::uint32_t> climbed_;  // parts that have a ladder
  std::vector<ChosenRung> kept_;
  std::optional<PartResults> kept_ladders_;  // until compared with those that gave up the topology
  bool keeps_after_all_ = false;             // the outcome of that comparison
  std::optional<GivenUp> given_up_;          // while it keeps the topology after all
};

}  // namespace meshfarm
