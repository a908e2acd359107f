// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/farm/known_results.hpp>
#include <meshfarm/farm/membership.hpp>
#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/farm/when_full.hpp>

namespace meshfarm {

/// A result whose file is to be checked.
struct Check {
  /// result: new; verify its file and journal it.
  /// large: new; check that a file of its name and size exists, and journal it.
  /// known: in a journal; check that a file of its name and size exists.
  /// accepted: a large or known one, accepted by that check; verify it when nothing else waits.
  enum class What : std::uint8_t { result, large, known, accepted };

  JobKey key;
  JobOutput output;
  What what = What::result;
  WorkerId worker = {};       // for a result; 0: made by the sink
  std::uint32_t attempt = 0;  // for a worker's result
  JobTimes times = {};
  std::string kind = {};         // the job's
  bool left_to_readers = false;  // see Job
};
/// Do a job of the sink; answered by did().
struct DoHere {
  JobKey key;
  Job job;
  JobTimes times = {};  // set once it is done
};
/// Make the run's output from JobGraph::outputs(); answered by completed().
struct MakeOutput {};
/// The sink leaves.
struct SinkLeaves {
  enum class Why { complete, incomplete, jobs_failed, output_failed };
  Why why = Why::complete;
  std::string message;
};
/// Why the output, the journal or a job of the sink could not be written; empty: it was written.
struct SinkProblem {
  std::string text;
  bool no_room = false;  // the disk was full: the same run may be completed later
};
using SinkAction = std::variant<Look, Dial, HangUp, Say, Check, DoHere, MakeOutput, SinkLeaves>;
using SinkActions = std::vector<SinkAction>;

/// The sink's decisions: which jobs are wanted, which are accepted, and what the ventilator has
/// been told. Pure. Invariant: a job is accepted, and reported, only after checked() said that its
/// result is verified and on disk or, if it is large or in a journal, that a file of its name and
/// size exists: all results go through the sink's link, and jobs would wait for the reads. Such
/// results are verified while the farm works; the output and the sink's own jobs are not made
/// before that, and damaged results are taken back. To take one back, the sink restarts its graph
/// without it and greets the ventilator like a new sink that has all other results: the job is made
/// again, and results already made from it stay. From then on every new result is verified first,
/// to find out who damages results. Results left to their readers (Job::left_to_readers) are read
/// only once a reader, or the sink, has found damage.
class SinkCore {
 public:
  /// `journal`: what earlier sinks accepted.
  SinkCore(MemberOptions member, JobSource source, std::map<JobKey, JobOutput> journal,
           WhenFull when_full = WhenFull::wait)
      : member_(std::move(member)),
        source_(std::move(source)),
        graph_(source_()),
        known_(std::move(journal)),
        when_full_(when_full) {}

  SinkActions tick(FarmTime now);
  SinkActions found(std::span<const Endpoint> endpoints, FarmTime now);
  SinkActions on_control(const Message& message, FarmTime now);
  SinkActions on_result(const Message& message);
  /// Answers a Check. `problem` has no reason if the file is good and, if it was not accepted yet,
  /// its record is on disk. no_space: there is no room for the record.
  SinkActions checked(const Check& check, const JobFailure& problem, FarmTime now);
  /// Answers DoHere: the output, unless there is a problem.
  SinkActions did(const DoHere& what, const JobOutput& output, const SinkProblem& problem,
                  FarmTime now);
  /// Answers MakeOutput.
  SinkActions completed(const SinkProblem& problem, FarmTime now);
  /// Whether it waits for room on the disk before it retries what could not be written.
  bool waits_for_room() const { return again_pause_.count() > 0; }
  /// Tells the ventilator that this sink cannot go on (its journal cannot be written).
  SinkActions fail(const SinkProblem& problem);
  SinkActions stop();

  const JobGraph& graph() const { return graph_; }
  /// Number of accepted results still to be verified or taken back.
  std::uint64_t unverified() const { return known_.unverified() + damaged_.size(); }
  /// Whether it was accepted by a size check and only its readers will notice damage.
  bool leaves_to_readers(JobKey key) const { return left_.contains(key); }
  /// The longest wait for messages before tick() must be called again.
  FarmTime pause(FarmTime now) const { return member_.pause(now); }
  /// The epoch of the ventilator joined last.
  std::uint32_t epoch() const { return member_.epoch(); }
  std::uint64_t dropped() const { return dropped_; }

 private:
  enum class Phase { collecting, making_output, saying_complete, saying_failed, left };

  void on(Membership::Event event, FarmTime now);
  void run_over();
  void take_result(const Result& result);
  std::optional<JobFailure> failure_to_tell(const Result& result, const JobFailure& failure);
  void take_in(const Check& check);
  void read_what_was_left();
  void verified(const Check& check, const JobFailure& problem);
  void begin_again(FarmTime now);
  void want(std::vector<WantedJob> jobs);
  std::vector<WantedJob> accept(const Check& check);
  void do_here(const DoHere& what);
  void look_for_end();
  void tell_all();
  void say_again();
  void say_where_it_stands();
  void tell(JobKey key, WorkerId worker, const JobTimes& times = {});
  void wait_for_room(FarmTime longest, FarmTime now);
  void try_again();
  void leave(SinkLeaves::Why why, std::string message);
  void leave_for_failed_jobs();
  void leave_for_problem();
  template <class A>
  void act(A action) {
    out_.push_back(std::move(action));
  }
  void say(Message message) { out_.push_back(Say{std::move(message)}); }
  SinkActions take();

  Membership member_;
  struct Wanted {
    std::string kind;
    bool needs_others = false;
    bool left_to_readers = false;
  };

  JobSource source_;
  JobGraph graph_;
  KnownResults known_;
  std::map<JobKey, Wanted> wanted_;  // since the graph was started
  std::map<JobKey, Job> own_;        // of these, those done by the sink
  std::vector<DoHere> waiting_;      // of these, those that wait until everything is verified
  std::set<JobKey> doing_;           // jobs of the sink for which DoHere was issued
  std::vector<DoHere> not_done_;     // of these, those that there was no room for
  std::set<JobKey> lack_room_;       // those, also while they are retried
  SinkActions out_;
  Phase phase_ = Phase::collecting;
  bool begun_ = false;
  bool told_all_ = false;  // to the current ventilator
  std::map<JobKey, Check> checking_;
  std::uint64_t looking_ = 0;     // number of known results being checked
  std::vector<JobKey> accepted_;  // in the order of acceptance
  std::map<JobKey, Check> left_;  // of these, results left to their readers
  std::set<JobKey> damaged_;      // of these, results to be taken back
  bool found_damage_ = false;
  /// Attempts that read a damaged input before everything was verified.
  std::set<std::pair<JobKey, std::uint32_t>> held_;
  std::map<JobKey, JobFailed> failed_;
  SinkProblem problem_;
  WhenFull when_full_;
  std::optional<FarmTime> again_at_;  // when to retry what there was no room for
  FarmTime again_pause_{0};           // 0: there is room
  std::vector<Check> unwritten_;      // checks whose records there was no room for
  FarmTime say_until_{0};
  std::uint64_t dropped_ = 0;
};

}  // namespace meshfarm
