// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <mutex>
#include <set>
#include <vector>

#include <meshfarm/farm/sink_core.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/transport/sink.hpp>

namespace meshfarm {

/// A Check and its result.
struct CheckedResult {
  Check check;
  JobFailure problem = {};
  bool to_record = false;  // in the journal
};

/// Checks the files of results for the sink.
class ResultChecker {
 public:
  /// `recorded`: the jobs that the run itself accepted, according to the journals.
  ResultChecker(const Stage& stage, const SinkOptions& options, const std::set<JobKey>& recorded)
      : stage_(stage), options_(options), recorded_(recorded) {}

  /// Checks on this many threads. They share the patience with storage: no result is reported
  /// before all have been checked.
  void check_all(std::vector<CheckedResult>& batch, ReadPatience& fresh, ReadPatience& known,
                 unsigned threads) const;

 private:
  void check(CheckedResult& each, ReadPatience& shared, std::mutex& mutex) const;

  const Stage& stage_;
  const SinkOptions& options_;
  const std::set<JobKey>& recorded_;
};

}  // namespace meshfarm
