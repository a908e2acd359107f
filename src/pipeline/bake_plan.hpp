// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/bake_job.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

/// Work on a texel beside that on a triangle which is simplified: measured.
inline constexpr std::uint64_t k_cost_of_texel = 2;
/// Tiles of pictures that a bake job keeps in memory.
inline constexpr std::uint64_t k_tile_cache_bytes = std::uint64_t{64} << 20;
/// Jobs that tile pictures, at most: a bake job's parameters name all their files.
inline constexpr std::size_t k_most_tile_jobs = 64;

/// Of the input's parts that a bake job keeps in memory; the largest fits in any case.
std::uint64_t bake_piece_bytes(const Manifest& manifest);
/// What a bake job takes in all.
std::uint64_t memory_of_bake(const Manifest& manifest);

/// Whether a run makes a new texture.
bool bakes_texture(const Manifest& manifest, const RunOptions& options);

/// The rounds of a run that makes a new texture, after those that make the mesh: finish, tile,
/// bake. Derived from the accepted outputs alone.
class BakePlan {
 public:
  /// `accepted`: of these rounds. Throws DataError for outputs that cannot be theirs.
  BakePlan(const Manifest& manifest, const RunOptions& options, const ChosenRungs& chosen,
           std::span<const AcceptedJob> accepted);
  /// The round that is not accepted yet; none once all is baked.
  const std::vector<Job>& jobs() const { return jobs_; }
  /// Once all is baked: the files of the chunks' texels.
  const std::vector<FileRef>& texels() const { return texels_; }
  /// Numbers of pictures that could not be decoded.
  const std::vector<std::uint32_t>& damaged() const { return damaged_; }

 private:
  Job finish_job(const ChosenRungs& chosen) const;
  std::vector<Job> tile_jobs() const;
  std::vector<Job> bake_jobs() const;
  bool accepts(std::vector<Job> jobs);
  const JobOutput& next();

  const Manifest& manifest_;
  const RunOptions& options_;
  std::span<const AcceptedJob> rest_;
  std::vector<Job> jobs_;
  FileRef finished_;
  FinishSummary finish_;
  std::vector<TiledPicturesRef> pictures_;
  std::vector<std::uint32_t> damaged_;
  std::vector<FileRef> texels_;
};

}  // namespace meshfarm
