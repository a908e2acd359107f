// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>

#include <meshfarm/farm/plan.hpp>

namespace meshfarm {
namespace {

/// After this many ineligible jobs in a row another order is tried.
constexpr int k_tries = 256;
/// The same limit when looking for jobs at home.
constexpr int k_tries_at_home = 32;
/// A job at home is preferred if its path is shorter by at most this fraction (1/4) of the other's
/// cost.
constexpr std::uint64_t k_home_share = 4;
constexpr std::uint64_t k_last = std::numeric_limits<std::uint64_t>::max();

/// The first state of a wanted job.
JobState first_state(const Job& job) {
  return job.by_sink ? JobState::running : JobState::ready;
}

}  // namespace

bool Plan::ReadyJob::operator<(const ReadyJob& other) const {
  // The longest path first, so that the last jobs are short; then in the order in which they
  // became wanted.
  if (path != other.path) return path > other.path;
  return order < other.order;
}

void Plan::restart(const std::map<JobKey, JobOutput>& accepted) {
  for (const JobKey key : wanted_) entries_.at(key).wanted = false;
  wanted_.clear();
  ready_.clear();
  by_memory_.clear();
  by_home_.clear();
  by_extent_.clear();
  counts_ = {.retries = counts_.retries};
  graph_ = source_();
  started_ = true;
  want(graph_.begin(), accepted);
}

void Plan::want(std::vector<WantedJob> jobs, const std::map<JobKey, JobOutput>& accepted) {
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const JobKey key = jobs[i].key;
    const auto [found, is_new] = entries_.try_emplace(key);
    Entry& entry = found->second;
    entry.name = jobs[i].name;
    // A result that was made again has another name.
    entry.job = std::move(jobs[i].job);
    if (is_new) {
      entry.order = next_order_++;
      entry.state = first_state(entry.job);
    }
    entry.wanted = true;
    wanted_.push_back(key);
    counts_.cost_known += entry.job.cost;
    if (entry.state == JobState::done) entry.state = first_state(entry.job);
    const auto told = accepted.find(key);
    if (told != accepted.end()) {
      for (WantedJob& each : graph_.accept(key, told->second)) jobs.push_back(std::move(each));
      entry.state = JobState::done;
      counts_.cost_done += entry.job.cost;
    }
    if (entry.state == JobState::ready) add_ready(key, entry);
    count(entry, entry.state);
  }
}

std::optional<IssuedJob> Plan::issue(const JobChoice& choice) {
  const ReadyJob* chosen = choose(choice);
  if (chosen == nullptr) return std::nullopt;
  return issue(chosen->key);
}

IssuedJob Plan::issue(JobKey key) {
  Entry& entry = entries_.at(key);
  assert(entry.state == JobState::ready || entry.state == JobState::running);
  move_to(key, entry, JobState::running);
  ++entry.live;
  ++entry.attempts;
  if (entry.attempts > 1) ++counts_.retries;
  return IssuedJob{key, entry.attempts, entry.job};
}

const Plan::ReadyJob* Plan::choose(const JobChoice& choice) const {
  const ReadyJob* best = longest_way(choice);
  if (best == nullptr || choice.host == 0) return best;
  const HostNumber home_of_best = home(best->extent);
  if (home_of_best == choice.host) return best;
  if (const ReadyJob* job = at_home(choice.host, *best, choice)) return job;
  const ReadyJob* anybodys = home_of_best == 0 ? best : at_home(0, *best, choice);
  return anybodys != nullptr ? anybodys : best;
}

/// Among the jobs whose path is not much shorter than the best one's.
const Plan::ReadyJob* Plan::at_home(HostNumber host, const ReadyJob& best,
                                    const JobChoice& choice) const {
  const auto jobs = by_home_.find(host);
  if (jobs == by_home_.end()) return nullptr;
  auto at = jobs->second.lower_bound(best);
  for (int tries = 0; at != jobs->second.end() && tries < k_tries_at_home; ++at, ++tries) {
    if (best.path - at->path > best.cost / k_home_share) break;
    if (choice.takes(at->key, at->cost, at->memory)) return &*at;
  }
  return nullptr;
}

const Plan::ReadyJob* Plan::longest_way(const JobChoice& choice) const {
  // By longest path; then from where the path no longer exceeds the maximum cost; then by memory.
  const auto short_ways = ready_.lower_bound({choice.max_cost, 0});
  for (auto from = ready_.begin();; from = short_ways) {
    int tries = 0;
    for (auto at = from; at != ready_.end() && tries < k_tries; ++at, ++tries) {
      if (choice.takes(at->key, at->cost, at->memory)) return &*at;
    }
    if (tries < k_tries) return nullptr;
    if (from == short_ways) break;
  }
  auto at = by_memory_.upper_bound({choice.max_memory, ReadyJob{0, k_last}});
  for (int tries = 0; at != by_memory_.begin() && tries < k_tries; ++tries) {
    const ReadyJob& job = (--at)->second;
    if (choice.takes(job.key, job.cost, job.memory)) return &job;
  }
  return nullptr;
}

