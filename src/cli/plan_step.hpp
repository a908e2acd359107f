// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <meshfarm/pipeline/planning.hpp>
#include <meshfarm/report/planning_report.hpp>

#include "cli/options.hpp"

namespace meshfarm {

/// `simulate STAGE...`: predictions for other farms from a traced run.
struct PlanWords {
  std::vector<std::string> stages;  // or trace files
  std::string workers = "24,240,10000";
  std::string schedule = "dynamic";
  std::string storage = "10";  // Gbit/s
  std::string link = "10";
  std::string cache = "4G";
  double delay_ms = 0.1;
  double off = 0.2;
  std::uint64_t parts = 0;
  bool paper = false;
  bool limits = false;  // show the limiting factor of each stage
  std::string output;

  void add(po::options_description& options);
  void check();
  /// As Command::check_given().
  void check_given(const GivenOptions& given) const;
  /// Prints the prediction; the picture goes to `output`. Throws Error.
  void run(Format format) const;

 private:
  struct Farm {
    std::string name;
    std::vector<WorkerGroup> groups;
  };
  PlannedFarm farm_of(const Farm& farm) const;
  PlanSummary plan_of(const std::string& stage, const std::vector<Farm>& farms) const;
  ScheduleComparison compare_schedules(const std::string& stage) const;

  std::vector<Farm> farms_;
  PlannedFarm like_;
};

}  // namespace meshfarm
