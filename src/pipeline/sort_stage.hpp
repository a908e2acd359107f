// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/io/manifest.hpp>

namespace meshfarm {

/// The first stages of a run whose stage holds slabs: a sort job each, and a sample job for each
/// stream that is longer than a sweep's window. A sample is a job of its own, and not made while
/// its stream is sorted, as a job has one output.
class SortStage {
 public:
  /// The manifest becomes what it would be if the cut had sorted, but for the names of files: a
  /// stream as it is sorted, a sample as it is taken. Until then a sample is as large as estimated.
  explicit SortStage(Manifest& manifest) : manifest_(manifest) {}

  /// Returns what sorts all. Throws DataError later for outputs that cannot be those of the slabs.
  JobNeeds ask(JobGraph& graph);
  /// What takes the sample of a long stream; nothing if it was there before.
  JobNeeds sample_of(std::uint32_t stream) const;

 private:
  Job sort_job(std::uint32_t slab) const;
  Job sample_job(std::uint32_t stream) const;
  void take_stream(std::uint32_t slab, JobGraph& graph);

  Manifest& manifest_;
  bool takes_samples_ = false;
};

/// What will be once the slabs are sorted, as far as it can be told: for estimates only.
Manifest as_if_sorted(Manifest manifest);

}  // namespace meshfarm
