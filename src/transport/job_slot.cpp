// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "transport/job_slot.hpp"

#include <algorithm>
#include <new>
#include <utility>

#include <pthread.h>

#include <meshfarm/staging/staged_writer.hpp>
#include <meshfarm/util/errors.hpp>

#include "transport/sockets.hpp"

namespace meshfarm {
/// An output written while the job computes: stalled storage is told apart from a hanging job.
class JobSlot::OutputFile : public JobFile {
 public:
  OutputFile(JobSlot& slot, const StagedName& name, std::string_view unique)
      : slot_(slot), file_(slot.stage_, name, unique) {}
  void write(std::string_view bytes) override {
    slot_.phase_ = JobPhase::storage;
    slot_.write_in_pieces(file_, bytes);
    slot_.phase_ = JobPhase::computing;
  }
  FileRef commit() override {
    slot_.end_computing();
    FileRef file = file_.commit();
    slot_.clock_.written(farm_clock());
    return file;
  }

 private:
  JobSlot& slot_;
  StagedWriter file_;
};

void JobSlot::begin(const Begin& begin) {
  give_up_ = false;
  phase_ = JobPhase::storage;
  thread_.start([this, begin] {
    outcome_ = attempt(begin);
    ahead_.clear();
  });
}

void JobSlot::give_up() {
  give_up_ = true;
  gates_.reading.look_up();
  gates_.computing.look_up();
}

SlotPulse JobSlot::pulse() const {
  const clockid_t clock = cpu_clock_.load(std::memory_order_relaxed);
  return {progress_.load(std::memory_order_relaxed) + moved_.load(std::memory_order_relaxed),
          phase_.load(std::memory_order_relaxed),
          clock == k_no_clock ? 0 : thread_cpu_us(clock) / 1000};
}

/// Runs on the slot's thread, as does everything below. Any exception from the job's function is
/// the job's failure, not ours.
JobOutcome JobSlot::attempt(const Begin& begin) {
  clock_ = JobClock(farm_clock());
  wait_and_read_ahead(begin.job);
  clock_.read(farm_clock());
  phase_ = JobPhase::waiting;
  if (!gates_.computing.enter(give_up_)) return JobFailure{"given up", FailureKind::attempt};
  clock_.computes(farm_clock());
  phase_ = JobPhase::computing;
  cpu_before_us_ = thread_cpu_us();
  if (clockid_t clock = 0; ::pthread_getcpuclockid(::pthread_self(), &clock) == 0) {
    cpu_clock_ = clock;
  }
  JobOutcome outcome;
  try {
    outcome = compute(begin);
  } catch (const BadInputError& error) {
    outcome = JobFailure{clipped(error.what()), FailureKind::for_good};
  } catch (const UnreadIoError& error) {
    outcome = JobFailure{clipped(error.what()), FailureKind::no_input};
  } catch (const UnreadDataError& error) {
    outcome = JobFailure{clipped(error.what()), FailureKind::damaged_input};
  } catch (const IoError& error) {
    outcome = JobFailure{clipped(error.what()),
                         is_no_space(error) ? FailureKind::no_space : FailureKind::attempt};
  } catch (const std::bad_alloc&) {
    outcome = JobFailure{"out of memory", FailureKind::attempt};
  } catch (const std::exception& error) {
    outcome = JobFailure{clipped(error.what()), FailureKind::attempt};
  } catch (...) {
    outcome = JobFailure{"an unknown exception", FailureKind::attempt};
  }
  end_computing();
  return outcome;
}

JobOutcome JobSlot::compute(const Begin& begin) {
  const auto progress = [this](std::uint64_t done) {
    progress_.fetch_add(done, std::memory_order_relaxed);
    return !give_up_.load(std::memory_order_relaxed);
  };
  const JobContext context{stage_, begin.attempt, incarnation_, progress, this};
  return checked(begin, work_(begin.job, context));
}

JobOutcome JobSlot::checked(const Begin& begin, JobOutput output) const {
  const ResultName name{begin.key.value, begin.attempt, incarnation_};
  if (output.file.name != to_string(name)) {
    return JobFailure{
        clipped("its output is named '" + output.file.name + "', not '" + to_string(name) + "'"),
        FailureKind::attempt};
  }
  if (output.summary.size() > k_max_summary_bytes) {
    return JobFailure{"its summary is too long for a message", FailureKind::attempt};
  }
  return output;
}

void JobSlot::wait_and_read_ahead(const Job& job) {
  const std::uint64_t bytes = input_bytes(job);
  if (bytes > job.memory) return;  // the job will read it piece by piece
  if (bytes < k_much_input) return read_ahead(job);
  phase_ = JobPhase::waiting;
  if (!gates_.reading.enter(give_up_)) return;
  phase_ = JobPhase::storage;
  read_ahead(job);
  gates_.reading.leave();
}

/// Errors are ignored: the job itself reads the input again, and reports why it cannot.
void JobSlot::read_ahead(const Job& job) {
  try {
    for (const InputSection& each : job.sections) {
      if (give_up_) return;
      const FileRef& input = job.inputs.at(each.input);
      ahead_[{input.name, each.section.offset, each.section.size}] =
          stage_.read(input, each.section, {.attempts = 1, .moved = on_moved()});
    }
    if (!job.sections.empty()) return;
    for (const FileRef& input : job.inputs) {
      if (give_up_) return;
      ahead_[{input.name, 0, input.size}] =
          stage_.read(input, {.attempts = 1, .moved = on_moved()});
    }
  } catch (const Error&) {
  } catch (const std::bad_alloc&) {
  }
}

std::string JobSlot::read(const FileRef& file) {
  return read(file, {0, file.size, file.hash});
}

std::string JobSlot::read(const FileRef& file, const FileSection& section) {
  auto found = ahead_.extract({file.name, section.offset, section.size});
  if (!found.empty()) return std::move(found.mapped());
  phase_ = JobPhase::storage;
  std::string bytes = stage_.read(file, section, {.moved = on_moved()});
  phase_ = JobPhase::computing;
  return bytes;
}

FileRef JobSlot::publish(const StagedName& name, std::string_view bytes, std::string_view unique) {
  end_computing();
  StagedWriter file(stage_, name, unique);
  write_in_pieces(file, bytes);
  FileRef written = file.commit();
  clock_.written(farm_clock());
  return written;
}

/// In pieces, so that progress on slow storage is visible.
void JobSlot::write_in_pieces(StagedWriter& file, std::string_view bytes) {
  constexpr std::size_t k_piece = std::size_t{1} << 20;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(k_piece, bytes.size()))) {
    const std::string_view piece = bytes.substr(0, k_piece);
    file.write(piece);
    moved(piece.size());
  }
}

std::unique_ptr<JobFile> JobSlot::create(const StagedName& name, std::string_view unique) {
  return std::make_unique<OutputFile>(*this, name, unique);
}

void JobSlot::end_computing() {
  if (!clock_.computing()) return;
  clock_.computed(farm_clock(), thread_cpu_us() - cpu_before_us_);
  phase_ = JobPhase::storage;
  gates_.computing.leave();
}

}  // namespace meshfarm
