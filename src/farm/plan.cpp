// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>

#include <meshfarm/farm/plan.hpp>

namespace meshfarm {

bool Plan::ReadyJob::operator<(const ReadyJob& other) const {
  // The largest first, so that the last jobs of a round are short; then as asked for.
  if (cost != other.cost) return cost > other.cost;
  return order < other.order;
}

void Plan::restart(const std::map<JobKey, JobOutput>& accepted) {
  for (const JobKey key : wanted_) entries_.at(key).wanted = false;
  wanted_.clear();
  ready_.clear();
  counts_ = {.retries = counts_.retries};
  rounds_ = Rounds(source_);
  started_ = true;
  advance(accepted);
}

void Plan::advance(const std::map<JobKey, JobOutput>& accepted) {
  for (std::vector<Job> jobs = rounds_.advance(); !jobs.empty(); jobs = rounds_.advance()) {
    for (Job& job : jobs) {
      const JobKey key = key_of(job);
      const auto [found, is_new] = entries_.try_emplace(key);
      Entry& entry = found->second;
      if (is_new) {
        entry.order = next_order_++;
        entry.job = std::move(job);
      }
      entry.wanted = true;
      wanted_.push_back(key);
      counts_.cost_known += entry.job.cost;
      if (entry.state == JobState::done) entry.state = JobState::ready;
      const auto told = accepted.find(key);
      if (told != accepted.end()) {
        rounds_.accept(key, told->second);
        entry.state = JobState::done;
        counts_.cost_done += entry.job.cost;
      }
      ++count_of(entry.state);
      if (entry.state == JobState::ready) ready_.insert({entry.job.cost, entry.order, key});
    }
  }
}

std::optional<IssuedJob> Plan::issue() {
  if (ready_.empty()) return std::nullopt;
  const JobKey key = ready_.begin()->key;
  Entry& entry = entries_.at(key);
  move_to(key, entry, JobState::running);
  ++entry.attempts;
  if (entry.attempts > 1) ++counts_.retries;
  return IssuedJob{key, entry.attempts, entry.job};
}

void Plan::give_back(JobKey key) {
  const auto found = entries_.find(key);
  if (found == entries_.end() || found->second.state != JobState::running) return;
  move_to(key, found->second, JobState::ready);
}

void Plan::fail_attempt(JobKey key, const std::string& reason, bool for_good) {
  const auto found = entries_.find(key);
  if (found == entries_.end()) return;
  Entry& entry = found->second;
  const bool open = entry.state == JobState::running || entry.state == JobState::ready;
  if (!open || (entry.state == JobState::ready && !for_good)) return;
  entry.failures.push_back(reason);
  const bool give_up = for_good || entry.failures.size() >= max_attempts_;
  move_to(key, entry, give_up ? JobState::failed : JobState::ready);
}

void Plan::forgive(JobKey key, const std::string& reason) {
  const auto found = entries_.find(key);
  if (found == entries_.end()) return;
  Entry& entry = found->second;
  if (std::erase(entry.failures, reason) == 0 || entry.state != JobState::failed) return;
  if (entry.failures.size() < max_attempts_) move_to(key, entry, JobState::ready);
}

bool Plan::accept(JobKey key, const JobOutput& output) {
  if (!rounds_.accept(key, output)) return false;
  Entry& entry = entries_.at(key);
  move_to(key, entry, JobState::done);
  counts_.cost_done += entry.job.cost;
  advance({});
  return true;
}

std::optional<JobState> Plan::state(JobKey key) const {
  const auto found = entries_.find(key);
  if (found == entries_.end()) return std::nullopt;
  return found->second.state;
}

std::uint32_t Plan::attempts(JobKey key) const {
  const auto found = entries_.find(key);
  return found == entries_.end() ? 0 : found->second.attempts;
}

bool Plan::stuck() const {
  return started_ && counts_.failed > 0 && counts_.ready == 0 && counts_.running == 0;
}

std::vector<LostJob> Plan::lost() const {
  std::vector<LostJob> lost;
  for (const JobKey key : wanted_) {
    const Entry& entry = entries_.at(key);
    if (entry.state != JobState::failed) continue;
    // Attempts mostly fail for the same reason: it is told once.
    std::string reasons;
    for (auto at = entry.failures.begin(); at != entry.failures.end(); ++at) {
      if (std::find(entry.failures.begin(), at, *at) != at) continue;
      if (!reasons.empty()) reasons += "; ";
      reasons += *at;
    }
    lost.push_back({key, entry.job.kind, reasons});
  }
  return lost;
}

std::string failed_for_good(std::span<const std::string> reasons) {
  constexpr std::size_t k_told = 3;
  std::string line = std::to_string(reasons.size()) +
                     (reasons.size() == 1 ? " job failed for good: " : " jobs failed for good: ");
  for (std::size_t i = 0; i < std::min(reasons.size(), k_told); ++i) {
    if (i > 0) line += "; ";
    line += reasons[i];
  }
  if (reasons.size() > k_told) line += "; and so on";
  return line;
}

void Plan::move_to(JobKey key, Entry& entry, JobState state) {
  // A job that no round reached since the restart wants is remembered, but neither counted nor
  // issued.
  if (entry.wanted) {
    assert(count_of(entry.state) > 0);
    --count_of(entry.state);
    ++count_of(state);
    const ReadyJob place{entry.job.cost, entry.order, key};
    if (entry.state == JobState::ready) ready_.erase(place);
    if (state == JobState::ready) ready_.insert(place);
  }
  entry.state = state;
}

std::uint64_t& Plan::count_of(JobState state) {
  switch (state) {
    case JobState::ready:
      return counts_.ready;
    case JobState::running:
      return counts_.running;
    case JobState::done:
      return counts_.done;
    case JobState::failed:
      break;
  }
  return counts_.failed;
}

}  // namespace meshfarm
