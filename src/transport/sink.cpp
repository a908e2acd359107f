// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <atomic>
#include <deque>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

#include <unistd.h>

#include <meshfarm/farm/ledger.hpp>
#include <meshfarm/farm/sink_core.hpp>
#include <meshfarm/transport/sink.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "transport/control_link.hpp"
#include "transport/gatekeeper.hpp"
#include "transport/result_checker.hpp"
#include "transport/run_keys.hpp"
#include "transport/sink_problem.hpp"
#include "transport/sockets.hpp"
#include "transport/task_thread.hpp"

namespace meshfarm {
namespace {

constexpr int k_messages_per_turn = 1000;
/// At most this many results share one sync of the journal.
constexpr std::size_t k_checks_per_batch = 256;
/// Threads that verify results: network storage answers each request slowly, but many at once.
constexpr unsigned k_checkers = 4;
/// Earlier results are verified in addition, and beside workers on this host.
constexpr unsigned k_verifiers = 2;
constexpr std::size_t k_verified_per_batch = 64;

/// A sink that leaves or was asked to stop does not wait for storage.
ReadPatience patience_until(const std::atomic<bool>* stop, const std::atomic<bool>& leaves) {
  ReadPatience patience;
  patience.moved = [stop, &leaves](std::uint64_t) {
    if (leaves || (stop != nullptr && stop->load())) throw IncompleteError("stopped");
  };
  return patience;
}

/// A file in a journal existed long ago: if it is gone, it is made again. But failing storage says
/// nothing about it.
ReadPatience journal_patience(ReadPatience patience) {
  patience.missing = std::chrono::seconds(2);
  return patience;
}

using WhenComplete = std::function<void(std::span<const AcceptedJob>)>;

/// The sockets and threads around a SinkCore, which makes all decisions.
class SinkLoop {
 public:
  SinkLoop(const Stage& stage, const JobSource& source, const SinkOptions& options,
           const WhenComplete& complete)
      : stage_(stage),
        options_(options),
        complete_(complete),
        keys_(keys_to_serve(stage, options.run, options.security)),
        context_(make_context()),
        gate_(context_, keys_),
        results_(make_results_server(context_, keys_)),
        link_(context_, stage, options.security),
        patience_(patience_until(options.stop, leaves_)),
        journal_patience_(journal_patience(patience_)),
        verifying_patience_(journal_patience_),
        ledger_(read_journals(stage, options.run, journal_patience_)),
        checker_(stage, options, ledger_.by_run),
        incarnation_(random_id()),
        core_({Role::sink,
               options.run,
               incarnation_,
               static_cast<std::uint32_t>(::getpid()),
               clipped(host_name()),
               listen(),
               options.patience,
               {},
               options.algorithm},
              source, std::exchange(ledger_.accepted, {}), options.when_full) {}

  ~SinkLoop() { leaves_ = true; }
  SinkLoop(const SinkLoop&) = delete;
  SinkLoop& operator=(const SinkLoop&) = delete;

  std::uint32_t run() {
    while (!left_) {
      if (stopped()) perform(core_.stop());
      turn();
    }
    tell_of_strangers(gate_.refused().strangers(), garbage_);
    for (const std::exception_ptr& problem : {told_problem_of_job_, told_problem_}) {
      if (problem && left_->why != SinkLeaves::Why::incomplete) std::rethrow_exception(problem);
    }
    switch (left_->why) {
      case SinkLeaves::Why::complete:
        if (!left_->message.empty()) log_warning(left_->message);
        break;
      case SinkLeaves::Why::incomplete:
        throw IncompleteError(left_->message);
      case SinkLeaves::Why::jobs_failed:
      case SinkLeaves::Why::output_failed:
        throw DataError(left_->message);
    }
    return core_.epoch();
  }

 private:
  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  std::string listen() {
    gate_.watch(results_);
    return bind_within(results_, options_.bind, {options_.first_port, options_.last_port});
  }

