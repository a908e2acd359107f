// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/farm/job.hpp>

namespace meshfarm::test {

inline Job make_job(const std::string& name, std::uint64_t cost = 1) {
  return {"test", {}, name, cost};
}

inline std::vector<Job> make_jobs(std::size_t count, const std::string& prefix = "job ") {
  std::vector<Job> jobs;
  for (std::size_t i = 0; i < count; ++i) jobs.push_back(make_job(prefix + std::to_string(i), i));
  return jobs;
}

/// One round of `count` jobs.
inline JobSource one_round(std::size_t count) {
  return [count](std::span<const AcceptedJob> accepted) {
    return accepted.empty() ? make_jobs(count) : std::vector<Job>{};
  };
}

}  // namespace meshfarm::test
