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
/// the cells ask for it, then scatter vertices and triangles. Parts are built by the jobs that
/// simplify them. What these tell makes the manifest and the boundary what a cut would have made.
class CutStage {
 public:
  explicit CutStage(Manifest& manifest) : manifest_(manifest) {}

  /// Cuts, and goes on once parts can be built.
  void begin(JobGraph& graph, JobGraph::Step then);
  /// What parts are built of; null if the cut was made before the run.
  const BundlesOfMesh* bundles() const { return cuts_ ? &bundles_ : nullptr; }
  /// Once all parts have ladders: completes the manifest, if it is not complete, and goes on.
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

/// What the largest job of a cut takes, in bytes.
std::uint64_t memory_of_cut(const Manifest& manifest);

/// What will be once the input is cut, as far as it can be told: for estimates only.
Manifest as_if_cut(Manifest manifest);

}  // namespace meshfarm
