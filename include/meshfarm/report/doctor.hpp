// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <meshfarm/report/summary.hpp>
#include <meshfarm/staging/file_system.hpp>

namespace meshfarm {

/// Facts about a stage and the host that looks at it.
struct DoctorFacts {
  std::string stage;
  Mount mount;
  std::uint64_t free_bytes = 0;
  std::uint64_t part_bytes = 0;  // of all parts; 0: nothing was cut yet
  FolderProbe probe;
  std::string host;                        // this host's name
  std::vector<std::string> hosts;          // hosts that worked on the stage
  std::vector<std::string> doubled_names;  // names that two of them had at the same time
  std::uint64_t file_limit = 0;            // file descriptors that a process may have
  std::uint32_t workers = 0;               // that are to join
  std::uint32_t files_per_worker = 0;      // file descriptors per worker in the ventilator
};

/// good: as it should be. note: works, but you should know this. bad: change it before a run.
enum class Verdict { good, note, bad };

struct Finding {
  std::string check;
  Verdict verdict = Verdict::good;
  std::string found;
  std::string advice;  // what to change; empty: nothing
};

/// What the facts mean for a run (mount options: nfs(5)).
std::vector<Finding> diagnose(const DoctorFacts& facts);
bool is_healthy(const std::vector<Finding>& findings);

std::string render(const DoctorFacts& facts, const std::vector<Finding>& findings, Format format);

}  // namespace meshfarm
