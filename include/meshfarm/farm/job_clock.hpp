// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <utility>

#include <meshfarm/farm/protocol.hpp>

namespace meshfarm {

/// Measures where a running job's time goes: each step begins where the previous one ended.
class JobClock {
 public:
  explicit JobClock(FarmTime now = FarmTime(0)) : lap_(now) {}

  void read(FarmTime now) { times_.read_ms = lap_ms(now); }
  /// Its turn to compute has come.
  void computes(FarmTime now) {
    times_.wait_ms = lap_ms(now);
    computing_ = true;
  }
  bool computing() const { return computing_; }
  void computed(FarmTime now, std::uint64_t cpu_us = 0) {
    times_.compute_ms = lap_ms(now);
    times_.cpu_us = cpu_us;
    computing_ = false;
  }
  void written(FarmTime now) { times_.write_ms += lap_ms(now); }

  const JobTimes& times() const { return times_; }

 private:
  std::uint32_t lap_ms(FarmTime now) {
    return static_cast<std::uint32_t>((now - std::exchange(lap_, now)).count());
  }

  FarmTime lap_;
  bool computing_ = false;
  JobTimes times_;
};

}  // namespace meshfarm
