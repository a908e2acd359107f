// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include <meshfarm/geometry/bake.hpp>
#include <meshfarm/io/bake_file.hpp>
#include <meshfarm/io/material_colours.hpp>
#include <meshfarm/pipeline/bake_job.hpp>
#include <meshfarm/staging/file_ref.hpp>
#include <meshfarm/util/byte_lists.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/bake_stage.hpp"
#include "pipeline/input_colours.hpp"

namespace meshfarm {
namespace {

// Parameters and summaries, version 1:
// finish parameters: version u8 | run u64 | chosen u64
// finish summary: scene section | chunks u32 x texels u32 | pictures u32 x is used u8 | memory u64
// tile parameters: version u8 | pictures u32 x number u32
// tile summary: directory section | damaged u32 x number u32
// bake parameters: version u8 | file | scene section | chunk u32 | pictures u32 x (file | section)
constexpr std::uint8_t k_bake_job_version = 1;

void expect_version(ByteReader& in) {
  if (in.get<std::uint8_t>() != k_bake_job_version) in.fail("made by another version of meshfarm");
}

ResultName name_of(const Job& job, const JobContext& context) {
  return {key_of(job).value, context.attempt, context.incarnation};
}

void expect_to_go_on(const JobContext& context, std::uint64_t done) {
  if (!context.progress(done)) throw IncompleteError("the job was given up");
}

}  // namespace

std::string encode_parameters(const FinishParameters& parameters) {
  ByteWriter out;
  out.put(k_bake_job_version);
  out.put(parameters.run);
  out.put(parameters.chosen);
  return out.take();
}

std::string encode_summary(const FinishSummary& summary) {
  ByteWriter out;
  out.put(summary.scene);
  put_list(out, summary.chunk_texels);
  put_list(out, summary.is_used);
  out.put(summary.tile_memory);
  return out.take();
}

FinishSummary decode_finish_summary(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  FinishSummary summary;
  summary.scene = in.get<FileSection>();
  summary.chunk_texels = get_list<std::uint32_t>(in);
  summary.is_used = get_list<std::uint8_t>(in);
  summary.tile_memory = in.get<std::uint64_t>();
  in.expect_end();
  return summary;
}

std::string encode_parameters(const TileParameters& parameters) {
  ByteWriter out;
  out.put(k_bake_job_version);
  put_list(out, parameters.pictures);
  return out.take();
}

TileParameters decode_tile_parameters(std::string_view bytes) {
  ByteReader in(bytes, "parameters of a tile job");
  expect_version(in);
  TileParameters parameters{get_list<std::uint32_t>(in)};
  in.expect_end();
  return parameters;
}

std::string encode_summary(const TileSummary& summary) {
  ByteWriter out;
  out.put(summary.directory);
  put_list(out, summary.damaged);
  return out.take();
}

TileSummary decode_tile_summary(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  TileSummary summary;
  summary.directory = in.get<FileSection>();
  summary.damaged = get_list<std::uint32_t>(in);
  in.expect_end();
  return summary;
}

std::string encode_parameters(const BakeParameters& parameters) {
  ByteWriter out;
  out.put(k_bake_job_version);
  put_file(out, parameters.file);
  out.put(parameters.scene);
  out.put(parameters.chunk);
  out.put(static_cast<std::uint32_t>(parameters.pictures.size()));
  for (const TiledPicturesRef& pictures : parameters.pictures) {
    put_file(out, pictures.file);
    out.put(pictures.directory);
  }
  return out.take();
}

BakeParameters decode_bake_parameters(std::string_view bytes) {
  ByteReader in(bytes, "parameters of a bake job");
  expect_version(in);
  BakeParameters parameters;
  parameters.file = get_file(in);
  parameters.scene = in.get<FileSection>();
  parameters.chunk = in.get<std::uint32_t>();
  const auto files = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < files; ++i) {
    FileRef file = get_file(in);
    parameters.pictures.push_back({std::move(file), in.get<FileSection>()});
  }
  in.expect_end();
  return parameters;
}

JobOutput tile_pictures(const Job& job, const JobContext& context) {
  const TileParameters parameters = decode_tile_parameters(job.parameters);
  if (parameters.pictures.size() != job.inputs.size()) {
    throw DataError("a tile job has other inputs than its parameters name");
  }
  const auto file = context.create(name_of(job, context));
  TiledPicturesWriter tiles([&](std::string_view bytes) { file->write(bytes); });
  TileSummary summary;
  for (std::size_t i = 0; i < job.inputs.size(); ++i) {
    std::string picture = context.read(job.inputs[i]);
    try {
      tiles.add(parameters.pictures[i], std::move(picture));
    } catch (const DataError&) {
      summary.damaged.push_back(parameters.pictures[i]);
    }
    expect_to_go_on(context, job.cost / job.inputs.size());
  }
  summary.directory = tiles.finish();
  return {file->commit(), encode_summary(summary)};
}

JobOutput bake_chunk(const Job& job, const JobContext& context) {
  const BakeParameters parameters = decode_bake_parameters(job.parameters);
  const std::string& name = parameters.file.name;
  const SectionedFile file(context.stage, parameters.file);
  const BakeScene scene = decode_bake_scene(file.read(parameters.scene), name);
  if (parameters.chunk >= scene.chunks.size()) throw DataError(name + ": has no such chunk");
  const Manifest manifest = decode_manifest(context.stage.read(ManifestName{}), "the manifest");
  if (!manifest.labels || !manifest.uvs) throw DataError("this stage has no textures");
  const MaterialColours materials(*manifest.labels, context.stage, parameters.pictures,
                                  k_tile_cache_bytes);
  const std::uint64_t piece_room = bake_piece_bytes(manifest);
  InputColours input({context.stage, file, scene, materials}, manifest.columns(), piece_room);
  const BakeSurface surface = decode_bake_surface(file.read(scene.chunks[parameters.chunk]), name);
  BakeOptions options;
  options.texture_size = scene.texture_size;
  options.margin_texels = scene.margin_texels;
  options.level_of = srgb_level;
  options.threads = 1;
  const BakedTexels texels =
      bake_texels(surface, options,
                  [&](std::span<const Vec3> points, std::span<const Vec3> normals,
                      std::span<BakedColour> colours) {
                    expect_to_go_on(context, k_cost_of_texel * points.size());
                    input.find(points, normals, colours);
                  });
  return {context.publish(name_of(job, context), encode_baked_texels(texels)), {}};
}

}  // namespace meshfarm