  void turn() {
    std::vector<zmq::pollitem_t> items = {{nullptr, disk_.fd(), ZMQ_POLLIN, 0},
                                          {nullptr, verifier_.fd(), ZMQ_POLLIN, 0},
                                          {nullptr, own_jobs_.fd(), ZMQ_POLLIN, 0},
                                          {results_.handle(), 0, ZMQ_POLLIN, 0}};
    if (link_.socket() != nullptr) items.push_back({link_.socket()->handle(), 0, ZMQ_POLLIN, 0});
    wait_for(items, core_.pause(farm_clock()));
    const FarmTime now = farm_clock();
    const bool disk_finished = disk_.take_finished();
    const bool verifier_finished = verifier_.take_finished();
    const bool own_job_finished = own_jobs_.take_finished();
    // Checks that a stop ended early say nothing about their results.
    if (stopped()) return;
    if (disk_finished) disk_answers(now);
    if (verifier_finished) verifier_answers(now);
    if (own_job_finished) own_job_answers(now);
    for (int count = 0; link_.socket() != nullptr && count < k_messages_per_turn; ++count) {
      const auto received = receive(*link_.socket());
      if (!received) break;
      if (received->message) perform(core_.on_control(*received->message, now));
    }
    for (int count = 0; count < k_messages_per_turn; ++count) {
      const auto received = receive(results_);
      if (!received) break;
      if (received->message) {
        perform(core_.on_result(*received->message));
      } else {
        ++garbage_;
      }
    }
    perform(core_.tick(now));
    use_disk();
    use_verifier();
    use_own_jobs();
  }

  void perform(const SinkActions& actions) {
    for (const SinkAction& action : actions) {
      std::visit([this](const auto& each) { act(each); }, action);
    }
  }

  void act(const Look&) { perform(core_.found(link_.look(), farm_clock())); }
  void act(const Dial& each) { link_.dial(each.address); }
  void act(const HangUp&) { link_.hang_up(); }
  void act(const Say& each) { link_.say(each.message); }
  void act(const Check& each) {
    (each.what == Check::What::accepted ? to_verify_ : to_check_).push_back(each);
  }
  void act(const DoHere& each) { to_do_.push_back(each); }
  void act(const MakeOutput&) { make_output_ = true; }
  void act(const SinkLeaves& each) { left_ = each; }

  /// Gives the disk thread its next work: checks go before the output.
  void use_disk() {
    if (!disk_.idle() || left_) return;
    if (!to_check_.empty()) {
      batch_ = next_of(to_check_, k_checks_per_batch);
      disk_.start([this] { check_batch(); });
    } else if (std::exchange(make_output_, false)) {
      making_output_ = true;
      problem_ = nullptr;
      disk_.start([this] { make_output(); });
    }
  }

  /// Earlier results are verified while new ones come in.
  void use_verifier() {
    if (!verifier_.idle() || left_ || to_verify_.empty()) return;
    verified_ = next_of(to_verify_, k_verified_per_batch);
    verifier_.start([this] {
      checker_.check_all(verified_, verifying_patience_, verifying_patience_, k_verifiers);
    });
  }

  /// Runs while the workers' results are checked.
  void use_own_jobs() {
    if (!own_jobs_.idle() || left_ || to_do_.empty()) return;
    doing_ = std::move(to_do_.front());
    to_do_.pop_front();
    accepted_ = core_.graph().outputs();
    own_jobs_.start([this] { do_here(); });
  }

  static std::vector<CheckedResult> next_of(std::deque<Check>& waiting, std::size_t most) {
    std::vector<CheckedResult> next;
    for (; !waiting.empty() && next.size() < most; waiting.pop_front()) {
      next.push_back({std::move(waiting.front())});
    }
    return next;
  }

  void verifier_answers(FarmTime now) {
    for (const CheckedResult& each : std::exchange(verified_, {})) {
      if (!each.problem.reason.empty()) {
        log_warning("accepted before, now made again: " + each.problem.reason);
      }
      perform(core_.checked(each.check, each.problem, now));
    }
  }

  void disk_answers(FarmTime now) {
    told_problem_ = problem_;
    if (std::exchange(making_output_, false)) {
      const SinkProblem problem = problem_of(problem_);
      perform(core_.completed(problem, now));
      return tell_of_room(problem.text);
    }
    if (problem_) return perform(core_.fail(problem_of_journal(problem_)));
    std::string no_room;
    for (const CheckedResult& each : std::exchange(batch_, {})) {
      const bool full = each.problem.kind == FailureKind::no_space;
      if (full) no_room = each.problem.reason;
      if (!full && !each.problem.reason.empty()) {
        log_warning("not accepted: " + each.problem.reason);
      }
      perform(core_.checked(each.check, each.problem, now));
    }
    tell_of_room(no_room);
  }

  void own_job_answers(FarmTime now) {
    told_problem_of_job_ = std::exchange(problem_of_job_, nullptr);
    const SinkProblem problem = problem_of(told_problem_of_job_);
    const DoHere done = *std::exchange(doing_, std::nullopt);
    perform(core_.did(done, std::exchange(made_, {}), problem, now));
    tell_of_room(problem.text);
  }

