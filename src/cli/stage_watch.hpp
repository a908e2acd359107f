// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include <meshfarm/pipeline/run_follower.hpp>
#include <meshfarm/report/status.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/side_thread.hpp>

namespace meshfarm {

/// Looks at a stage on request, and reads only what is new.
class StageLook {
 public:
  /// `name`: the stage as named by the user.
  StageLook(Stage stage, std::string name);
  /// Throws IoError or DataError; may be called again.
  StatusFacts look();

 private:
  using Clock = std::chrono::steady_clock;

  void tell_time();
  void find_times();
  bool is_full();
  static bool is_time_for(std::optional<Clock::time_point>& last, Clock::duration every);

  Stage stage_;
  RunFollower follower_;
  StageStatus status_;
  std::optional<Clock::time_point> clock_read_;
  std::optional<Clock::time_point> times_read_;
  std::optional<Clock::time_point> room_probed_;
  std::optional<double> server_ahead_s_;  // the server's clock minus ours
  bool was_full_ = false;
};

/// Looks at a stage every second on a thread of its own, since stalled storage would block others.
class StageWatch {
 public:
  StageWatch(Stage stage, std::string name);
  /// Does not wait for stalled storage.
  ~StageWatch();
  StageWatch(const StageWatch&) = delete;
  StageWatch& operator=(const StageWatch&) = delete;

  /// The last known facts, and how long ago they were seen.
  StatusFacts facts() const;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
  std::optional<SideThread> thread_;
};

}  // namespace meshfarm
