// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/io/tiled_picture.hpp>
#include <meshfarm/staging/sections.hpp>

namespace meshfarm {

// The jobs of a run that makes a new texture; they come after the usual jobs. The sink finishes the
// mesh, lays it out on a picture and publishes it in chunks ("finish"); workers cut the input's
// pictures into tiles that can be read one by one ("tile"), and find the colours of the chunks
// ("bake").

inline constexpr std::string_view k_finish_kind = "finish";
inline constexpr std::string_view k_tile_kind = "tile";
inline constexpr std::string_view k_bake_kind = "bake";

/// Parameters of a finish job: all that it depends on.
struct FinishParameters {
  std::uint64_t run = 0;     // run_key()
  std::uint64_t chosen = 0;  // checksum of the results that it joins
};
std::string encode_parameters(const FinishParameters& parameters);

/// The contents of a finish job's file: a BakeScene and its sections.
struct FinishSummary {
  FileSection scene;
  std::vector<std::uint32_t> chunk_texels;
  std::vector<std::uint8_t> is_used;  // per picture of the stage: whether it is to be tiled
  std::uint64_t tile_memory = 0;      // the most that tiling a picture takes, besides its file
};
std::string encode_summary(const FinishSummary& summary);
FinishSummary decode_finish_summary(std::string_view bytes, std::string_view what);

/// Parameters of a tile job: the numbers of its inputs among the stage's pictures.
struct TileParameters {
  std::vector<std::uint32_t> pictures;
};
std::string encode_parameters(const TileParameters& parameters);
TileParameters decode_tile_parameters(std::string_view bytes);

struct TileSummary {
  FileSection directory;
  std::vector<std::uint32_t> damaged;  // pictures that could not be decoded
};
std::string encode_summary(const TileSummary& summary);
TileSummary decode_tile_summary(std::string_view bytes, std::string_view what);

/// Parameters of a bake job.
struct BakeParameters {
  FileRef file;  // of the finish job
  FileSection scene;
  std::uint32_t chunk = 0;
  std::vector<TiledPicturesRef> pictures;
};
std::string encode_parameters(const BakeParameters& parameters);
BakeParameters decode_bake_parameters(std::string_view bytes);

/// Decodes pictures of the stage (the job's inputs) and publishes them as tiles. Damaged pictures
/// are left out.
JobOutput tile_pictures(const Job& job, const JobContext& context);

/// Publishes the texels of a chunk: the colours of the input's textures at the nearest places of
/// its surface. Reads only what is near the chunk from the stage.
JobOutput bake_chunk(const Job& job, const JobContext& context);

}  // namespace meshfarm
