// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/report/planning_report.hpp>
#include <meshfarm/report/timeline.hpp>

#include "report/svg.hpp"

namespace meshfarm {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

PlanSummary plan() {
  PlanSummary plan;
  plan.stage = "stage";
  plan.scheme = "cut";
  plan.triangles_in = 1'000'000;
  plan.triangles_out = 10'000;
  plan.jobs = 64;
  plan.schedule = "dynamic";
  plan.cut_s = 1;
  plan.assemble_s = 1;
  plan.one_s = 46;
  plan.lines = {{"24", 2, 1.9, 23, 0.5}};
  return plan;
}

TEST_CASE("a plan names the whole run beside the farmed phase, and its serial share") {
  const std::string text = render(plan(), Format::text);
  CHECK(has(text, "together 4.2 % of the whole"));  // 2 of 48
  CHECK(has(text, "23.00"));
  CHECK(has(text, "12.00"));  // 48 / 4
  CHECK(has(text, "50 %"));
  CHECK(has(render(plan(), Format::json), "\"whole_speed_up\": 12.0"));
}

TEST_CASE("the paper's table has a column a mesh") {
  PlanSummary other = plan();
  other.stage = "other";
  const std::string text = render_paper_table({plan(), other});
  CHECK(has(text, "Table 1 (cutting), simulated on 24 workers"));
  CHECK(has(text, "stage"));
  CHECK(has(text, "other"));
  CHECK(has(text, "1,000,000"));
  CHECK(has(text, "12.00"));
  other.scheme = "stream";
  CHECK(has(render_paper_table({other}), "Table 2 (streams)"));
}

TEST_CASE("the figure has a line a schedule, in text and as a picture") {
  ScheduleComparison comparison;
  comparison.farm = "16 fast & 8 slow";
  comparison.off = 0.2;
  comparison.lines = {{128, 1, 1.05, 1.1, 1, 1.1, 1.3}, {256, 2, 2.04, 2.1, 2, 2.1, 2.5}};
  const std::string text = render(comparison, Format::text);
  CHECK(has(text, "up to 20 % off"));
  CHECK(has(text, "1.020"));
  CHECK(has(text, "1.250"));
  const std::string picture = draw(comparison);
  CHECK(has(picture, "16 fast &amp; 8 slow"));
  CHECK(has(picture, "static, speeds off, 256 jobs: 1.250"));
  CHECK(picture.ends_with("</svg>\n"));
}

TEST_CASE("a run's page shows each job, and merges what cannot be told apart") {
  Trace trace;
  trace.joined = {{0, 1, "<host>", 5, 0, 0, 1}};
  for (int i = 0; i < 10; ++i) {
    TraceDone job;
    job.t = 1 + i;
    job.worker = 1;
    job.triangles = 1000;
    job.compute_ms = 900;
    trace.done.push_back(job);
  }
  Manifest manifest;
  manifest.input = "mesh.ply";
  const auto bars = [](const std::string& page) {
    std::size_t count = 0;
    for (std::size_t at = page.find("<title>a job"); at != std::string::npos;
         at = page.find("<title>a job", at + 1)) {
      ++count;
    }
    return count;
  };
  std::string page = render_timeline(manifest, trace, std::nullopt);
  CHECK(bars(page) == 10);
  CHECK(has(page, "&lt;host&gt;"));
  CHECK_FALSE(has(page, "<host>"));
  CHECK(has(page, "not yet"));
  for (int i = 0; i < 20'000; ++i) {
    TraceDone job;
    job.t = 11 + i * 0.001;
    job.worker = 1;
    job.triangles = 10;
    job.compute_ms = 1;
    trace.done.push_back(job);
  }
  page = render_timeline(manifest, trace, RunTimes{});
  CHECK(page.size() < 500'000);
  CHECK(has(page, "20,010 jobs by 1 workers"));
}

TEST_CASE("steps of an axis are round") {
  CHECK(round_step(1, 10) == doctest::Approx(0.1));
  CHECK(round_step(1.2, 10) == doctest::Approx(0.2));
  CHECK(round_step(47, 10) == doctest::Approx(5));
  CHECK(round_step(0, 10) == 1);
}

}  // namespace
}  // namespace meshfarm
