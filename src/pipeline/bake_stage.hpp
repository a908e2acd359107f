// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/bake_job.hpp>
#include <meshfarm/pipeline/run_graph.hpp>
#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

/// Work per texel relative to simplifying a triangle: measured.
inline constexpr std::uint64_t k_cost_of_texel = 2;
/// Size of the cache of picture tiles in a bake job.
inline constexpr std::uint64_t k_tile_cache_bytes = std::uint64_t{64} << 20;
/// Maximum number of jobs that tile pictures: a bake job's parameters name all their files.
inline constexpr std::size_t k_most_tile_jobs = 64;

/// Memory for the input's parts in a bake job; the largest part fits in any case.
std::uint64_t bake_piece_bytes(const Manifest& manifest);
/// The total memory of a bake job.
std::uint64_t memory_of_bake(const Manifest& manifest);

/// Whether a run makes a new texture.
bool bakes_texture(const Manifest& manifest, const RunOptions& options);

/// The last stages of a run that makes a new texture: the sink finishes the mesh, workers tile the
/// pictures that it shows, and bake its chunks. A bake job needs all tiles, as any may be near its
/// chunk.
class BakeStage {
 public:
  /// All must outlive this.
  BakeStage(const Manifest& manifest, const RunOptions& options, BakedTexture& baked)
      : manifest_(manifest), options_(options), baked_(baked) {}

  /// Asks for everything from the finish on.
  void begin(JobGraph& graph, const ChosenRungs& chosen);

 private:
  Job finish_job(const ChosenRungs& chosen) const;
  std::vector<Job> tile_jobs() const;
  Job bake_job(std::uint32_t chunk) const;
  void tile(JobGraph& graph);
  void bake(JobGraph& graph);

  const Manifest& manifest_;
  const RunOptions& options_;
  BakedTexture& baked_;
  FileRef finished_;
  FinishSummary finish_;
  std::vector<TiledPicturesRef> pictures_;
};

}  // namespace meshfarm
