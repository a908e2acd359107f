// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/io/manifest.hpp>

namespace meshfarm {

/// The first rounds of a run whose stage holds slabs: a sort job each, then a sample job for each
/// stream that is longer than a sweep's window. A sample is a job of its own, and not made while
/// its stream is sorted, as a job has one output. Derived from the accepted outputs alone.
class SortPlan {
 public:
  /// Throws DataError for outputs that cannot be those of the slabs.
  SortPlan(Manifest manifest, std::span<const AcceptedJob> accepted);
  /// The round that is not accepted yet; none once all is sorted.
  const std::vector<Job>& jobs() const { return jobs_; }
  /// Once all is sorted: what it would be if the cut had sorted, but for the names of the files.
  const Manifest& manifest() const { return manifest_; }
  /// What was accepted after these rounds.
  std::span<const AcceptedJob> rest() const { return rest_; }

 private:
  std::vector<Job> sort_jobs() const;
  std::vector<Job> sample_jobs() const;
  bool accepts(std::vector<Job> jobs);
  void take_streams();
  void take_samples();
  const JobOutput& next();

  Manifest manifest_;
  std::span<const AcceptedJob> rest_;
  std::vector<Job> jobs_;
};

/// What will be once the slabs are sorted, as far as it can be told: for estimates only.
Manifest as_if_sorted(Manifest manifest);

}  // namespace meshfarm
