// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <meshfarm/report/summary.hpp>

namespace meshfarm {

/// A stage of a run on one farm.
struct PlanStage {
  std::string name;
  std::uint64_t jobs = 0;
  double takes_s = 0;    // from the end of those before it
  double ideal_s = 0;    // its work over all speed
  double longest_s = 0;  // of its jobs
  double storage_s = 0;  // its bytes over the storage's link
};

/// How long a dataset would take on one farm.
struct PlanLine {
  std::string farm;  // "24", "16 x 1 + 8 x 0.333"
  double farm_s = 0;
  double ideal_s = 0;
  double speed_up = 0;                 // of the farmed phase, against one worker of speed 1
  double storage_busy = 0;             // share of the time that the storage's link is busy
  std::vector<PlanStage> stages = {};  // if they are asked for
};

/// What a run of the past says of farms of the future.
struct PlanSummary {
  std::string stage;
  std::string scheme;  // "cut", "stream"
  std::uint64_t triangles_in = 0;
  std::uint64_t triangles_out = 0;  // 0: not known
  std::uint64_t jobs = 0;
  std::string schedule;
  double cut_s = 0;       // not farmed
  double assemble_s = 0;  // stitch, finish, measure and write: not farmed
  double one_s = 0;       // the farmed phase on one worker
  std::vector<PlanLine> lines;
};

std::string render(const PlanSummary& plan, Format format);

/// The paper's Table 1 (cutting) or 2 (streams): a column a plan, on the first of its farms.
std::string render_paper_table(const std::vector<PlanSummary>& plans);

/// The paper's Figure 4: dynamic against static, and how both bear speeds that are not as told.
struct ScheduleLine {
  std::uint64_t jobs = 0;
  double ideal_s = 0;
  double dynamic_s = 0;
  double static_s = 0;
  double off_ideal_s = 0;  // where the workers' speeds are off what they told
  double off_dynamic_s = 0;
  double off_static_s = 0;
};
struct ScheduleComparison {
  std::string farm;
  double off = 0;  // by how much at most, as a share
  std::vector<ScheduleLine> lines;
};

std::string render(const ScheduleComparison& comparison, Format format);
/// The same as a picture, as SVG: time over ideal by the number of jobs.
std::string draw(const ScheduleComparison& comparison);

}  // namespace meshfarm
