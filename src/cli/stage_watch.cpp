// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/stage_watch.hpp"

#include <utility>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/run_trace.hpp>
#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr std::chrono::milliseconds k_look_every{1000};
/// Asking for the server's time creates a file.
constexpr std::chrono::seconds k_ask_time_every{20};
/// A summary appears a moment after the end of its run.
constexpr std::chrono::seconds k_look_for_summary_every{2};
constexpr std::chrono::seconds k_probe_every{5};
/// For the thread to end, unless its storage stalls.
constexpr std::chrono::seconds k_last_wait{1};

double unix_now() {
  const auto since = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration<double>(since).count();
}

}  // namespace

StageLook::StageLook(Stage stage, std::string name) : stage_(std::move(stage)), follower_(stage_) {
  status_.stage = std::move(name);
  status_.manifest =
      decode_manifest(stage_.read(ManifestName{}), stage_.path(ManifestName{}).string());
}

StatusFacts StageLook::look() {
  follower_.look(status_.trace);
  tell_time();
  find_times();
  status_.free_bytes = free_bytes(stage_.root());
  status_.no_room = is_silent(status_) && is_full();
  return facts_of(status_);
}

void StageLook::find_times() {
  if (!status_.trace || !status_.trace->end) return status_.times.reset();
  const TraceHead& head = status_.trace->head;
  if (status_.times && status_.times->run == head.run && status_.times->epoch == head.epoch) return;
  if (!is_time_for(times_read_, k_look_for_summary_every)) return;
  status_.times = read_run_times(stage_, head.run);
}

/// Whether this much time has passed since `last`, or it is unset; if so, sets it to now.
bool StageLook::is_time_for(std::optional<Clock::time_point>& last, Clock::duration every) {
  const auto now = Clock::now();
  if (last && now - *last < every) return false;
  last = now;
  return true;
}

/// Assumes the same offset from our clock as at the last query.
void StageLook::tell_time() {
  if (is_time_for(clock_read_, k_ask_time_every)) {
    const std::optional<double> server = server_unix_s(stage_.path(TraceName{1}).parent_path());
    server_ahead_s_.reset();
    if (server) server_ahead_s_ = *server - unix_now();
  }
  status_.now_unix_s.reset();
  if (server_ahead_s_) status_.now_unix_s = unix_now() + *server_ahead_s_;
}

/// On a full disk the ventilator cannot even write that it waits for room.
bool StageLook::is_full() {
  constexpr std::uint64_t k_little = 64 << 10;
  if (!is_time_for(room_probed_, k_probe_every)) return was_full_;
  was_full_ = false;
  try {
    probe_room(stage_.root() / "log", k_little);
  } catch (const IoError& error) {
    was_full_ = is_no_space(error);
  }
  return was_full_;
}

struct StageWatch::Shared : SideThread::Signals {
  using Clock = std::chrono::steady_clock;

  Shared(Stage stage, std::string name) : look(std::move(stage), std::move(name)) {}

  StageLook look;  // owned by the thread
  StatusFacts facts;
  Clock::time_point seen = Clock::now();
  std::string problem;

  void run();
};

void StageWatch::Shared::run() {
  std::unique_lock lock(mutex);
  while (!end) {
    const auto begin = Clock::now();
    lock.unlock();
    std::optional<StatusFacts> next;
    std::string why;
    try {
      next = look.look();
    } catch (const std::exception& error) {
      why = error.what();  // may be temporary: the next look shows it
    }
    lock.lock();
    if (next) {
      facts = std::move(*next);
      seen = begin;
    }
    problem = why;
    changed.wait_until(lock, begin + k_look_every, [this] { return end; });
  }
}

StageWatch::StageWatch(Stage stage, std::string name)
    : shared_(std::make_shared<Shared>(std::move(stage), std::move(name))) {
  shared_->facts = shared_->look.look();
  thread_.emplace(
      shared_, [shared = shared_] { shared->run(); }, k_last_wait);
}

StageWatch::~StageWatch() = default;

StatusFacts StageWatch::facts() const {
  const std::lock_guard lock(shared_->mutex);
  const std::chrono::duration<double> age = Shared::Clock::now() - shared_->seen;
  return grown_older(shared_->facts, age.count(), shared_->problem);
}

}  // namespace meshfarm
