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
  /// result: it came just now; verify its file and journal it.
  /// large: it came just now; see whether a file of its name and size is there, and journal it.
  /// known: a journal knows it; see whether a file of its name and size is there.
  /// accepted: of the last two, one that was accepted by that look; verify it when nothing else
  /// waits.
  enum class What : std::uint8_t { result, large, known, accepted };

  JobKey key;
  JobOutput output;
  What what = What::result;
  WorkerId worker = {};       // of a result; 0: the sink made it
  std::uint32_t attempt = 0;  // of a worker's result
  JobTimes times = {};
  std::string kind = {};         // of the job
  bool left_to_readers = false;  // as the job has it
};
/// Do a job that the sink does itself; answered by did().
struct DoHere {
  JobKey key;
  Job job;
  JobTimes times = {};  // once it is done
};
/// Make the run's output of JobGraph::outputs(); answered by completed().
struct MakeOutput {};
/// The end of the sink.
struct SinkLeaves {
  enum class Why { complete, incomplete, jobs_failed, output_failed };
  Why why = Why::complete;
  std::string message;
};
/// Why the output, the journal or a job of the sink could not be written; nothing: it was.
struct SinkProblem {
  std::string text;
  bool no_room = false;  // the disk was full: the same run may be completed later
};
using SinkAction = std::variant<Look, Dial, HangUp, Say, Check, DoHere, MakeOutput, SinkLeaves>;
using SinkActions = std::vector<SinkAction>;

/// The sink's mind: what is wanted, what is accepted, what the ventilator has been told. Pure.
/// Holds: a job is accepted, and told, only after checked() said that its result is verified and
/// on disk, or looked at if a journal knows it, or if it is large: all results go through the
/// sink's link, and jobs would wait for that. Those are verified while the farm works: neither
/// the output nor a job of the sink is made before, and what is damaged is taken back. For that the
/// sink begins its graph again, without it, and greets the ventilator as a new sink would that has
/// the others: the job is made again, and what was made from it before stays. From then on all
/// that comes is verified first, so that who damages results is found out. What is left to its
/// readers (Job::left_to_readers) is read only once one of them, or the sink, found damage.
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
  /// The answer to a Check: `problem` has no reason if the file is as it should be, and the record
  /// of what is not accepted yet is on the disk. no_space: there is no room for the record.
  SinkActions checked(const Check& check, const JobFailure& problem, FarmTime now);
  /// The answer to DoHere: what was made, if there is no problem.
  SinkActions did(const DoHere& what, const JobOutput& output, const SinkProblem& problem,
                  FarmTime now);
  /// The answer to MakeOutput.
  SinkActions completed(const SinkProblem& problem, FarmTime now);
  /// Whether it waits for room on the disk, to try again then what it could not write.
  bool waits_for_room() const { return again_pause_.count() > 0; }
  /// Tells the ventilator that this sink cannot go on (its journal cannot be written).
  SinkActions fail(const SinkProblem& problem);
  SinkActions stop();

  const JobGraph& graph() const { return graph_; }
  /// How many of the accepted are to be verified yet, or to be taken back.
  std::uint64_t unverified() const { return known_.unverified() + damaged_.size(); }
  /// Whether it is accepted by a look, and nobody but its readers will tell if it is damaged.
  bool leaves_to_readers(JobKey key) const { return left_.contains(key); }
  /// How long to wait for messages before tick() is called again, at most.
  FarmTime pause(FarmTime now) const { return member_.pause(now); }
  /// Of the ventilator that was joined last.
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
  std::map<JobKey, Wanted> wanted_;  // the jobs that are, since the graph was begun
  std::map<JobKey, Job> own_;        // of these, those that the sink does
  std::vector<DoHere> waiting_;      // of these, those that wait until all is verified
  std::set<JobKey> doing_;           // jobs of the sink that DoHere was said of
  std::vector<DoHere> not_done_;     // of these, those that there was no room for
  std::set<JobKey> lack_room_;       // those, also while they are tried again
  SinkActions out_;
  Phase phase_ = Phase::collecting;
  bool begun_ = false;
  bool told_all_ = false;  // to the ventilator joined now
  std::map<JobKey, Check> checking_;
  std::uint64_t looking_ = 0;     // how many of those a journal knows
  std::vector<JobKey> accepted_;  // in the order of acceptance
  std::map<JobKey, Check> left_;  // of these, what is read only if something is damaged
  std::set<JobKey> damaged_;      // of these, what is to be taken back
  bool found_damage_ = false;
  /// Attempts that read a damaged input while not all was verified.
  std::set<std::pair<JobKey, std::uint32_t>> held_;
  std::map<JobKey, JobFailed> failed_;
  SinkProblem problem_;
  WhenFull when_full_;
  std::optional<FarmTime> again_at_;  // when what there was no room for is tried again
  FarmTime again_pause_{0};           // 0: there is room
  std::vector<Check> unwritten_;      // whose records there was no room for
  FarmTime say_until_{0};
  std::uint64_t dropped_ = 0;
};

}  // namespace meshfarm
