// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/farm/job_graph.hpp>

namespace meshfarm {

/// The stages of a run's jobs.
enum class RunStage : std::uint32_t {
  survey,
  count,
  partition,
  vertices,
  triangles,
  sort,
  sample,
  climb,
  join,
  sweep,
  compose,
  components,
  split,
  seam,
  reduce,
  measure,
  write,
  finish,
  tile,
  bake
};

/// Their names, in that order.
inline JobGraph empty_graph(std::uint32_t algorithm) {
  return JobGraph({"survey", "count",   "partition", "vertices", "triangles",  "sort",  "sample",
                   "climb",  "join",    "sweep",     "compose",  "components", "split", "seam",
                   "reduce", "measure", "write",     "finish",   "tile",       "bake"},
                  algorithm);
}

inline JobName job_name(RunStage stage, std::size_t index) {
  return {static_cast<std::uint32_t>(stage), static_cast<std::uint32_t>(index)};
}

inline JobRange just(const JobName& name) {
  return {name.stage, name.index, 1};
}

inline JobRange jobs_of(RunStage stage, std::size_t first, std::size_t count) {
  return {static_cast<std::uint32_t>(stage), static_cast<std::uint32_t>(first),
          static_cast<std::uint32_t>(count)};
}

}  // namespace meshfarm