Plan::ReadyJob Plan::ready_job(JobKey key, const Entry& entry) {
  const Job& job = entry.job;
  return {job.cost + job.after, entry.order, key, job.cost, job.memory, job.extent.name};
}

HostNumber Plan::home(std::uint64_t extent) const {
  const auto found = homes_.find(extent);
  return found == homes_.end() ? 0 : found->second;
}

void Plan::set_home(std::uint64_t extent, HostNumber host) {
  const HostNumber before = home(extent);
  if (before == host) return;
  homes_[extent] = host;
  std::set<ReadyJob>& to = by_home_[host];
  for (auto at = by_extent_.lower_bound({extent, JobKey{0}});
       at != by_extent_.end() && at->first == extent; ++at) {
    to.insert(by_home_.at(before).extract(ready_job(at->second, entries_.at(at->second))));
  }
}

std::vector<JobKey> Plan::ready_jobs() const {
  std::vector<JobKey> jobs;
  for (const ReadyJob& job : ready_) jobs.push_back(job.key);
  return jobs;
}

std::uint64_t Plan::ready_above(std::uint64_t memory) const {
  std::uint64_t count = 0;
  for (auto at = by_memory_.rbegin(); at != by_memory_.rend() && at->first > memory; ++at) ++count;
  return count;
}

void Plan::give_back(JobKey key) {
  const auto found = entries_.find(key);
  if (found == entries_.end() || found->second.live == 0) return;
  --found->second.live;
  if (found->second.state == JobState::running && found->second.live == 0) {
    move_to(key, found->second, JobState::ready);
  }
}

void Plan::fail_attempt(JobKey key, const std::string& reason, Failing failing) {
  const auto found = entries_.find(key);
  if (found == entries_.end()) return;
  Entry& entry = found->second;
  const bool for_good = failing == Failing::for_good;
  const bool open = entry.state == JobState::running || entry.state == JobState::ready;
  if (entry.live > 0) --entry.live;
  if (!open || (entry.state == JobState::ready && !for_good)) return;
  entry.failures.push_back(reason);
  entry.resumable = failing == Failing::worker_lost || failing == Failing::unread;
  if (for_good || entry.failures.size() >= max_attempts_) {
    move_to(key, entry, JobState::failed);
  } else if (entry.live == 0) {
    move_to(key, entry, JobState::ready);
  }
}

void Plan::forgive(JobKey key, const std::string& reason) {
  const auto found = entries_.find(key);
  if (found == entries_.end()) return;
  Entry& entry = found->second;
  if (std::erase(entry.failures, reason) == 0 || entry.state != JobState::failed) return;
  if (entry.failures.size() < max_attempts_) move_to(key, entry, JobState::ready);
}

bool Plan::accept(JobKey key, const JobOutput& output) {
  if (!graph_.waits_for(key)) return false;
  Entry& entry = entries_.at(key);
  move_to(key, entry, JobState::done);
  counts_.cost_done += entry.job.cost;
  want(graph_.accept(key, output), {});
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
  std::vector<LostJob> all;
  for (const JobKey key : wanted_) {
    if (entries_.at(key).state == JobState::failed) all.push_back(lost(key));
  }
  return all;
}

LostJob Plan::lost(JobKey key) const {
  const Entry& entry = entries_.at(key);
  // Attempts mostly fail for the same reason: it is reported once.
  std::string reasons;
  for (auto at = entry.failures.begin(); at != entry.failures.end(); ++at) {
    if (std::find(entry.failures.begin(), at, *at) != at) continue;
    if (!reasons.empty()) reasons += "; ";
    reasons += *at;
  }
  return {key, entry.job.kind, reasons, entry.resumable};
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
  // A job that the restarted run has not reached yet is remembered, but neither counted nor issued.
  if (entry.wanted) {
    count_no_more(entry);
    count(entry, state);
    if (entry.state == JobState::ready) remove_ready(key, entry);
    if (state == JobState::ready) add_ready(key, entry);
  }
  entry.state = state;
}

void Plan::add_ready(JobKey key, const Entry& entry) {
  const ReadyJob job = ready_job(key, entry);
  ready_.insert(job);
  if (job.memory != 0) by_memory_.insert({job.memory, job});
  by_home_[home(job.extent)].insert(job);
  if (job.extent != 0) by_extent_.insert({job.extent, key});
  counts_.cost_ready += job.cost;
}

void Plan::remove_ready(JobKey key, const Entry& entry) {
  const ReadyJob job = ready_job(key, entry);
  ready_.erase(job);
  if (job.memory != 0) by_memory_.erase({job.memory, job});
  by_home_.at(home(job.extent)).erase(job);
  by_extent_.erase({job.extent, key});
  counts_.cost_ready -= job.cost;
}

void Plan::count(const Entry& entry, JobState state) {
  ++count_of(state);
  if (entry.job.by_sink && state == JobState::running) ++counts_.at_sink;
}

void Plan::count_no_more(const Entry& entry) {
  assert(count_of(entry.state) > 0);
  --count_of(entry.state);
  if (entry.job.by_sink && entry.state == JobState::running) --counts_.at_sink;
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
