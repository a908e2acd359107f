// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include <meshfarm/farm/job.hpp>

namespace meshfarm {

struct JobKeyHash {
  std::size_t operator()(JobKey key) const { return static_cast<std::size_t>(key.value); }
};

struct WantedJob {
  JobKey key;
  Job job;
};

/// What a source wants, round by round, and what of it is accepted. Ventilator and sink each keep
/// one. A job asked for twice is the same job: it is done once and its output is given twice.
class Rounds {
 public:
  explicit Rounds(JobSource source) : source_(std::move(source)) {}

  /// Asks for the next round if all that was wanted so far is accepted. Returns the jobs that were
  /// not wanted before; none when nothing new is wanted now.
  std::vector<WantedJob> advance();
  /// Marks a wanted job as accepted. False if it is not wanted, or was accepted before.
  bool accept(JobKey key, const JobOutput& output);

  bool wanted(JobKey key) const { return entries_.contains(key); }
  /// The accepted output; null if there is none.
  const JobOutput* accepted(JobKey key) const;
  /// True once the source wants no more and all is accepted.
  bool complete() const { return complete_; }
  /// In the order in which the jobs were asked for; of the rounds that are accepted whole.
  std::span<const AcceptedJob> outputs() const { return outputs_; }
  std::uint64_t jobs_wanted() const { return entries_.size(); }
  std::uint64_t jobs_accepted() const { return jobs_accepted_; }

 private:
  struct Entry {
    bool accepted = false;
    JobOutput output;
  };
  JobSource source_;
  std::unordered_map<JobKey, Entry, JobKeyHash> entries_;  // for look-up, never iterated
  std::vector<JobKey> round_;                              // asked for in this round, in order
  std::vector<AcceptedJob> outputs_;
  std::uint64_t jobs_accepted_ = 0;
  bool complete_ = false;
};

}  // namespace meshfarm
