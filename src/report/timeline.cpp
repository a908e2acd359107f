// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <vector>

#include <meshfarm/report/progress.hpp>
#include <meshfarm/report/timeline.hpp>
#include <meshfarm/util/checksum.hpp>

#include "report/lines.hpp"
#include "report/page_html.hpp"
#include "report/svg.hpp"

namespace meshfarm {
namespace {

constexpr double k_lanes_left = 170;
constexpr double k_timeline_width = 1100;
constexpr double k_lanes_right = 20;
constexpr double k_axis = 24;
/// Jobs that would be narrower than this are drawn as one with their neighbours.
constexpr double k_least_width = 1.5;
constexpr const char* k_stage_colours[] = {"#4878a8", "#d08030", "#58a058", "#a05898",
                                           "#a87848", "#48a0a0", "#808080", "#c05060"};

/// When a worker computed, and which stage.
struct Span {
  double begin = 0;
  double end = 0;
  std::uint32_t stage = 0;  // index into Frame::stages
  std::uint64_t jobs = 1;
  std::uint64_t triangles = 0;
};

struct Row {
  TraceJoined joined;
  std::optional<double> left;
  std::vector<Span> spans;
  std::vector<double> failures;
  double computed_s = 0;
  std::uint64_t jobs = 0;
  std::uint64_t triangles = 0;
};

struct Frame {
  std::map<std::uint32_t, Row> rows;
  std::vector<std::string> stages;  // in order of first appearance
  double begin = 0;                 // of the farmed phase
  double end = 1;
  double length() const { return std::max(1e-3, end - begin); }
  double x(double t) const {
    return k_lanes_left +
           (t - begin) / length() * (k_timeline_width - k_lanes_left - k_lanes_right);
  }
};

/// Also works for old traces.
std::string stage_of(const TraceDone& job) {
  return job.stage.empty() ? "round " + std::to_string(job.round + 1) : job.stage;
}

std::uint32_t number_of(std::vector<std::string>& stages, const std::string& stage) {
  const auto found = std::find(stages.begin(), stages.end(), stage);
  const auto number = static_cast<std::uint32_t>(found - stages.begin());
  if (found == stages.end()) stages.push_back(stage);
  return number;
}

Span span_of(const TraceDone& job, std::uint32_t stage) {
  // The trace contains the time of acceptance: the job was written before, and computed before
  // that.
  const double computed = job.t - job.write_ms / 1000.0;
  return {computed - job.compute_ms / 1000.0, computed, stage, 1, job.triangles};
}

Frame frame_of(const Trace& trace) {
  Frame frame;
  frame.begin = trace.done.empty() ? 0 : trace.done.front().t;
  for (const TraceJoined& each : trace.joined) frame.rows[each.worker].joined = each;
  for (const TraceLeft& each : trace.left) frame.rows[each.worker].left = each.t;
  for (const TraceFailed& each : trace.failed) frame.rows[each.worker].failures.push_back(each.t);
  for (const TraceDone& each : trace.done) {
    if (each.worker == k_sink_of_trace) continue;
    Row& row = frame.rows[each.worker];
    row.spans.push_back(span_of(each, number_of(frame.stages, stage_of(each))));
    row.computed_s += each.compute_ms / 1000.0;
    ++row.jobs;
    row.triangles += each.triangles;
    frame.begin = std::min(frame.begin, std::max(0.0, row.spans.back().begin - each.read_ms / 1e3));
    frame.end = std::max(frame.end == 1 ? 0 : frame.end, each.t);
  }
  return frame;
}

/// Merges adjacent spans that cannot be told apart.
std::vector<Span> drawable(std::vector<Span> spans, const Frame& frame) {
  std::sort(spans.begin(), spans.end(),
            [](const Span& a, const Span& b) { return a.begin < b.begin; });
  std::vector<Span> merged;
  for (const Span& each : spans) {
    const bool close = !merged.empty() && merged.back().stage == each.stage &&
                       frame.x(each.end) - frame.x(merged.back().begin) < 2 * k_least_width &&
                       frame.x(each.begin) - frame.x(merged.back().end) < k_least_width / 2;
    if (!close) {
      merged.push_back(each);
      continue;
    }
    merged.back().end = std::max(merged.back().end, each.end);
    merged.back().jobs += each.jobs;
    merged.back().triangles += each.triangles;
  }
  return merged;
}

std::string s_text(double t) {
  return number(t, "%.3g s");
}

void draw_axis(Svg& svg, const Frame& frame, double bottom) {
  const double step = round_step(frame.length(), 10);
  for (double t = 0; t <= frame.length() * 1.0001; t += step) {
    const double x = frame.x(frame.begin + t);
    svg.line({x, 0}, {x, bottom}, "#e4e4e4");
    svg.text({x, bottom + 16}, s_text(t), SvgAnchor::middle);
  }
}

const char* colour_of(std::uint32_t stage) {
  return k_stage_colours[stage % std::size(k_stage_colours)];
}

void draw_row(Svg& svg, const Frame& frame, const Row& row, double y, double height) {
  const double first = std::max(frame.begin, row.joined.t);
  const double last = std::min(frame.end, row.left.value_or(frame.end));
  if (last > first) {
    svg.rect({frame.x(first), y}, frame.x(last) - frame.x(first), height, "#f1f1f1");
  }
  for (const Span& each : drawable(row.spans, frame)) {
    const double x = frame.x(each.begin);
    const std::string title =
        (each.jobs == 1 ? "a job of " : grouped(each.jobs) + " jobs of ") +
        grouped(each.triangles) + " triangles, " + s_text(each.begin - frame.begin) + " to " +
        s_text(each.end - frame.begin) + " (" + frame.stages[each.stage] + ")";
    const double gap = frame.x(each.end) - x > 4 ? 0.6 : 0;
    svg.rect({x, y}, std::max(0.4, frame.x(each.end) - x - gap), height, colour_of(each.stage),
             title);
  }
  for (const double t : row.failures) {
    svg.circle({frame.x(t), y + height / 2}, 3, "#c02020", "an attempt failed");
  }
  if (row.left && *row.left < frame.end) {
    svg.line({frame.x(*row.left), y}, {frame.x(*row.left), y + height}, "#c02020", 2);
  }
  if (height < 9) return;
  svg.text({4, y + height / 2 + 4}, std::to_string(row.joined.worker) + "  " + row.joined.host);
}

std::string timeline(const Frame& frame) {
  const double rows = std::max<double>(1, static_cast<double>(frame.rows.size()));
  const double pitch = std::clamp(1200 / rows, 1.0, 22.0);
  const double bottom = rows * pitch + 4;
  Svg svg(k_timeline_width, bottom + k_axis);
  draw_axis(svg, frame, bottom);
  double y = 2;
  for (const auto& [worker, row] : frame.rows) {
    draw_row(svg, frame, row, y, pitch > 4 ? pitch - 2 : pitch);
    y += pitch;
  }
  return svg.str();
}

/// The number of triangles done over time.
std::string progress_chart(const Frame& frame, const Trace& trace) {
  constexpr double k_height = 160;
  double all = 1;
  for (const TraceDone& each : trace.done) all += static_cast<double>(each.triangles);
  Svg svg(k_timeline_width, k_height + k_axis);
  draw_axis(svg, frame, k_height);
  std::string path = "M" + number(frame.x(frame.begin), "%.1f") + " " + number(k_height, "%.1f");
  double done = 0;
  double drawn_x = 0;
  for (const TraceDone& each : trace.done) {
    done += static_cast<double>(each.triangles);
    if (frame.x(each.t) - drawn_x < 1 && &each != &trace.done.back()) continue;
    drawn_x = frame.x(each.t);
    path += " L" + number(drawn_x, "%.1f") + " " + number(k_height * (1 - done / all), "%.1f");
  }
  svg.path(path, "#4878a8");
  svg.text({4, 12}, grouped(static_cast<std::uint64_t>(done)));
  svg.text({4, 28}, "triangles of the input");
  return svg.str();
}

std::string worker_table(const Frame& frame, const Trace& trace) {
  std::string text = "<table>\n" + row_of({"worker", "host", "jobs", "triangles", "triangles/s",
                                           "computing", "failed attempts", "left"},
                                          "th");
  std::map<std::uint32_t, std::string> why;
  for (const TraceLeft& each : trace.left) why[each.worker] = each.why;
  for (const auto& [worker, row] : frame.rows) {
    const double busy = 100 * row.computed_s / (frame.length() * row.joined.threads);
    const double rate =
        row.computed_s > 0 ? static_cast<double>(row.triangles) / row.computed_s : 0;
    text += row_of({std::to_string(worker), row.joined.host + ":" + std::to_string(row.joined.pid),
                    grouped(row.jobs), grouped(row.triangles), with_unit(rate),
                    number(busy, "%.1f %%"), grouped(row.failures.size()), why[worker]},
                   "td");
  }
  return text + "</table>\n";
}

std::string facts(const Manifest& manifest, const Trace& trace, const Frame& frame,
                  const std::optional<RunTimes>& times) {
  double computed = 0;
  double threads = 0;
  for (const auto& [worker, row] : frame.rows) {
    computed += row.computed_s;
    threads += row.joined.threads;
  }
  std::string text = "<table class=\"facts\">\n";
  const auto add = [&](const std::string& name, const std::string& value) {
    text += row_of({name, value}, "td");
  };
  add("input", manifest.input + ", " + grouped(manifest.triangles()) + " triangles in " +
                   grouped(manifest.part_count()) + " parts");
  add("run", to_hex(trace.head.run) + ", epoch " + std::to_string(trace.head.epoch) + " on " +
                 trace.head.host);
  add("end", !trace.end                   ? "not yet"
             : trace.end->failure.empty() ? "all was done"
                                          : "stopped: " + trace.end->failure);
  add("farmed", number(frame.length(), "%.3f s") + ", " + grouped(trace.done.size()) + " jobs by " +
                    grouped(frame.rows.size()) + " workers, " + grouped(trace.failed.size()) +
                    " failed attempts");
  if (threads > 0) {
    add("computing", number(computed, "%.3f s") + ", " +
                         number(100 * computed / (threads * frame.length()), "%.1f %%") +
                         " of the workers' time");
  }
  add("cut", number(trace.head.cut_s, "%.2f s"));
  if (times) {
    add("after the farm", "stitch " + number(times->stitch, "%.2f s") + ", finish " +
                              number(times->finish, "%.2f s") + ", measure " +
                              number(times->measure, "%.2f s") + ", write " +
                              number(times->write, "%.2f s"));
  }
  return text + "</table>\n";
}

}  // namespace

std::string render_timeline(const Manifest& manifest, const Trace& trace,
                            const std::optional<RunTimes>& times) {
  const Frame frame = frame_of(trace);
  return facts(manifest, trace, frame, times) +
         "<h3>Who computed when</h3>\n<p>A bar is a job (its colour the stage), light grey a "
         "worker "
         "that waits, red an attempt that failed or a worker that left.</p>\n<div class=\"wide\">" +
         timeline(frame) + "</div>\n<h3>Done</h3>\n<div class=\"wide\">" +
         progress_chart(frame, trace) + "</div>\n<h3>Workers</h3>\n<div class=\"wide\">" +
         worker_table(frame, trace) + "</div>\n";
}

}  // namespace meshfarm
