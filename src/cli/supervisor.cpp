// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/supervisor.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>

#include <sys/wait.h>

#include <meshfarm/util/log.hpp>

#include "cli/child_process.hpp"

namespace meshfarm {
namespace {

constexpr int k_max_restarts = 20;
constexpr int k_grace_ms = 10'000;
constexpr int k_last_words_ms = 3'000;
constexpr int k_left_incomplete = 3;

}  // namespace

Supervisor::~Supervisor() {
  end_all();
}

void Supervisor::start(std::vector<std::string> words) {
  children_.push_back({.words = std::move(words), .pid = -1, .done = false, .restarts = 0});
  spawn(children_.back());
}

void Supervisor::spawn(Child& child) {
  child.pid = start_child(child.words);
}

int Supervisor::run() {
  while (!stop_ && failure_ == 0 && !essentials_done()) {
    reap();
    if (stop_ || failure_ != 0 || essentials_done()) break;
    wait_for_child(200);
  }
  const bool done = essentials_done();
  // Ventilator and sink end together; the other one may be about to report why.
  if (failure_ != 0) wait_all(Which::essentials, k_last_words_ms);
  end_all();
  if (failure_ != 0) return failure_;
  return done ? 0 : k_left_incomplete;
}

void Supervisor::reap() {
  for (Child& child : children_) {
    int status = 0;
    if (child.pid > 0 && ::waitpid(child.pid, &status, WNOHANG) == child.pid) {
      child.pid = -1;
      ended(child, status);
    }
  }
}

void Supervisor::ended(Child& child, int status) {
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
    child.done = true;
    if (child.words.front() == "sink") sink_done_at_ = std::chrono::steady_clock::now();
    return;
  }
  if (child.words.front() == "ventilator" && sink_done()) {
    child.done = true;  // the output exists: the ventilator is no longer needed
    return;
  }
  // A worker that left before the end had a hanging job, or lost its ventilator.
  const bool left = child.worker() && WIFEXITED(status) && WEXITSTATUS(status) == k_left_incomplete;
  if ((WIFSIGNALED(status) || left) && child.restarts < k_max_restarts && !stop_) {
    ++child.restarts;
    log_warning("the " + child.words.front() +
                (left ? std::string(" left before the end")
                      : " was ended by signal " + std::to_string(WTERMSIG(status))) +
                " and is started again");
    spawn(child);
    if (!child.worker()) call_workers_back();
    return;
  }
  if (!child.worker() || !has_live_worker()) {
    failure_ = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
    if (child.worker()) log_error("no worker is left");
  }
}

/// They left because everything was done, but a restarted sink may need results made again.
void Supervisor::call_workers_back() {
  for (Child& child : children_) {
    if (!child.worker() || !child.done) continue;
    child.done = false;
    spawn(child);
  }
}

bool Supervisor::has_live_worker() const {
  return std::any_of(children_.begin(), children_.end(), [](const Child& child) {
    return child.worker() && (child.pid > 0 || child.done);
  });
}

bool Supervisor::sink_done() const {
  return std::any_of(children_.begin(), children_.end(), [](const Child& child) {
    return child.words.front() == "sink" && child.done;
  });
}

/// A ventilator that was killed at the very end, and restarted, waits for a sink in vain.
bool Supervisor::essentials_done() const {
  const auto now = std::chrono::steady_clock::now();
  if (sink_done() && now - sink_done_at_ > std::chrono::milliseconds(k_last_words_ms)) return true;
  return std::all_of(children_.begin(), children_.end(),
                     [](const Child& child) { return child.worker() || child.done; });
}

bool Supervisor::wait_all(Which which, int timeout_ms) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(timeout_ms);
  while (true) {
    bool running = false;
    for (Child& child : children_) {
      if (child.pid > 0 && ::waitpid(child.pid, nullptr, WNOHANG) != 0) child.pid = -1;
      const bool counts = which == Which::all || !child.worker();
      running = running || (counts && child.pid > 0);
    }
    if (!running) return true;
    if (std::chrono::steady_clock::now() >= end) return false;
    wait_for_child(50);
  }
}

void Supervisor::end_all() {
  if (wait_all(Which::all, 0)) return;
  for (const Child& child : children_) {
    if (child.pid > 0) ::kill(child.pid, SIGTERM);
  }
  if (wait_all(Which::all, k_grace_ms)) return;
  for (const Child& child : children_) {
    if (child.pid > 0) ::kill(child.pid, SIGKILL);
  }
  wait_all(Which::all, k_grace_ms);
}

}  // namespace meshfarm
