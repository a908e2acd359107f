// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/divide/block_cut.hpp>
#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/io/manifest.hpp>

#include "pipeline/part_results.hpp"

namespace meshfarm {

/// The first stages of a run whose input is cut by jobs: survey, count and partition, as often as
/// the cells require, then scatter vertices and triangles. Parts are built by the jobs that
/// simplify them. The outputs of these jobs make the manifest and the boundary the same as those of
/// a cut.
class CutStage {
 public:
  explicit CutStage(Manifest& manifest) : manifest_(manifest) {}

  /// Cuts, and continues with `then` once parts can be built.
  void begin(JobGraph& graph, JobGraph::Step then);
  /// The bundles that parts are built from; null if the cut was made before the run.
  const BundlesOfMesh* bundles() const { return cuts_ ? &bundles_ : nullptr; }
  /// Call this once all parts have ladders: completes the manifest if necessary, and continues.
  void join(JobGraph& graph, const PartResults& results, JobGraph::Step then);

 private:
  void survey(JobGraph& graph);
  void count(JobGraph& graph, std::uint32_t round);
  void scatter_vertices(JobGraph& graph);
  void scatter_triangles(JobGraph& graph);
  void take_surveys(const JobGraph& graph);
  void take_vertices(const JobGraph& graph);
  void take_triangles(const JobGraph& graph);
  void take_ladders(const PartResults& results);
  void take_boundary(const JobGraph& graph, std::uint32_t group);
  Job job_of(std::string_view kind, std::uint64_t cost, std::uint64_t memory) const;
  std::uint64_t bytes_of_vertices() const;
  void reads_vertices(Job& job, std::uint32_t block) const;
  std::uint64_t vertices_of_block() const;
  std::uint64_t triangles_of_block() const;

  Manifest& manifest_;
  bool cuts_ = false;
  bool joined_ = false;
  Cutting cutting_;
  JobGraph::Step then_;
  FileRef cells_;  // of the last partition job
  BundlesOfMesh bundles_;
};

/// The memory of the largest job of a cut, in bytes.
std::uint64_t memory_of_cut(const Manifest& manifest);

/// The manifest that a cut of the input will make, as far as it is known: for estimates only.
Manifest as_if_cut(Manifest manifest);

}  // namespace meshfarm
