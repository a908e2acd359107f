// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <ctime>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <variant>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/farm/job_clock.hpp>
#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/farm/worker_core.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/staging/staged_writer.hpp>

#include "transport/task_thread.hpp"
#include "transport/turn_gate.hpp"

namespace meshfarm {

using JobOutcome = std::variant<JobOutput, JobFailure>;

/// One of a worker's slots for jobs in work, with its thread. It waits for its turn to read if the
/// inputs are large, reads them ahead, waits for its turn to compute, and lets the next slot
/// compute while it writes the output.
class JobSlot : private JobStorage {
 public:
  JobSlot(const Stage& stage, const JobFunction& work, WorkerGates& gates,
          std::uint64_t incarnation)
      : stage_(stage), work_(work), gates_(gates), incarnation_(incarnation) {}

  /// Call only after the last job's result was taken.
  void begin(const Begin& begin);
  /// Asks the job to give up; it still ends with a result.
  void give_up();
  int fd() const { return thread_.fd(); }
  /// True once for each job that ended; outcome() and times() then belong to it.
  bool take_finished() { return thread_.take_finished(); }
  JobOutcome& outcome() { return outcome_; }
  const JobTimes& times() const { return clock_.times(); }
  SlotPulse pulse() const;

 private:
  class OutputFile;
  static constexpr clockid_t k_no_clock = CLOCK_REALTIME;  // not any thread's clock

  JobOutcome attempt(const Begin& begin);
  JobOutcome compute(const Begin& begin);
  JobOutcome checked(const Begin& begin, JobOutput output) const;
  void wait_and_read_ahead(const Job& job);
  void read_ahead(const Job& job);
  void end_computing();
  void write_in_pieces(StagedWriter& file, std::string_view bytes);
  void moved(std::uint64_t bytes) { moved_.fetch_add(bytes, std::memory_order_relaxed); }
  /// Waiting for a file is also a sign of life: the wait is bounded.
  std::function<void(std::uint64_t)> on_moved() {
    return [this](std::uint64_t bytes) { moved(bytes + 1); };
  }
  std::string read(const FileRef& file) override;
  std::string read(const FileRef& file, const FileSection& section) override;
  FileRef publish(const StagedName& name, std::string_view bytes, std::string_view unique) override;
  std::unique_ptr<JobFile> create(const StagedName& name, std::string_view unique) override;

  const Stage& stage_;
  const JobFunction& work_;
  WorkerGates& gates_;
  std::uint64_t incarnation_;
  std::atomic<std::uint64_t> progress_{0};
  std::atomic<std::uint64_t> moved_{0};  // bytes read from and written to the stage
  std::atomic<JobPhase> phase_{JobPhase::storage};
  std::atomic<bool> give_up_{false};
  std::atomic<clockid_t> cpu_clock_{k_no_clock};  // the thread's, once it has computed
  // Owned by the thread while it works:
  struct Place {
    std::string file;
    std::uint64_t offset = 0;
    std::uint64_t size = 0;  // an empty section starts where the next one does

    friend auto operator<=>(const Place&, const Place&) = default;
  };
  std::map<Place, std::string> ahead_;
  JobClock clock_;
  std::uint64_t cpu_before_us_ = 0;
  JobOutcome outcome_;
  TaskThread thread_;  // the last member, so that it ends first
};

}  // namespace meshfarm
