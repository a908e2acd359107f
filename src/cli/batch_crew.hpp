// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sys/types.h>

namespace meshfarm {

/// Workers that are there as long as this is; one that ends is started again.
class BatchCrew {
 public:
  /// `words`: of the command, its name first.
  BatchCrew(std::vector<std::string> words, std::uint32_t workers);
  /// Asks them to leave, and waits.
  ~BatchCrew();
  BatchCrew(const BatchCrew&) = delete;
  BatchCrew& operator=(const BatchCrew&) = delete;

  /// To be called now and then. False once none is left that could be started again.
  bool look_after();

 private:
  struct Worker {
    pid_t pid = -1;  // -1: not running
    int starts = 0;
  };
  void start(Worker& worker) const;

  std::vector<std::string> words_;
  std::vector<Worker> workers_;
};

/// Asks these processes to end, and after some seconds makes them.
void end_children(std::vector<pid_t> pids);

}  // namespace meshfarm
