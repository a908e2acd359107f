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
/// levels that are the same in all parts. From the rungs' counts one level is chosen for all.
class ClimbStage {
 public:
  /// All must outlive this. `needs`: what a part needs before it can be climbed.
  ClimbStage(const Manifest& manifest, const RunOptions& options, const PartJobs& jobs,
             PartResults& results, std::function<JobNeeds(std::uint32_t part)> needs);

  /// Asks for the ladders of these parts, once more if they were asked for before.
  JobNeeds ask(JobGraph& graph, const std::vector<std::uint32_t>& parts);
  /// Once they are there.
  void take(const JobGraph& graph, const std::vector<std::uint32_t>& parts);
  /// Once all are there. Returns the parts to climb again: those that were taken too far, with a
  /// finer start; or all, with their topology simplified, if so much of the mesh is held back by it
  /// that the others would pay for that; or those that had stopped for that reason, if the others
  /// would not have paid after all.
  std::vector<std::uint32_t> choose_level();
  /// What kept its topology, before it was given up; none if it was not.
  const std::vector<ChosenRung>& kept() const { return kept_; }

 private:
  Job climb(std::uint32_t part) const;
  void stand_for_stream(std::uint32_t part);
  bool is_held_back() const;
  bool is_much_refused() const;
  double refused_in(std::uint32_t part, double all) const;
  void give_up_topology();
  bool was_fair() const;
  std::vector<std::uint32_t> keep_after_all();
  void keep_coarsest();

  const Manifest& manifest_;
  const RunOptions& options_;
  const PartJobs& jobs_;
  PartResults& results_;
  std::function<JobNeeds(std::uint32_t)> needs_;
  std::vector<double> headroom_;
  std::vector<JobName> asked_;         // the last job that was asked for, by part
  std::vector<std::uint8_t> goes_on_;  // from a rung that it has, by part
  std::uint32_t jobs_asked_ = 0;
  std::vector<std::uint32_t> climbed_;  // parts that have a ladder
  std::vector<ChosenRung> kept_;
  std::optional<PartResults> kept_ladders_;  // until they are compared with those that did not
  bool keeps_after_all_ = false;             // as the comparison told
};

}  // namespace meshfarm