  /// Logs once when the waiting starts, and once when it ends.
  void tell_of_room(const std::string& reason) {
    const bool waits = core_.waits_for_room();
    if (waits == std::exchange(told_of_waiting_, waits)) return;
    log_warning(waits ? "no room, waiting: " + reason : "there is room again");
  }

  /// Runs on the disk thread.
  void check_batch() {
    // All results share one patience.
    ReadPatience patience = patience_;
    checker_.check_all(batch_, patience, journal_patience_, k_checkers);
    std::vector<std::string> records;
    for (const CheckedResult& each : batch_) {
      if (each.to_record) {
        records.push_back(encode_record({options_.run, {each.check.key, each.check.output}}));
      }
    }
    if (!records.empty()) write_records(records);
  }

  void write_records(const std::vector<std::string>& records) {
    try {
      journal_append(records);
    } catch (const IoError& error) {
      if (!is_no_space(error)) {
        problem_ = std::current_exception();
        return;
      }
      for (CheckedResult& each : batch_) {
        if (each.to_record) each.problem = {error.what(), FailureKind::no_space};
      }
    } catch (...) {
      problem_ = std::current_exception();
    }
  }

  /// A journal that failed to write may be torn, and records after the tear would not be read. So
  /// another one is started, at once and then for as long as failing storage is waited for.
  void journal_append(const std::vector<std::string>& records) {
    Waiting waiting(patience_);
    for (bool again = false;; again = true) {
      try {
        if (!journal_) journal_.emplace(open_journal(stage_));
        return journal_->append_all(records);
      } catch (const IoError& error) {
        journal_.reset();
        if (is_no_space(error) || (again && !waiting.again(error))) throw;
        if (!again) log_warning("a new journal is begun: " + std::string(error.what()));
      }
    }
  }

  /// Runs on the thread of own jobs.
  void do_here() {
    try {
      const auto goes_on = [this](std::uint64_t) {
        return options_.stop == nullptr || !options_.stop->load();
      };
      if (!options_.do_here)
        throw Error("a " + doing_->job.kind + " job for a sink that does none");
      const FarmTime begin = farm_clock();
      const std::uint64_t cpu_before_us = thread_cpu_us();
      made_ = options_.do_here(doing_->job, {stage_, 1, incarnation_, goes_on}, accepted_);
      doing_->times.compute_ms = static_cast<std::uint32_t>((farm_clock() - begin).count());
      doing_->times.cpu_us = 1 + thread_cpu_us() - cpu_before_us;
    } catch (...) {
      problem_of_job_ = std::current_exception();
    }
  }

  /// Runs on the disk thread, once no own jobs are left.
  void make_output() {
    try {
      complete_(core_.graph().outputs());
    } catch (...) {
      problem_ = std::current_exception();
    }
  }

  const Stage& stage_;
  const SinkOptions& options_;
  const WhenComplete& complete_;
  Keys keys_;
  zmq::context_t context_;
  Gatekeeper gate_;
  zmq::socket_t results_;
  ControlLink link_;
  std::atomic<bool> leaves_{false};
  const ReadPatience patience_;
  ReadPatience journal_patience_;    // the disk thread's once it runs
  ReadPatience verifying_patience_;  // the verifier's
  Ledger ledger_;
  const ResultChecker checker_;
  const std::uint64_t incarnation_;
  SinkCore core_;
  std::deque<Check> to_check_;
  std::deque<Check> to_verify_;
  std::deque<DoHere> to_do_;
  std::uint64_t garbage_ = 0;
  bool told_of_waiting_ = false;
  bool make_output_ = false;
  bool making_output_ = false;
  std::optional<SinkLeaves> left_;
  std::exception_ptr told_problem_;  // of the disk thread when it was last idle
  std::exception_ptr told_problem_of_job_;
  // Owned by the disk thread while it works:
  std::vector<CheckedResult> batch_;
  std::optional<JournalWriter> journal_;
  std::exception_ptr problem_;
  // Owned by the thread of own jobs:
  std::optional<DoHere> doing_;
  std::vector<AcceptedJob> accepted_;  // before this job
  JobOutput made_;
  std::exception_ptr problem_of_job_;
  // Owned by the verifier while it works:
  std::vector<CheckedResult> verified_;
  // The last members, so that their threads end first.
  TaskThread disk_;
  TaskThread verifier_;
  TaskThread own_jobs_;
};

}  // namespace

std::uint32_t run_sink(const Stage& stage, const JobSource& source, const SinkOptions& options,
                       const std::function<void(std::span<const AcceptedJob>)>& complete) {
  check_exposure(options.security, options.bind);
  return SinkLoop(stage, source, options, complete).run();
}

}  // namespace meshfarm
