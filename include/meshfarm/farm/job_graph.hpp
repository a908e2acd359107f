// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <meshfarm/farm/job.hpp>

namespace meshfarm {

struct JobKeyHash {
  std::size_t operator()(JobKey key) const { return static_cast<std::size_t>(key.value); }
};

/// The place of a job in its run.
struct JobName {
  std::uint32_t stage = 0;
  std::uint32_t index = 0;
  friend auto operator<=>(const JobName&, const JobName&) = default;
};

/// Consecutive jobs of one stage.
struct JobRange {
  std::uint32_t stage = 0;
  std::uint32_t first = 0;
  std::uint32_t count = 1;
  friend auto operator<=>(const JobRange&, const JobRange&) = default;
};

/// The jobs that must be accepted before something is possible: sorted, without overlaps.
using JobNeeds = std::vector<JobRange>;

/// The same in words, for observers.
struct JobPlace {
  struct Need {
    std::string stage;
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };
  std::string stage;
  std::uint32_t index = 0;
  std::vector<Need> needs = {};
};

/// The progress of a stage, out of the jobs known so far.
struct StageProgress {
  std::string stage;
  std::uint64_t jobs = 0;
  std::uint64_t accepted = 0;
  friend bool operator==(const StageProgress&, const StageProgress&) = default;
};

struct WantedJob {
  JobKey key;
  Job job;
  JobName name;
};

/// The jobs of a run and what each one needs. It grows as the run goes on, since later jobs may
/// depend on outputs. Ventilator and sink each keep a graph; they learn of outputs in different
/// orders and still arrive at the same jobs: a function that makes a job is called once everything
/// it needs is accepted, and must depend only on the outputs of its needs.
///
/// A job requested under two names is the same job: it is done once and its output is given twice.
class JobGraph {
 public:
  /// Makes a job whose needs are accepted. Returns nothing if there is no work: its dependents go
  /// on.
  using Make = std::function<std::optional<Job>(JobGraph&)>;
  using Step = std::function<void(JobGraph&)>;

  /// The stages by name, in order: jobs come after those of earlier stages. All jobs are of this
  /// algorithm version.
  explicit JobGraph(std::vector<std::string> stages, std::uint32_t algorithm = 0);
  JobGraph(JobGraph&&) = default;
  JobGraph& operator=(JobGraph&&) = default;
  JobGraph(const JobGraph&) = delete;  // its functions may hold a state
  JobGraph& operator=(const JobGraph&) = delete;

  // --- describing a run

  /// A name can be given only once. Jobs added by a step or a job's function inherit all of its
  /// needs.
  void add(JobName name, Job job);
  void add(JobName name, const JobNeeds& needs, Make make);
  /// A step of the run that is no job: it may add jobs that depend on outputs. Steps and jobs'
  /// functions that become possible at the same time are called in the order in which they were
  /// added.
  void then(const JobNeeds& needs, Step step);
  /// Keeps alive the state that the functions refer to.
  void keep(std::shared_ptr<const void> state) { state_ = std::move(state); }
  /// Called with each wanted job; may throw.
  void inspect(std::function<void(const Job&)> inspect) { inspect_ = std::move(inspect); }
  /// The output of an accepted job.
  const JobOutput& output(JobName name) const;

  // --- reporting what is done

  /// The jobs that are possible at the start.
  std::vector<WantedJob> begin() { return go_on(); }
  /// The jobs that become possible when this one is accepted; none if it is not waited for.
  std::vector<WantedJob> accept(JobKey key, const JobOutput& output);

  bool wanted(JobKey key) const { return jobs_.contains(key); }
  /// Whether the job is wanted and not yet accepted.
  bool waits_for(JobKey key) const { return wanted(key) && accepted(key) == nullptr; }
  /// The accepted output, or null.
  const JobOutput* accepted(JobKey key) const;
  /// True once nothing is left to do.
  bool complete() const { return open_ == 0; }
  /// The outputs of all names whose jobs are accepted, in the order of the names.
  std::vector<AcceptedJob> outputs() const;
  std::uint64_t jobs_wanted() const { return jobs_.size(); }
  std::uint64_t jobs_accepted() const { return jobs_accepted_; }

  /// Of the stages that have jobs, in order.
  std::vector<StageProgress> progress() const;

  /// What had to be accepted before this job was possible.
  const JobNeeds& needs(JobName name) const;
  JobPlace place(JobName name) const;

 private:
  enum class State : std::uint8_t { unknown, waiting, wanted, accepted };
  struct Node {
    State state = State::unknown;
    std::uint32_t missing = 0;  // unmet needs
    std::optional<JobKey> key;  // set once wanted; none: no job
    JobNeeds needs;
    Make make;
    std::vector<JobName> needed_by;
  };
  struct Stage {
    std::string name;
    std::vector<Node> nodes;        // by index
    std::uint32_t accepted_to = 0;  // all jobs before this index are accepted
    std::uint64_t jobs = 0;
    std::uint64_t jobs_accepted = 0;
  };
  struct Entry {
    std::vector<JobName> names;
    bool accepted = false;
    JobOutput output;
  };

  Node& node(JobName name);
  void wait_for(const JobRange& range, JobName who);
  std::vector<WantedJob> go_on();
  void make(JobName name, std::vector<WantedJob>& fresh);
  void pass(JobName name);

  std::vector<Stage> stages_;  // the last one holds the steps
  std::uint32_t algorithm_;
  std::unordered_map<JobKey, Entry, JobKeyHash> jobs_;  // for look-up, never iterated
  std::deque<JobName> possible_;
  JobNeeds inherited_;  // by the jobs being made
  std::uint64_t open_ = 0;
  std::uint64_t jobs_accepted_ = 0;
  std::function<void(const Job&)> inspect_;
  std::shared_ptr<const void> state_;
};

/// Starts a run's graph. Each call makes a new graph that behaves the same.
using JobSource = std::function<JobGraph()>;

/// All names of a stage with indices below `count`.
inline JobRange all_of(std::uint32_t stage, std::size_t count) {
  return {stage, 0, static_cast<std::uint32_t>(count)};
}

}  // namespace meshfarm
