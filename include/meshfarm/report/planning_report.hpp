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
  double takes_s = 0;    // from the end of its predecessors
  double ideal_s = 0;    // its work divided by the total speed
  double longest_s = 0;  // of its jobs
  double storage_s = 0;  // its bytes divided by the storage link's rate
};

/// How long a dataset would take on one farm.
struct PlanLine {
  std::string farm;  // "24", "16 x 1 + 8 x 0.333"
  double farm_s = 0;
  double ideal_s = 0;
  double speed_up = 0;                 // of the farmed phase, relative to one worker of speed 1
  double storage_busy = 0;             // fraction of the time that the storage's link is busy
  std::vector<PlanStage> stages = {};  // only if requested
};

/// The prediction for other farms from a past run.
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

/// The paper's Table 1 (cutting) or 2 (streams): one column per plan, on its first farm.
std::string render_paper_table(const std::vector<PlanSummary>& plans);

/// The paper's Figure 4: dynamic against static, and how both cope with speeds other than reported.
struct ScheduleLine {
  std::uint64_t jobs = 0;
  double ideal_s = 0;
  double dynamic_s = 0;
  double static_s = 0;
  double off_ideal_s = 0;  // with worker speeds that differ from those reported
  double off_dynamic_s = 0;
  double off_static_s = 0;
};
struct ScheduleComparison {
  std::string farm;
  double off = 0;  // the largest difference, as a fraction
  std::vector<ScheduleLine> lines;
};

std::string render(const ScheduleComparison& comparison, Format format);
/// The comparison as an SVG picture: time relative to ideal, by the number of jobs.
std::string draw(const ScheduleComparison& comparison);

}  // namespace meshfarm
