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

// The jobs of a run that makes a new texture, after those of any run. The sink finishes the mesh,
// lays it out on a picture and publishes it in chunks ("finish"); workers cut the input's pictures
// into tiles that can be read one by one ("tile"), and find the colours of the chunks ("bake").

inline constexpr std::string_view k_finish_kind = "finish";
inline constexpr std::string_view k_tile_kind = "tile";
inline constexpr std::string_view k_bake_kind = "bake";

/// Parameters of a finish job: what it depends on.
struct FinishParameters {
  std::uint64_t run = 0;     // run_key()
  std::uint64_t chosen = 0;  // checksum of the results that it joins
};
std::string encode_parameters(const FinishParameters& parameters);

/// What a finish job's file is: a BakeScene and its sections.
struct FinishSummary {
  FileSection scene;
  std::vector<std::uint32_t> chunk_texels;
  std::vector<std::uint8_t> is_used;  // of the stage's pictures: whether it is to be tiled
  std::uint64_t tile_memory = 0;      // most that a picture takes to be tiled beside its file
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

/// Decodes pictures of the stage (the job's inputs) and publishes them as tiles. One that is
/// damaged is left out.
JobOutput tile_pictures(const Job& job, const JobContext& context);

/// Publishes the texels of a chunk: what the input's textures show at the places of its surface
/// that are nearest. Reads of the stage what is near the chunk.
JobOutput bake_chunk(const Job& job, const JobContext& context);

}  // namespace meshfarm
