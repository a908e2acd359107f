// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/farm/job_graph.hpp>

namespace meshfarm::test {

/// The jobs that become possible once these are accepted, except those accepted themselves, sorted
/// by name.
inline std::vector<Job> next_jobs(const JobSource& source, std::span<const AcceptedJob> accepted) {
  std::map<JobKey, const JobOutput*> outputs;
  for (const AcceptedJob& each : accepted) outputs[each.key] = &each.output;
  JobGraph graph = source();
  std::vector<WantedJob> open;
  std::vector<WantedJob> jobs = graph.begin();
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const auto found = outputs.find(jobs[i].key);
    if (found == outputs.end()) {
      open.push_back(jobs[i]);
      continue;
    }
    for (WantedJob& each : graph.accept(jobs[i].key, *found->second)) {
      jobs.push_back(std::move(each));
    }
  }
  std::sort(open.begin(), open.end(),
            [](const WantedJob& a, const WantedJob& b) { return a.name < b.name; });
  std::vector<Job> next;
  for (WantedJob& each : open) next.push_back(std::move(each.job));
  return next;
}

}  // namespace meshfarm::test
