// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/bake_stage.hpp"

#include <algorithm>
#include <utility>

#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>

#include "pipeline/run_stages.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_bake_process_bytes = std::uint64_t{16} << 20;
/// A part with its columns, its search structure, and the file it is read from.
constexpr std::uint64_t k_bytes_of_triangle = 150;
constexpr std::uint64_t k_usual_pieces = std::uint64_t{128} << 20;
/// A chunk as read, as painted, and its texels.
constexpr std::uint64_t k_chunk_bytes = std::uint64_t{64} << 20;
/// This many bytes of a picture's file take as long to decode as a triangle takes to simplify.
constexpr std::uint64_t k_bytes_of_cost = 16;

std::uint64_t largest_part(const Manifest& manifest) {
  std::uint64_t most = 0;
  for (const PartEntry& part : manifest.parts) most = std::max(most, part.triangles);
  return most;
}

}  // namespace

std::uint64_t bake_piece_bytes(const Manifest& manifest) {
  const std::uint64_t all = k_bytes_of_triangle * manifest.triangles();
  return std::max(std::min(k_usual_pieces, all), k_bytes_of_triangle * largest_part(manifest));
}

std::uint64_t memory_of_bake(const Manifest& manifest) {
  return k_bake_process_bytes + bake_piece_bytes(manifest) + k_tile_cache_bytes + k_chunk_bytes;
}

bool bakes_texture(const Manifest& manifest, const RunOptions& options) {
  return chosen_textures(manifest, options) == TextureMode::bake;
}

void BakeStage::begin(JobGraph& graph, const ChosenRungs& chosen) {
  const JobName finish = job_name(RunStage::finish, 0);
  graph.add(finish, finish_job(chosen));
  graph.then({just(finish)}, [this, finish](JobGraph& so_far) {
    const JobOutput& finished = so_far.output(finish);
    finished_ = finished.file;
    finish_ = decode_finish_summary(finished.summary, "summary of " + finished.file.name);
    tile(so_far);
  });
}

void BakeStage::tile(JobGraph& graph) {
  std::size_t tiles = 0;
  for (Job& job : tile_jobs()) graph.add(job_name(RunStage::tile, tiles++), std::move(job));
  graph.then({jobs_of(RunStage::tile, 0, tiles)}, [this, tiles](JobGraph& so_far) {
    for (std::size_t i = 0; i < tiles; ++i) {
      const JobOutput& output = so_far.output(job_name(RunStage::tile, i));
      TileSummary summary = decode_tile_summary(output.summary, "summary of " + output.file.name);
      pictures_.push_back({output.file, summary.directory});
      baked_.damaged.insert(baked_.damaged.end(), summary.damaged.begin(), summary.damaged.end());
    }
    bake(so_far);
  });
}

void BakeStage::bake(JobGraph& graph) {
  const auto chunks = static_cast<std::uint32_t>(finish_.chunk_texels.size());
  for (std::uint32_t c = 0; c < chunks; ++c) {
    graph.add(job_name(RunStage::bake, c), bake_job(c));
  }
  graph.then({jobs_of(RunStage::bake, 0, chunks)}, [this, chunks](JobGraph& so_far) {
    for (std::uint32_t c = 0; c < chunks; ++c) {
      baked_.texels.push_back(so_far.output(job_name(RunStage::bake, c)).file);
    }
  });
}

Job BakeStage::finish_job(const ChosenRungs& chosen) const {
  ByteWriter joined;
  const auto put = [&](const std::vector<ChosenRung>& rungs) {
    joined.put(static_cast<std::uint32_t>(rungs.size()));
    for (const ChosenRung& each : rungs) {
      joined.put(each.file.hash);
      joined.put(each.rung);
    }
  };
  put(chosen.rungs);
  put(chosen.finer);
  Job job;
  job.kind = k_finish_kind;
  job.parameters =
      encode_parameters(FinishParameters{run_key(manifest_, options_), checksum(joined.bytes())});
  job.by_sink = true;
  return job;
}

/// Neighbouring pictures share a job if there are very many.
std::vector<Job> BakeStage::tile_jobs() const {
  std::vector<std::uint32_t> used;
  for (std::uint32_t i = 0; i < std::min(finish_.is_used.size(), manifest_.pictures.size()); ++i) {
    if (finish_.is_used[i] != 0) used.push_back(i);
  }
  const std::size_t count = std::min(k_most_tile_jobs, used.size());
  std::vector<Job> jobs;
  for (std::size_t j = 0; j < count; ++j) {
    TileParameters parameters;
    Job job;
    job.memory = k_bake_process_bytes + finish_.tile_memory;
    for (std::size_t i = j * used.size() / count; i < (j + 1) * used.size() / count; ++i) {
      const FileRef& file = manifest_.pictures[used[i]].file;
      parameters.pictures.push_back(used[i]);
      job.inputs.push_back(file);
      job.cost += 1 + file.size / k_bytes_of_cost;
      job.memory += file.size;  // all pictures may be read ahead
    }
    job.kind = k_tile_kind;
    job.parameters = encode_parameters(parameters);
    jobs.push_back(std::move(job));
  }
  return jobs;
}

Job BakeStage::bake_job(std::uint32_t chunk) const {
  Job job;
  job.kind = k_bake_kind;
  job.parameters = encode_parameters(BakeParameters{finished_, finish_.scene, chunk, pictures_});
  job.cost = 1 + k_cost_of_texel * finish_.chunk_texels[chunk];
  job.memory = memory_of_bake(manifest_);
  return job;
}

}  // namespace meshfarm
