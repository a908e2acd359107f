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

/// Where a job stands in its run.
struct JobName {
  std::uint32_t stage = 0;
  std::uint32_t index = 0;
  friend auto operator<=>(const JobName&, const JobName&) = default;
};

/// Neighbours of one stage.
struct JobRange {
  std::uint32_t stage = 0;
  std::uint32_t first = 0;
  std::uint32_t count = 1;
  friend auto operator<=>(const JobRange&, const JobRange&) = default;
};

/// What is to be accepted before something is possible: sorted, without overlaps.
using JobNeeds = std::vector<JobRange>;

/// The same in words, for those who watch.
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

/// How far a stage is, of the jobs that are known of.
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

/// The jobs of a run and what each needs. Grows as the run goes on: what is to be done may depend
/// on outputs. Ventilator and sink each keep one, are told of outputs in different orders, and come
/// to the same jobs: a function that makes a job is called once all that it needs is accepted, and
/// is to depend on the outputs of that alone.
///
/// A job asked for under two names is the same job: it is done once and its output is given twice.
class JobGraph {
 public:
  /// Makes a job whose needs are accepted; nothing if there is none to do: what needs it goes on.
  using Make = std::function<std::optional<Job>(JobGraph&)>;
  using Step = std::function<void(JobGraph&)>;

  /// The stages by name, each job after the stages before. All jobs are of this algorithm.
  explicit JobGraph(std::vector<std::string> stages, std::uint32_t algorithm = 0);
  JobGraph(JobGraph&&) = default;
  JobGraph& operator=(JobGraph&&) = default;
  JobGraph(const JobGraph&) = delete;  // its functions may hold a state
  JobGraph& operator=(const JobGraph&) = delete;

  // --- to be told what a run is

  /// Names are given once. What is added by a step or a job's function needs all that this did.
  void add(JobName name, Job job);
  void add(JobName name, const JobNeeds& needs, Make make);
  /// A step of the run that is no job: it may add what depends on outputs. Of what becomes possible
  /// at once, what was added first is called first.
  void then(const JobNeeds& needs, Step step);
  /// Keeps what the functions refer to.
  void keep(std::shared_ptr<const void> state) { state_ = std::move(state); }
  /// Called with each job that is wanted; may throw.
  void inspect(std::function<void(const Job&)> inspect) { inspect_ = std::move(inspect); }
  /// Of a job that is accepted.
  const JobOutput& output(JobName name) const;

  // --- to be told what is done

  /// The jobs that are possible at once.
  std::vector<WantedJob> begin() { return go_on(); }
  /// The jobs that become possible as this one is accepted. None if it does not wait for that.
  std::vector<WantedJob> accept(JobKey key, const JobOutput& output);

  bool wanted(JobKey key) const { return jobs_.contains(key); }
  /// Whether the job is wanted and not accepted yet.
  bool waits_for(JobKey key) const { return wanted(key) && accepted(key) == nullptr; }
  /// The accepted output; null if there is none.
  const JobOutput* accepted(JobKey key) const;
  /// True once there is nothing more to do.
  bool complete() const { return open_ == 0; }
  /// Of all names whose jobs are accepted, in the order of the names.
  std::vector<AcceptedJob> outputs() const;
  std::uint64_t jobs_wanted() const { return jobs_.size(); }
  std::uint64_t jobs_accepted() const { return jobs_accepted_; }

  /// Of the stages that have jobs, in order.
  std::vector<StageProgress> progress() const;

  /// What was accepted before this was possible.
  const JobNeeds& needs(JobName name) const;
  JobPlace place(JobName name) const;

 private:
  enum class State : std::uint8_t { unknown, waiting, wanted, accepted };
  struct Node {
    State state = State::unknown;
    std::uint32_t missing = 0;  // of its needs
    std::optional<JobKey> key;  // once wanted; none: no job
    JobNeeds needs;
    Make make;
    std::vector<JobName> needed_by;
  };
  struct Stage {
    std::string name;
    std::vector<Node> nodes;        // by index
    std::uint32_t accepted_to = 0;  // all before are accepted
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

  std::vector<Stage> stages_;  // the last is that of the steps
  std::uint32_t algorithm_;
  std::unordered_map<JobKey, Entry, JobKeyHash> jobs_;  // for look-up, never iterated
  std::deque<JobName> possible_;
  JobNeeds inherited_;  // of what is being made
  std::uint64_t open_ = 0;
  std::uint64_t jobs_accepted_ = 0;
  std::function<void(const Job&)> inspect_;
  std::shared_ptr<const void> state_;
};

/// Begins a run's graph. Each call makes another one, which does the same.
using JobSource = std::function<JobGraph()>;

/// All names of one stage up to a count.
inline JobRange all_of(std::uint32_t stage, std::size_t count) {
  return {stage, 0, static_cast<std::uint32_t>(count)};
}

}  // namespace meshfarm
