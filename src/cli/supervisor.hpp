// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <string>
#include <vector>

#include <sys/types.h>

namespace meshfarm {

/// Runs this program's own commands as child processes and supervises them: a ventilator, a sink
/// and any number of workers. Children ended by a signal are started again; the run continues from
/// the stage. Children end when their parent does.
class Supervisor {
 public:
  explicit Supervisor(const std::atomic<bool>& stop) : stop_(stop) {}
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// The words of a command, starting with its name.
  void start(std::vector<std::string> words);
  /// Waits until sink and ventilator are done. Returns the exit code of the run.
  int run();

 private:
  struct Child {
    std::vector<std::string> words;
    pid_t pid = -1;  // -1: not running
    bool done = false;
    int restarts = 0;
    bool worker() const { return words.front() == "worker"; }
  };

  void spawn(Child& child);
  void reap();
  void ended(Child& child, int status);
  void call_workers_back();
  void end_all();
  enum class Which { all, essentials };
  bool wait_all(Which which, int timeout_ms);
  bool sink_done() const;
  bool essentials_done() const;
  bool has_live_worker() const;

  const std::atomic<bool>& stop_;
  std::vector<Child> children_;
  int failure_ = 0;
  std::chrono::steady_clock::time_point sink_done_at_;
};

}  // namespace meshfarm
