// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The scheduler's estimates of worker speeds and remaining work, and the decisions based on them
// near the end of a run.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <meshfarm/farm/scheduler.hpp>

namespace meshfarm {
namespace {

/// An outlook is valid for this fraction of the remaining time...
constexpr double k_outlook_share = 1.0 / 16;
/// ...and long enough that a large crew is not scanned all the time.
constexpr std::size_t k_members_per_ms = 400;
/// How often second attempts are considered. One must finish earlier than the first by at least
/// this many seconds, and by this fraction of the first's remaining time.
constexpr FarmTime k_second_attempts_every{100};
constexpr double k_least_gain = 0.1;
constexpr double k_least_gain_share = 0.1;
/// A late attempt is expected to go on for this multiple of its lateness: at one and a half times
/// its estimate a second attempt pays.
constexpr double k_lateness = 2;
/// Workers of one host are equally fast, and a second attempt there slows down the first: of the
/// jobs that have begun, only one that is late by this many seconds may be stuck.
constexpr double k_late_on_host = 10;
/// This many jobs of a kind in work show how long they take before one is done, up to this many
/// seconds beyond the estimate: what holds all of them up may be their hosts.
constexpr std::size_t k_enough_in_work = 3;
constexpr double k_patience = 10;
/// A job that takes more than this many times as long as usual says nothing about how long jobs
/// take.
constexpr double k_outlier = 10;
/// An idle worker with at least this fraction of the fastest speed leaves no job to a faster one.
constexpr double k_about_the_fastest = 0.75;

}  // namespace

void Scheduler::did(WorkerId id, JobKey key, std::uint32_t compute_ms, FarmTime now) {
  Member& member = crew_.at(id);
  const bool was_bad = !good(*member.host);
  member.host->failures = 0;
  if (was_bad) bans_changed();
  const auto at = std::find_if(member.held.begin(), member.held.end(),
                               [&](const Held& each) { return each.key == key; });
  if (at == member.held.end() || at->cost == 0) return;
  const double since = at->since ? seconds(now - *at->since) : 0;
  if (at->since) {
    Pace& pace = paces_[at->kind];
    pace.took += since;
    pace.thought += static_cast<double>(at->cost) / member.speed;
  }
  const double took = compute_ms != 0 ? compute_ms / 1000.0 : since;
  if (took <= 0) return;
  const auto cost = static_cast<double>(at->cost);
  Pace& kind = benchmark_paces_[at->kind];
  double counted = took;
  if (kind.thought > 0) {
    counted = std::min(took, k_outlier * kind.took / kind.thought * cost / member.benchmark);
  }
  kind.took += member.benchmark * took;
  kind.thought += cost;
  member.expected_done += cost / member.benchmark * kind.took / kind.thought;
  member.seconds_done += took;
  seconds_done_ += counted;
  squares_done_ += counted * counted;
  member.speed = estimated_speed(member);
}

/// The worker's speed relative to others at jobs of the same kinds: costs are only estimates, and a
/// worker is not faster because its jobs were of a kind that takes less than estimated. The
/// benchmark, corrected by the average ratio of actual to benchmark speed over all workers, weighs
/// as much as one typical job (the mean, weighted by time).
double Scheduler::estimated_speed(const Member& member) const {
  if (seconds_done_ == 0) return member.benchmark;
  Pace all;
  for (const auto& [kind, pace] : benchmark_paces_) {
    all.took += pace.took;
    all.thought += pace.thought;
  }
  const double average = member.benchmark * all.thought / all.took;
  const double weight = squares_done_ / seconds_done_;
  return average * (member.expected_done + weight) / (member.seconds_done + weight);
}

double Scheduler::seconds_left(const Member& member, const Held& held, FarmTime now,
                               double times) const {
  const double whole = times * static_cast<double>(held.cost) / member.speed;
  if (!held.since) return whole;
  const double late = seconds(now - *held.since) - whole;
  return late <= 0 ? -late : k_lateness * late;
}

double Scheduler::seconds_held(const Member& member, FarmTime now) const {
  double sum = 0;
  double longest = 0;
  for (const Held& held : member.held) {
    const double left = seconds_left(member, held, now);
    sum += left;
    longest = std::max(longest, left);
  }
  return std::max(sum / member.threads, longest);
}

const Scheduler::Outlook& Scheduler::outlook(const Plan& plan, FarmTime now) {
  const bool more_work = plan.counts().cost_ready > outlook_.cost_ready;
  if (now < outlook_.valid_until && !more_work) return outlook_;
  outlook_ = {};
  outlook_.cost_ready = plan.counts().cost_ready;
  outlook_.now = now;
  double work = static_cast<double>(plan.counts().cost_ready);
  double power = 0;
  for (auto& [id, member] : crew_) {
    member.speed = estimated_speed(member);
    if (!member.rank) rank(id, member);
    const double held = seconds_held(member, now);
    if (held == 0 && !serves(member)) continue;
    work += held * member.speed * member.threads;
    power += member.speed * member.threads;
    outlook_.last_free = std::max(outlook_.last_free, held);
    outlook_.fastest = std::max(outlook_.fastest, member.speed);
  }
  outlook_.all_done = power > 0 ? work / power : 0;
  const auto valid = static_cast<FarmTime::rep>(1000 * k_outlook_share * outlook_.all_done);
  const auto least = 2 + static_cast<FarmTime::rep>(crew_.size() / k_members_per_ms);
  outlook_.valid_until = now + FarmTime(std::clamp<FarmTime::rep>(valid, least, 1000));
  return outlook_;
}

/// The maximum cost of a job that this worker, after what it holds, should do rather than leave to
/// others: it finishes by the time everything is done, give or take half the job's time on the
/// fastest worker; or while another worker is busy anyway. So a job is left to a faster worker only
/// if that one is expected to be free in time, and the fastest idle worker takes any job.
std::uint64_t Scheduler::greatest_cost(const Member& member, FarmTime now) const {
  constexpr double k_any = std::numeric_limits<double>::max();
  const double gone = seconds(now - outlook_.now);
  const double held = seconds_held(member, now);
  const double left = outlook_.all_done - gone - held;
  const double slower = 1 / member.speed - 0.5 / outlook_.fastest;
  double cost = std::max(0.0, left / slower);
  cost = std::max(cost, (outlook_.last_free - gone - held) * member.speed);
  const bool fast = member.speed >= k_about_the_fastest * outlook_.fastest;
  // Whatever the estimates say: if nobody holds anything, somebody must start.
  if ((member.held.empty() && fast) || holders_.empty()) cost = k_any;
  return cost >= 0x1p63 ? std::numeric_limits<std::uint64_t>::max()
                        : static_cast<std::uint64_t>(cost);
}

/// By kind, how many times longer jobs take than estimated; at least 1. Before any is done: the
/// median of what those in work have taken so far.
std::map<std::string, double> Scheduler::times_longer(FarmTime now) const {
  std::map<std::string, std::vector<double>> in_work;
  for (const auto& [id, member] : crew_) {
    for (const Held& held : member.held) {
      if (!held.since || held.cost == 0) continue;
      const double thought = static_cast<double>(held.cost) / member.speed;
      const double age = std::min(seconds(now - *held.since), thought + k_patience);
      in_work[held.kind].push_back(age / thought);
    }
  }
  std::map<std::string, double> times;
  for (auto& [kind, ages] : in_work) {
    double& of_kind = times[kind] = 1;
    if (const auto done = paces_.find(kind); done != paces_.end()) {
      of_kind = std::max(of_kind, done->second.took / done->second.thought);
    } else if (ages.size() >= k_enough_in_work) {
      const auto middle = ages.begin() + static_cast<std::ptrdiff_t>(ages.size() / 2);
      std::nth_element(ages.begin(), middle, ages.end());
      of_kind = std::max(of_kind, *middle);
    }
  }
  return times;
}

/// Jobs with a single attempt, latest expected completion first.
std::vector<Scheduler::Late> Scheduler::late_jobs(const Plan& plan, FarmTime now) const {
  const std::map<std::string, double> times_of = times_longer(now);
  std::vector<Late> late;
  for (const auto& [id, member] : crew_) {
    double before = 0;
    for (const Held& held : member.held) {
      const auto found = times_of.find(held.kind);
      const double times = found == times_of.end() ? 1 : found->second;
      const double whole = times * static_cast<double>(held.cost) / member.speed;
      const double left = before + seconds_left(member, held, now, times);
      if (!held.since) before += whole / member.threads;
      const bool single = holders_.at(held.key).size() == 1;
      const bool open = plan.state(held.key) == JobState::running;
      const double beyond = held.since ? seconds(now - *held.since) - whole : 0;
      if (single && open && !suspects_.contains(held.key)) {
        late.push_back({left, &held, times, member.host, beyond});
      }
    }
  }
  std::stable_sort(late.begin(), late.end(),
                   [](const Late& a, const Late& b) { return a.left > b.left; });
  return late;
}

std::vector<Scheduler::Pick> Scheduler::second_attempts(Plan& plan, FarmTime now) {
  std::vector<Pick> picks;
  if (options_.schedule == Schedule::fixed) return picks;
  if (now < next_second_attempts_) return picks;
  next_second_attempts_ = now + k_second_attempts_every;
  std::vector<std::pair<double, WorkerId>> idle;  // fastest first
  for (const auto& [id, member] : crew_) {
    if (member.held.empty() && open(member)) idle.emplace_back(-member.speed, id);
  }
  if (idle.empty()) return picks;
  std::sort(idle.begin(), idle.end());
  std::vector<Late> late = late_jobs(plan, now);
  for (const auto& [speed, id] : idle) {
    const Member& member = crew_.at(id);
    if (!open(member)) continue;
    bool any_gains = false;
    const auto taken = std::find_if(late.begin(), late.end(), [&](const Late& each) {
      const double anew = each.times * static_cast<double>(each.held->cost) / member.speed;
      const double gain = each.left - anew;
      const bool gains = gain >= std::max(k_least_gain, k_least_gain_share * each.left);
      const bool may_gain_here =
          each.host != member.host || !each.held->since || each.beyond >= k_late_on_host;
      any_gains = any_gains || gains;
      return gains && may_gain_here && fits(member, each.held->memory) &&
             may(member, each.held->key, each.held->memory);
    });
    if (taken != late.end()) {
      picks.push_back(hand(plan, id, plan.issue(taken->held->key), now));
      late.erase(taken);
    } else if (!any_gains) {
      break;  // nor does it for a slower worker
    }
  }
  return picks;
}

}  // namespace meshfarm
