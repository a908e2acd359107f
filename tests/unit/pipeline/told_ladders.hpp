// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Runs whose jobs tell ladders that nobody has climbed.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/run_graph.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>
#include <meshfarm/pipeline/sweep_job.hpp>

#include "support/next_jobs.hpp"

namespace meshfarm::test {

inline Rung rung(std::int32_t level, std::uint64_t triangles) {
  return {level, triangles / 2, triangles, triangles};
}

inline Manifest manifest_of(std::uint32_t parts, std::uint64_t triangles_each) {
  Manifest m;
  m.box.add({0, 0, 0});
  m.box.add({1, 1, 1});
  for (std::uint32_t p = 0; p < parts; ++p) {
    m.parts.push_back({{to_string(PartName{p}), 100, p},
                       triangles_each / 2,
                       triangles_each,
                       10,
                       triangles_each,
                       10});
    m.input_triangles += triangles_each;
  }
  return m;
}

inline AcceptedJob accepted(const Job& job, const ResultSummary& summary) {
  return {key_of(job),
          {{to_string(ResultName{key_of(job).value, 1, 1}), 1, key_of(job).value},
           encode_summary(summary)}};
}

inline AcceptedJob accepted(const Job& job, std::vector<Rung> rungs) {
  return accepted(job, ResultSummary{.rungs = std::move(rungs)});
}

/// The result of a part that its topology held back at its last rung.
inline AcceptedJob accepted_held(const Job& job, std::vector<Rung> rungs) {
  return accepted(job, ResultSummary{.rungs = std::move(rungs), .held_by_topology = true});
}

/// The result of a part whose ladder ended for the reason `end`.
inline AcceptedJob accepted_ended(const Job& job, std::vector<Rung> rungs, LadderEnd end) {
  return accepted(job, ResultSummary{.rungs = std::move(rungs), .end = end});
}

/// The jobs that are possible once some jobs are accepted.
inline auto next_of(const Manifest& manifest, const RunOptions& options) {
  return [source = make_job_source(manifest, options)](std::span<const AcceptedJob> accepted) {
    return next_jobs(source, accepted);
  };
}

inline ChosenRungs chosen_of(const Manifest& manifest, const RunOptions& options,
                             std::span<const AcceptedJob> accepted) {
  return state_of_run(manifest, options, accepted).chosen.value();
}

inline TopologyMode topology_of(const Job& job) {
  return job.kind == k_sweep_kind ? decode_sweep_parameters(job.parameters).lines.topology
                                  : decode_parameters(job.parameters).lines.topology;
}

}  // namespace meshfarm::test
