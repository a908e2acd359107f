// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <sys/types.h>

namespace meshfarm {

/// Workers that run as long as this object exists; one that ends is started again.
class BatchCrew {
 public:
  /// `words`: the command line, starting with the command's name.
  BatchCrew(std::vector<std::string> words, std::uint32_t workers);
  /// Asks the workers to leave, and waits for them.
  ~BatchCrew();
  BatchCrew(const BatchCrew&) = delete;
  BatchCrew& operator=(const BatchCrew&) = delete;

  /// Call regularly. False once none is left that can be started again.
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

/// Asks these processes to end, and kills them after some seconds.
void end_children(std::vector<pid_t> pids);

}  // namespace meshfarm
