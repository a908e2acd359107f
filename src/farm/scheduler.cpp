// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include <meshfarm/farm/scheduler.hpp>

namespace meshfarm {
namespace {

constexpr std::uint32_t k_failures_of_a_bad_host = 3;
/// Failures on a host within this time count as one incident.
constexpr FarmTime k_incident = std::chrono::seconds(10);
/// After this a bad host gets another chance; after one more incident it is bad again.
constexpr FarmTime k_ban = std::chrono::minutes(5);
/// For workers that do not report a speed.
constexpr double k_usual_speed = 1e6;
/// A buffer never gets smaller than this, in seconds: it must outlast a message's travel time.
constexpr double k_least_buffer = 0.01;
/// Added to the load of workers that hold enough to read ahead: more seconds than any load.
constexpr double k_second_rank = 1e6;
/// A job goes to its home only if the worker there has at least this fraction of the other's speed.
constexpr double k_about_as_fast = 0.75;
constexpr std::uint64_t k_no_limit = std::numeric_limits<std::uint64_t>::max();

/// The limit for a worker that reports this memory.
std::uint64_t limit_of(std::uint64_t memory) {
  return memory == 0 ? k_no_limit : memory;
}

}  // namespace

void Scheduler::join(WorkerId id, const std::string& host, const Capacity& capacity) {
  Member& member = crew_[id];
  member.host = &hosts_[host];
  member.host->name = host;
  if (member.host->number == 0) {
    host_of_number_.push_back(member.host);
    member.host->number = static_cast<HostNumber>(host_of_number_.size());
  }
  member.threads = std::clamp<std::uint32_t>(capacity.threads, 1, 4096);
  member.memory = capacity.memory;
  if (capacity.memory_pool != 0 && capacity.memory != 0) {
    member.pool = &pools_[{host, capacity.memory_pool}];
    ++member.pool->workers;
  }
  member.benchmark = capacity.speed == 0 ? k_usual_speed : static_cast<double>(capacity.speed);
  member.speed = estimated_speed(member);
  member.host->workers.insert(id);
  member.host->memories.insert(limit_of(member.memory));
  undealt_.clear();
  outlook_.valid_until = FarmTime(-1);
}

std::vector<Scheduler::Held> Scheduler::leave(WorkerId id) {
  const auto found = crew_.find(id);
  set_room(id, 0);
  std::vector<Held> held = found->second.held;
  for (const Held& each : held) {
    auto& holders = holders_.at(each.key);
    std::erase(holders, id);
    if (holders.empty()) holders_.erase(each.key);
  }
  Host& host = *found->second.host;
  host.workers.erase(id);
  host.memories.erase(host.memories.find(limit_of(found->second.memory)));
  leave_pool(found->second);
  crew_.erase(found);
  if (const auto set = sets_.extract(id); !set.empty()) {
    for (const JobKey key : set.mapped()) dealt_.erase(key);
  }
  outlook_.valid_until = FarmTime(-1);
  const bool any_bad = std::any_of(hosts_.begin(), hosts_.end(),
                                   [&](const auto& each) { return !good(each.second); });
  if (any_bad) bans_changed();  // a bad host may be the only one now
  return held;
}

void Scheduler::set_room(WorkerId id, std::uint64_t jobs) {
  Member& member = crew_.at(id);
  member.room = jobs;
  rank(id, member);
}

bool Scheduler::drop(WorkerId id, JobKey key, FarmTime now) {
  Member& member = crew_.at(id);
  const auto at = std::find_if(member.held.begin(), member.held.end(),
                               [&](const Held& each) { return each.key == key; });
  if (at == member.held.end()) return false;
  member.cost_held -= static_cast<double>(at->cost);
  member.held.erase(at);
  if (member.held.empty()) member.cost_held = 0;
  pool_dropped(member);
  auto& holders = holders_.at(key);
  std::erase(holders, id);
  if (holders.empty()) holders_.erase(key);
  begin_turns(member, now);
  rank(id, member);
  return true;
}

void Scheduler::avoid(WorkerId id, JobKey key) {
  const std::string& host = crew_.at(id).host->name;
  auto& hosts = failed_on_[key];
  if (std::find(hosts.begin(), hosts.end(), host) == hosts.end()) hosts.push_back(host);
}

void Scheduler::failed(WorkerId id, FarmTime now) {
  host_failed(crew_.at(id).host->name, now);
}

void Scheduler::host_failed(const std::string& name, FarmTime now) {
  const auto found = hosts_.find(name);
  if (found == hosts_.end()) return;
  Host& host = found->second;
  if (host.failures > 0 && now - host.incident < k_incident) return;
  host.incident = now;
  if (++host.failures != k_failures_of_a_bad_host) return;
  next_ban_end_ = std::min(next_ban_end_, now + k_ban);
  bans_changed();
}

void Scheduler::end_bans(FarmTime now) {
  if (now < next_ban_end_) return;
  next_ban_end_ = FarmTime::max();
  for (auto& [name, host] : hosts_) {
    if (good(host)) continue;
    if (now - host.incident >= k_ban) {
      host.failures = k_failures_of_a_bad_host - 1;
    } else {
      next_ban_end_ = std::min(next_ban_end_, host.incident + k_ban);
    }
  }
  bans_changed();
}

/// The set of workers that may be sent jobs has changed.
void Scheduler::bans_changed() {
  undealt_.clear();
  rank_all();
}

void Scheduler::settled(JobKey key) {
  suspects_.erase(key);
  failed_on_.erase(key);
}

bool Scheduler::good(const Host& host) const {
  return host.failures < k_failures_of_a_bad_host;
}

/// Whether a good host that is not in the list has workers with this much memory.
bool Scheduler::elsewhere(const std::vector<std::string>& hosts, std::uint64_t memory) const {
  return std::any_of(hosts_.begin(), hosts_.end(), [&](const auto& each) {
    const Host& host = each.second;
    return !host.workers.empty() && *host.memories.rbegin() >= memory && good(host) &&
           std::find(hosts.begin(), hosts.end(), each.first) == hosts.end();
  });
}

std::vector<std::string> Scheduler::bad_hosts() const {
  std::vector<std::string> bad;
  for (const auto& [name, host] : hosts_) {
    if (!good(host) && elsewhere({name})) bad.push_back(name);
  }
  return bad;
}

std::optional<std::uint64_t> Scheduler::greatest_memory() const {
  if (crew_.empty()) return std::nullopt;
  std::uint64_t greatest = 0;
  for (const auto& [id, member] : crew_) {
    greatest = std::max(greatest, limit_of(member.memory));
  }
  return greatest;
}

std::vector<WorkerId> Scheduler::holders(JobKey key) const {
  const auto found = holders_.find(key);
  return found == holders_.end() ? std::vector<WorkerId>{} : found->second;
}

bool Scheduler::serves(const Member& member) const {
  return good(*member.host) || !elsewhere({member.host->name});
}

/// Whether the worker may be sent anything at all.
bool Scheduler::open(const Member& member) const {
  if (member.room == 0 || !serves(member)) return false;
  const Pool* pool = member.pool;
  return pool == nullptr || pool->by_itself == nullptr || pool->by_itself == &member;
}

void Scheduler::rank_all() {
  for (auto& [id, member] : crew_) rank(id, member);
}

void Scheduler::rank(WorkerId id, Member& member) {
  std::optional<double> rank;
  if (open(member)) {
    rank = member.cost_held / (member.speed * member.threads);
    if (member.held.size() > member.threads) *rank += k_second_rank;
  }
  if (rank == member.rank) return;
  decltype(willing_)::node_type node;
  if (member.rank) node = willing_.extract({*member.rank, id});
  member.rank = rank;
  if (!rank) return;
  if (node.empty()) {
    willing_.insert({*rank, id});
  } else {
    node.value().first = *rank;
    willing_.insert(std::move(node));
  }
}

std::uint64_t Scheduler::share(const Member& member) const {
  return member.pool == nullptr ? member.memory : member.memory / member.pool->workers;
}

std::uint64_t Scheduler::memory_share(WorkerId id) const {
  const Member& member = crew_.at(id);
  const bool all = member.pool != nullptr && member.pool->by_itself == &member;
  return all ? member.memory : share(member);
}

/// The largest memory need of a job that this worker may be given now.
std::uint64_t Scheduler::memory_now(const Member& member) const {
  if (member.memory == 0) return k_no_limit;
  const std::uint32_t itself = member.held.empty() ? 0 : 1;
  const bool others = member.pool != nullptr && member.pool->at_work > itself;
  return others ? share(member) : member.memory;
}

bool Scheduler::fits(const Member& member, std::uint64_t memory) const {
  return memory <= memory_now(member);
}

void Scheduler::pool_holds(Member& member, std::uint64_t memory) {
  if (member.pool == nullptr) return;
  if (member.held.size() == 1) ++member.pool->at_work;
  if (memory <= share(member)) return;
  member.pool->by_itself = &member;
  rank_all();
}

void Scheduler::pool_dropped(Member& member) {
  if (member.pool == nullptr) return;
  if (member.held.empty()) --member.pool->at_work;
  const std::uint64_t even = share(member);
  const bool large = std::any_of(member.held.begin(), member.held.end(),
                                 [&](const Held& each) { return each.memory > even; });
  if (large || member.pool->by_itself != &member) return;
  member.pool->by_itself = nullptr;
  rank_all();
}

void Scheduler::leave_pool(Member& member) {
  if (member.pool == nullptr) return;
  if (!member.held.empty()) --member.pool->at_work;
  --member.pool->workers;
  if (member.pool->by_itself != &member) return;
  member.pool->by_itself = nullptr;
  rank_all();
}

/// A job is retried on a host where it failed only if no other host could do it.
bool Scheduler::may_on_host(const Member& member, JobKey key, std::uint64_t memory) const {
  const auto failed = failed_on_.find(key);
  if (failed == failed_on_.end()) return true;
  const auto& hosts = failed->second;
  const bool here = std::find(hosts.begin(), hosts.end(), member.host->name) != hosts.end();
  return !here || !elsewhere(hosts, memory);
}

bool Scheduler::has_other_suspect(const Member& member, JobKey key) const {
  const auto is_one = [&](const Held& held) { return suspects_.contains(held.key); };
  return suspects_.contains(key) && std::any_of(member.held.begin(), member.held.end(), is_one);
}

bool Scheduler::may(const Member& member, JobKey key, std::uint64_t memory) const {
  return !has_other_suspect(member, key) && may_on_host(member, key, memory);
}

void Scheduler::begin_turns(Member& member, FarmTime now) {
  for (std::size_t i = 0; i < std::min<std::size_t>(member.held.size(), member.threads); ++i) {
    if (!member.held[i].since) member.held[i].since = now;
  }
}

/// The first host that reads an extent is its home, as long as the host has workers.
void Scheduler::find_home(Plan& plan, std::uint64_t extent, const Host& host) const {
  if (extent == 0) return;
  const HostNumber before = plan.home(extent);
  if (before != 0 && !host_of_number_[before - 1]->workers.empty()) return;
  plan.set_home(extent, host.number);
}

/// Chooses who gets a job that this worker could do: a worker on the job's home host, if it is
/// about as fast and has no more to do before the job; else this one.
WorkerId Scheduler::at_home(WorkerId id, const IssuedJob& job, const Plan& plan,
                            FarmTime now) const {
  const Member& first = crew_.at(id);
  const HostNumber home = plan.home(job.job.extent.name);
  if (home == 0 || home == first.host->number) return id;
  const auto is_as_good = [&](WorkerId each) {
    const Member& member = crew_.at(each);
    if (!member.rank || *member.rank > *first.rank) return false;
    if (member.speed < k_about_as_fast * first.speed) return false;
    return choice_for(member, plan, now).takes(job.key, job.job.cost, job.job.memory);
  };
  const std::set<WorkerId>& there = host_of_number_[home - 1]->workers;
  const auto found = std::find_if(there.begin(), there.end(), is_as_good);
  return found == there.end() ? id : *found;
}

Scheduler::Pick Scheduler::hand(Plan& plan, WorkerId id, IssuedJob job, FarmTime now) {
  Member& member = crew_.at(id);
  find_home(plan, job.job.extent.name, *member.host);
  assert(member.room > 0);
  --member.room;
  member.held.push_back(
      {job.key, job.attempt, job.job.cost, job.job.memory, job.job.kind, std::nullopt});
  pool_holds(member, job.job.memory);
  member.cost_held += static_cast<double>(job.job.cost);
  holders_[job.key].push_back(id);
  begin_turns(member, now);
  rank(id, member);
  return {id, std::move(job)};
}

/// Which jobs the worker may be given. If all workers are on one host, none is preferred.
JobChoice Scheduler::choice_for(const Member& member, const Plan& plan, FarmTime now) const {
  JobChoice choice;
  choice.max_cost = greatest_cost(member, now);
  choice.max_memory = memory_now(member);
  const bool all_welcome = suspects_.empty() && failed_on_.empty();
  if (!all_welcome) {
    choice.may = [&](JobKey key) { return may(member, key, plan.job(key).memory); };
  }
  if (member.host->workers.size() < crew_.size()) choice.host = member.host->number;
  return choice;
}

std::optional<Scheduler::Pick> Scheduler::next(Plan& plan, FarmTime now) {
  if (plan.counts().ready == 0 || crew_.empty()) return std::nullopt;
  end_bans(now);
  if (options_.schedule == Schedule::fixed) return next_fixed(plan, now);
  const double left = outlook(plan, now).all_done;
  const double full = std::max(k_least_buffer, std::min(seconds(options_.horizon), left / 4));
  while (!willing_.empty()) {
    const auto [load, id] = *willing_.begin();
    if (load >= k_second_rank + full) return std::nullopt;
    Member& member = crew_.at(id);
    const JobChoice choice = choice_for(member, plan, now);
    if (auto job = plan.issue(choice)) {
      return hand(plan, at_home(id, *job, plan, now), std::move(*job), now);
    }
    willing_.erase(willing_.begin());  // nothing for it before the next outlook
    member.rank.reset();
  }
  return std::nullopt;
}

}  // namespace meshfarm
