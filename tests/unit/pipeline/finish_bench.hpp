// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Runs whose finish consists of jobs, without processes. With Composition::sink every part is a
// piece.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/pipeline/assemble.hpp>
#include <meshfarm/pipeline/job_table.hpp>
#include <meshfarm/pipeline/run_graph.hpp>

#include "support/memory_source.hpp"
#include "support/meshes.hpp"
#include "support/next_jobs.hpp"
#include "support/temp_folder.hpp"

namespace meshfarm::test {

/// A stage, and runs on it.
class FinishBench {
 public:
  FinishBench(const Mesh& mesh, std::uint32_t parts) : FinishBench(mesh, {.parts = parts}) {}
  FinishBench(const Mesh& mesh, const CutOptions& options)
      : stage_(Stage::create(folder_.path() / "stage")) {
    MemorySource source(mesh);
    manifest_ = cut_mesh(source, stage_, options);
  }

  static RunOptions bounded(double share) {
    return {.error = {share, true}, .finish_place = FinishPlace::farm};
  }
  static RunOptions farmed(std::uint64_t triangles) {
    return {.triangles = triangles,
            .finish_place = FinishPlace::farm,
            .composition = Composition::sink};
  }

  /// Does the jobs in the order in which they are asked for, or backwards. If backwards, another
  /// sink ends the run than the one that did its jobs.
  RunSummary run(const RunOptions& options, const std::string& name, bool backwards = false) {
    const JobSource jobs_of = make_job_source(manifest_, options);
    const JobContext context{stage_, 1, ++incarnation_, [](std::uint64_t) { return true; }};
    std::vector<AcceptedJob> accepted;
    kinds_.clear();
    std::filesystem::remove(path(name));
    const AssembleOptions output{.output = {path(name)}, .threads = 1};
    auto sink = std::make_unique<Assembler>(stage_, manifest_, options, output);
    for (std::vector<Job> jobs = next_jobs(jobs_of, accepted); !jobs.empty();
         jobs = next_jobs(jobs_of, accepted)) {
      if (backwards) std::reverse(jobs.begin(), jobs.end());
      for (const Job& job : jobs) {
        ++kinds_[job.kind];
        const JobOutput made =
            job.by_sink ? sink->do_job(job, context, accepted) : do_job(job, context);
        accepted.push_back({key_of(job), made});
        check_output(job.kind, accepted.back().output);
      }
    }
    CHECK_FALSE(std::filesystem::exists(path(name)));  // before the end
    if (backwards) sink = std::make_unique<Assembler>(stage_, manifest_, options, output);
    return sink->complete(accepted);
  }

  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  Mesh mesh(const std::string& name) const { return read_mesh(*open_mesh(path(name))); }
  std::map<std::string, int>& kinds() { return kinds_; }

 private:
  TempFolder folder_;
  Stage stage_;
  Manifest manifest_;
  std::uint64_t incarnation_ = 0;
  std::map<std::string, int> kinds_;
};

inline void check_clean(const Topology& t) {
  CHECK(t.components == 1);
  CHECK(t.nonmanifold_edges == 0);
  CHECK(t.orientation_conflicts == 0);
  CHECK(t.degenerate + t.zero_area + t.duplicate == 0);
}

/// `parts` parts, or as many streams that are swept.
inline std::vector<CutOptions> both_schemes(std::uint32_t parts) {
  return {{.parts = parts}, {.scheme = Scheme::stream, .parts = parts, .window_triangles = 1'500}};
}

inline Mesh waves(std::uint32_t side) {
  Mesh mesh = grid(side, side);
  for (Vec3& p : mesh.positions) p.z = 2 * std::sin(p.x * 0.11) * std::cos(p.y * 0.07);
  return mesh;
}

}  // namespace meshfarm::test
