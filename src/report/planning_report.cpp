// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <functional>

#include <meshfarm/report/planning_report.hpp>

#include "report/json.hpp"
#include "report/lines.hpp"

namespace meshfarm {
namespace {

/// Above this multiple of its lower bounds, a stage's time is due to something else.
constexpr double k_far_more = 2;

std::string padded(std::string text, std::size_t width) {
  if (text.size() < width) text.insert(0, width - text.size(), ' ');
  return text;
}

std::string labelled(std::string text, std::size_t width) {
  text.resize(std::max(width, text.size()), ' ');
  return text;
}

std::string seconds(double s) {
  return number(s, s < 100 ? "%.3f s" : "%.0f s");
}

double whole(const PlanSummary& plan, double farm_s) {
  return plan.cut_s + farm_s + plan.assemble_s;
}

Json as_json(const std::vector<PlanStage>& stages) {
  Json list = Json::array();
  for (const PlanStage& each : stages) {
    list.push_back({{"stage", each.name},
                    {"jobs", each.jobs},
                    {"takes_s", each.takes_s},
                    {"ideal_s", each.ideal_s},
                    {"longest_s", each.longest_s},
                    {"storage_s", each.storage_s}});
  }
  return list;
}

/// The limiting factor of a stage: the greatest of the lower bounds of its time.
std::string limit_of(const PlanStage& stage) {
  const double most = std::max({stage.ideal_s, stage.longest_s, stage.storage_s});
  if (stage.takes_s > k_far_more * most) return "files and messages";
  if (most == stage.ideal_s) return "work";
  return most == stage.longest_s ? "longest job" : "storage";
}

/// The time of each stage on a farm, and its limiting factor.
std::string stages_of(const PlanLine& line) {
  if (line.stages.empty()) return {};
  std::string text = "\n" + labelled("stages with " + line.farm, 22) +
                     "      jobs     takes      work   longest   storage  limit\n";
  for (const PlanStage& each : line.stages) {
    text += labelled("  " + each.name, 22) + padded(grouped(each.jobs), 10);
    for (const double s : {each.takes_s, each.ideal_s, each.longest_s, each.storage_s}) {
      text += padded(seconds(s), 10);
    }
    text += "  " + limit_of(each) + "\n";
  }
  return text;
}

Json as_json(const PlanSummary& plan) {
  Json lines = Json::array();
  for (const PlanLine& line : plan.lines) {
    lines.push_back({{"farm", line.farm},
                     {"farm_s", line.farm_s},
                     {"ideal_s", line.ideal_s},
                     {"speed_up", line.speed_up},
                     {"storage_busy", line.storage_busy},
                     {"whole_s", whole(plan, line.farm_s)},
                     {"whole_speed_up", whole(plan, plan.one_s) / whole(plan, line.farm_s)}});
    if (!line.stages.empty()) lines.back()["stages"] = as_json(line.stages);
  }
  return {{"stage", plan.stage},        {"jobs", plan.jobs},
          {"schedule", plan.schedule},  {"triangles", plan.triangles_in},
          {"cut_s", plan.cut_s},        {"assemble_s", plan.assemble_s},
          {"one_worker_s", plan.one_s}, {"farms", lines}};
}

Json as_json(const ScheduleComparison& comparison) {
  Json lines = Json::array();
  for (const ScheduleLine& each : comparison.lines) {
    lines.push_back({{"jobs", each.jobs},
                     {"ideal_s", each.ideal_s},
                     {"dynamic_s", each.dynamic_s},
                     {"static_s", each.static_s},
                     {"off_ideal_s", each.off_ideal_s},
                     {"off_dynamic_s", each.off_dynamic_s},
                     {"off_static_s", each.off_static_s}});
  }
  return {{"farm", comparison.farm}, {"off", comparison.off}, {"lines", lines}};
}

}  // namespace

std::string render(const PlanSummary& plan, Format format) {
  if (format == Format::json) return as_json(plan).dump(2) + "\n";
  const double serial = plan.cut_s + plan.assemble_s;
  std::string text = plan.stage + ": " + grouped(plan.triangles_in) + " triangles, " +
                     grouped(plan.jobs) + " jobs, " + plan.schedule + " schedule\n" +
                     "one worker: farm " + seconds(plan.one_s) + "; not farmed: cut " +
                     seconds(plan.cut_s) + ", stitch and finish " + seconds(plan.assemble_s) +
                     ", together " +
                     number(100 * serial / whole(plan, plan.one_s), "%.1f %% of the whole") +
                     "\n\n" + labelled("workers", 22) +
                     "      farm  speed-up  of ideal     whole  speed-up  "
                     "storage\n";
  for (const PlanLine& line : plan.lines) {
    const double all = whole(plan, line.farm_s);
    text += labelled(line.farm, 22) + padded(seconds(line.farm_s), 10) +
            padded(number(line.speed_up, "%.2f"), 10) +
            padded(number(line.farm_s / line.ideal_s, "%.3f"), 10) + padded(seconds(all), 10) +
            padded(number(whole(plan, plan.one_s) / all, "%.2f"), 10) +
            padded(number(100 * line.storage_busy, "%.0f %%"), 9) + "\n";
  }
  for (const PlanLine& line : plan.lines) text += stages_of(line);
  return text;
}

std::string render_paper_table(const std::vector<PlanSummary>& plans) {
  constexpr std::size_t k_label = 24;
  constexpr std::size_t k_column = 22;
  const bool streams = !plans.empty() && plans.front().scheme == "stream";
  std::string text;
  const auto row = [&](const std::string& label,
                       const std::function<std::string(const PlanSummary&)>& value) {
    text += labelled(label, k_label);
    for (const PlanSummary& plan : plans) text += padded(value(plan), k_column);
    text += "\n";
  };
  const auto farm = [](const PlanSummary& plan) { return plan.lines.front().farm_s; };
  text += std::string(streams ? "Table 2 (streams)" : "Table 1 (cutting)") + ", simulated on " +
          (plans.empty() ? "" : plans.front().lines.front().farm) + " workers\n";
  row("mesh", [](const PlanSummary& p) {
    return p.stage.size() < k_column ? p.stage : "..." + p.stage.substr(p.stage.size() - 18);
  });
  row("triangles in", [](const PlanSummary& p) { return grouped(p.triangles_in); });
  row("triangles out", [](const PlanSummary& p) { return grouped(p.triangles_out); });
  row(streams ? "streams" : "sub-meshes", [](const PlanSummary& p) { return grouped(p.jobs); });
  row(streams ? "generation" : "partition", [](const PlanSummary& p) { return seconds(p.cut_s); });
  row("simplification", [&](const PlanSummary& p) { return seconds(farm(p)); });
  row(streams ? "composition" : "stitching",
      [](const PlanSummary& p) { return seconds(p.assemble_s); });
  row("total", [&](const PlanSummary& p) { return seconds(whole(p, farm(p))); });
  row("single worker", [](const PlanSummary& p) { return seconds(whole(p, p.one_s)); });
  row("speed-up",
      [&](const PlanSummary& p) { return number(whole(p, p.one_s) / whole(p, farm(p)), "%.2f"); });
  row("  of simplification",
      [](const PlanSummary& p) { return number(p.lines.front().speed_up, "%.2f"); });
  row("  serial share, 1 worker", [](const PlanSummary& p) {
    return number(100 * (p.cut_s + p.assemble_s) / whole(p, p.one_s), "%.1f %%");
  });
  return text;
}

std::string render(const ScheduleComparison& comparison, Format format) {
  if (format == Format::json) return as_json(comparison).dump(2) + "\n";
  std::string text = "Figure 4: time over ideal, simulated on " + comparison.farm +
                     " workers; on the right their speeds are up to " +
                     number(100 * comparison.off, "%.0f %%") + " off those they reported\n" +
                     "   jobs     ideal   dynamic  of ideal    static  of ideal   |   dynamic  of "
                     "ideal    static  of ideal\n";
  const auto pair = [](double s, double ideal) {
    return padded(seconds(s), 10) + padded(number(s / ideal, "%.3f"), 10);
  };
  for (const ScheduleLine& each : comparison.lines) {
    text += padded(std::to_string(each.jobs), 7) + padded(seconds(each.ideal_s), 10) +
            pair(each.dynamic_s, each.ideal_s) + pair(each.static_s, each.ideal_s) + "   |" +
            pair(each.off_dynamic_s, each.off_ideal_s) + pair(each.off_static_s, each.off_ideal_s) +
            "\n";
  }
  return text;
}

}  // namespace meshfarm
