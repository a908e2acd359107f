// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <meshfarm/report/simulation_report.hpp>

#include "report/json.hpp"
#include "report/lines.hpp"

namespace meshfarm {
namespace {

constexpr std::size_t k_problems_told = 20;

std::string hex(std::uint64_t value) {
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(value));
  return digits;
}

std::string again(const SeedsSummary& s, std::uint64_t seed) {
  return "meshfarm simulate --seed " + std::to_string(seed) + " --workers " +
         std::to_string(s.workers) + " --jobs " + std::to_string(s.jobs) +
         (s.graph == "run" ? "" : " --graph " + s.graph);
}

std::string as_json(const SeedsSummary& s) {
  Json problems = Json::array();
  for (const auto& each : s.problems) {
    problems.push_back({{"seed", each.seed}, {"what", each.what}, {"again", again(s, each.seed)}});
  }
  const Json json = {{"seeds", s.seeds},           {"workers", s.workers},     {"jobs", s.jobs},
                     {"events", s.events},         {"virtual_s", s.virtual_s}, {"wall_s", s.wall_s},
                     {"trace", hex(s.trace_hash)}, {"problems", problems}};
  return json.dump(2) + "\n";
}

}  // namespace

std::string render(const SeedsSummary& s, Format format) {
  if (format == Format::json) return as_json(s);
  std::string text =
      grouped(s.seeds) + (s.seeds == 1 ? " seed, " : " seeds, ") + grouped(s.workers) +
      " workers, " + grouped(s.jobs) + " jobs: " + grouped(s.events) + " events, " +
      number(s.virtual_s / 60, "%.1f") + " min of virtual time in " + number(s.wall_s, "%.1f") +
      " s, trace " + hex(s.trace_hash) + ", " + grouped(s.problems.size()) + " failed\n";
  for (std::size_t i = 0; i < std::min(s.problems.size(), k_problems_told); ++i) {
    const SeedsSummary::Problem& each = s.problems[i];
    text += "seed " + std::to_string(each.seed) + ": " + each.what + "\n    " +
            again(s, each.seed) + "\n";
  }
  return text;
}

}  // namespace meshfarm
