// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/io/manifest.hpp>

namespace meshfarm {

/// The first stages of a run whose stage holds slabs: a sort job for each, and a sample job for
/// each stream longer than a sweep's window. A sample is a separate job, not made while its stream
/// is sorted, as a job has one output.
class SortStage {
 public:
  /// Updates the manifest to what it would be if the cut had sorted, except for file names: a
  /// stream when it is sorted, a sample when it is taken. Until then a sample has its estimated
  /// size.
  explicit SortStage(Manifest& manifest) : manifest_(manifest) {}

  /// Returns the jobs that sort everything. Later throws DataError for outputs that do not match
  /// the slabs.
  JobNeeds ask(JobGraph& graph);
  /// The job that takes the sample of a long stream; nothing if the sample existed before.
  JobNeeds sample_of(std::uint32_t stream) const;

 private:
  Job sort_job(std::uint32_t slab) const;
  Job sample_job(std::uint32_t stream) const;
  void take_stream(std::uint32_t slab, JobGraph& graph);

  Manifest& manifest_;
  bool takes_samples_ = false;
};

/// The manifest after sorting the slabs, as far as it is known: for estimates only.
Manifest as_if_sorted(Manifest manifest);

}  // namespace meshfarm
