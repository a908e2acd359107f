// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/pipeline/run_options.hpp>
#include <meshfarm/report/summary.hpp>

namespace meshfarm {

struct AssembleOptions {
  MeshOutput output;
  unsigned threads = 0;  // to measure with, 0: one per core; nothing depends on it
  std::function<void(std::string_view phase, double done, std::uint64_t triangles)> progress;
  const std::atomic<bool>* stop = nullptr;
};

/// The sink's part of a run: makes one mesh from the workers' results, and writes it.
class Assembler {
 public:
  /// Stage, manifest and run must outlive it.
  Assembler(const Stage& stage, const Manifest& manifest, const RunOptions& run,
            AssembleOptions options);
  ~Assembler();
  Assembler(const Assembler&) = delete;
  Assembler& operator=(const Assembler&) = delete;

  /// Does a job of make_job_source that is the sink's: finishes the mesh before other jobs go on
  /// with it. `accepted`: at least the jobs that made the mesh.
  JobOutput do_job(const Job& job, const JobContext& context,
                   std::span<const AcceptedJob> accepted);
  /// The end of a run, once every job is accepted: reads the chosen rungs, stitches them in the
  /// order of the parts, finishes to the target, and writes the result. Does not repeat what
  /// do_job() did. Throws IncompleteError when stopped; nothing is written then.
  RunSummary complete(std::span<const AcceptedJob> accepted);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace meshfarm
