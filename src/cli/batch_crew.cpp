// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/batch_crew.hpp"

#include <algorithm>
#include <chrono>
#include <csignal>

#include <sys/wait.h>

#include <meshfarm/util/log.hpp>

#include "cli/child_process.hpp"

namespace meshfarm {
namespace {

constexpr int k_max_starts = 100;
/// A run may take up to ten seconds to end its own processes.
constexpr std::chrono::seconds k_grace{25};

/// Whether all have ended in time.
bool wait_for_all(std::vector<pid_t>& pids, std::chrono::seconds longest) {
  const auto end = std::chrono::steady_clock::now() + longest;
  for (;;) {
    std::erase_if(pids, [](pid_t pid) { return ::waitpid(pid, nullptr, WNOHANG) != 0; });
    if (pids.empty()) return true;
    if (std::chrono::steady_clock::now() >= end) return false;
    wait_for_child(50);
  }
}

}  // namespace

void end_children(std::vector<pid_t> pids) {
  for (const pid_t pid : pids) ::kill(pid, SIGTERM);
  if (wait_for_all(pids, k_grace)) return;
  for (const pid_t pid : pids) ::kill(pid, SIGKILL);
  wait_for_all(pids, k_grace);
}

BatchCrew::BatchCrew(std::vector<std::string> words, std::uint32_t workers)
    : words_(std::move(words)), workers_(workers) {
  for (Worker& each : workers_) start(each);
}

BatchCrew::~BatchCrew() {
  std::vector<pid_t> pids;
  for (const Worker& each : workers_) {
    if (each.pid > 0) pids.push_back(each.pid);
  }
  end_children(std::move(pids));
}

void BatchCrew::start(Worker& worker) const {
  worker.pid = start_child(words_);
  ++worker.starts;
}

bool BatchCrew::look_after() {
  for (Worker& each : workers_) {
    if (each.pid <= 0 || ::waitpid(each.pid, nullptr, WNOHANG) != each.pid) continue;
    each.pid = -1;
    if (each.starts >= k_max_starts) continue;
    log_warning("a worker has ended and is started again");
    start(each);
  }
  return std::any_of(workers_.begin(), workers_.end(),
                     [](const Worker& each) { return each.pid > 0; });
}

}  // namespace meshfarm
