// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/farm/rounds.hpp>

namespace meshfarm {

std::vector<WantedJob> Rounds::advance() {
  std::vector<WantedJob> fresh;
  while (!complete_ && jobs_accepted_ == entries_.size() && fresh.empty()) {
    for (const JobKey key : round_) outputs_.push_back({key, entries_.at(key).output});
    round_.clear();
    std::vector<Job> jobs = source_(outputs_);
    complete_ = jobs.empty();
    entries_.reserve(entries_.size() + jobs.size());
    for (Job& job : jobs) {
      const JobKey key = key_of(job);
      round_.push_back(key);
      if (entries_.try_emplace(key).second) fresh.push_back({key, std::move(job)});
    }
  }
  return fresh;
}

bool Rounds::accept(JobKey key, const JobOutput& output) {
  const auto found = entries_.find(key);
  if (found == entries_.end() || found->second.accepted) return false;
  found->second = {true, output};
  ++jobs_accepted_;
  return true;
}

const JobOutput* Rounds::accepted(JobKey key) const {
  const auto found = entries_.find(key);
  return found != entries_.end() && found->second.accepted ? &found->second.output : nullptr;
}

}  // namespace meshfarm
