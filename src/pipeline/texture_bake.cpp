// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/texture_bake.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <meshfarm/geometry/atlas.hpp>
#include <meshfarm/geometry/bake.hpp>
#include <meshfarm/geometry/bake_chunks.hpp>
#include <meshfarm/geometry/curve_order.hpp>
#include <meshfarm/io/bake_file.hpp>
#include <meshfarm/io/material_colours.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/io/tiled_picture.hpp>
#include <meshfarm/pipeline/bake_job.hpp>
#include <meshfarm/pipeline/input_surface.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>
#include <meshfarm/util/parallel.hpp>

namespace meshfarm {
namespace {

constexpr std::uint32_t k_margin_texels = 4;
constexpr std::size_t k_triangles_of_seam = 16'384;

/// The power of two with about this many texels.
std::uint32_t side_for(std::uint64_t texels) {
  constexpr std::uint32_t k_least = 256;
  const double side = std::sqrt(static_cast<double>(texels));
  std::uint32_t power = k_least;
  while (power < k_most_chosen_side && power < side) power *= 2;
  return power;
}

/// From the first bytes of the file, if they suffice.
PictureFacts facts_of(const Stage& stage, const FileRef& file) {
  constexpr std::uint64_t k_first = std::uint64_t{256} << 10;
  if (file.size > k_first) {
    std::string first(k_first, '\0');
    const Fd fd = stage.open_told(file);
    first.resize(read_at(fd.get(), 0, first, stage.root() / file.name));
    try {
      return picture_facts(first);
    } catch (const DataError&) {  // the facts come later in the file, or not at all
    }
  }
  return picture_facts(stage.read(file));
}

/// Facts about the input's pictures that have colours; nothing for damaged ones.
std::vector<std::optional<PictureFacts>> facts_of_pictures(const Stage& stage,
                                                           const Manifest& manifest) {
  std::vector<std::optional<PictureFacts>> facts(manifest.pictures.size());
  const std::vector<bool> is_used = colour_pictures(*manifest.labels, facts.size());
  for (std::size_t i = 0; i < facts.size(); ++i) {
    if (!is_used[i]) continue;
    try {
      facts[i] = facts_of(stage, manifest.pictures[i].file);
    } catch (const DataError&) {  // reported when the picture is made
    }
  }
  return facts;
}

void tell_of_damaged(const Manifest& manifest,
                     const std::vector<std::optional<PictureFacts>>& facts,
                     std::span<const std::uint32_t> damaged) {
  const std::vector<bool> is_used = colour_pictures(*manifest.labels, facts.size());
  for (std::uint32_t i = 0; i < facts.size(); ++i) {
    const bool is_damaged =
        !facts[i] || std::find(damaged.begin(), damaged.end(), i) != damaged.end();
    if (!is_used[i] || !is_damaged) continue;
    log_warning(manifest.input + ": the texture " + manifest.pictures[i].name +
                " is damaged; what it covers has no colour of it");
  }
}

/// Facts about the input's surface after reading it once.
struct InputSeen {
  std::vector<Box> boxes;  // of the parts
  Mesh between;            // the triangles between them
};

InputSeen see_input(const Stage& stage, const Manifest& manifest, unsigned threads) {
  InputSeen seen;
  seen.boxes.resize(manifest.parts.size());
  InputSurface(stage, manifest, threads)
      .show([](const Box&) { return true; },
            [&](const SurfacePiece& piece) {
              if (piece.part < seen.boxes.size()) {
                for (const Vec3& p : piece.fresh) seen.boxes[piece.part].add(p);
                return;
              }
              Mesh& between = seen.between;
              const auto first = static_cast<std::uint32_t>(between.positions.size());
              between.positions.insert(between.positions.end(), piece.positions.begin(),
                                       piece.positions.end());
              for (const auto& [a, b, c] : piece.triangles) {
                between.triangles.push_back({first + a, first + b, first + c});
              }
              between.columns.append(piece.columns);
            });
  return seen;
}

/// Each triangle has vertices of its own.
BakeSeam write_seam(const Mesh& between, std::span<const std::uint32_t> triangles,
                    SectionWriter& sections) {
  Part part;
  part.positions = PositionType::float64;
  BakeSeam seam;
  for (const std::uint32_t t : triangles) {
    const auto first = static_cast<std::uint32_t>(part.mesh.positions.size());
    for (const std::uint32_t v : between.triangles[t]) {
      part.mesh.positions.push_back(between.positions[v]);
      seam.box.add(between.positions[v]);
    }
    part.mesh.triangles.push_back({first, first + 1, first + 2});
    part.mesh.columns.append(between.columns, t);
  }
  seam.section = sections.add(encode_part(part));
  return seam;
}

std::vector<BakeSeam> write_seams(const Mesh& between, SectionWriter& sections) {
  const std::vector<std::uint32_t> order = along_a_curve(between);
  std::vector<BakeSeam> seams;
  for (std::size_t first = 0; first < order.size(); first += k_triangles_of_seam) {
    const std::size_t count = std::min(k_triangles_of_seam, order.size() - first);
    seams.push_back(write_seam(between, std::span(order).subspan(first, count), sections));
  }
  return seams;
}

}  // namespace

TextureLayout lay_out_texture(const Stage& stage, const Manifest& manifest,
                              std::uint32_t texture_size, unsigned threads, Mesh& result) {
  TextureLayout layout;
  layout.pictures = facts_of_pictures(stage, manifest);
  std::uint64_t texels = 0;
  for (const auto& facts : layout.pictures) {
    if (facts) texels += std::uint64_t{facts->width} * facts->height;
  }
  layout.size = texture_size != 0 ? texture_size : side_for(texels);
  Atlas atlas = make_atlas(
      result, {.texture_size = layout.size, .margin_texels = k_margin_texels, .threads = threads});
  layout.charts = atlas.charts;
  layout.coverage = atlas.coverage;
  if (atlas.texels_per_unit > 0) layout.spacing = 1 / atlas.texels_per_unit;
  result.columns.uvs = std::move(atlas.uvs);
  result.columns.labels.assign(result.triangles.size(), 0);
  return layout;
}

JobOutput publish_bake_scene(const Stage& stage, const Manifest& manifest, const Mesh& result,
                             const TextureLayout& layout, const BakeInput& input, const Job& job,
                             const JobContext& context) {
  FinishSummary summary;
  for (const auto& facts : layout.pictures) {
    summary.is_used.push_back(facts ? 1 : 0);
    if (facts) summary.tile_memory = std::max(summary.tile_memory, facts->decoding_bytes);
  }
  const ResultName name{key_of(job).value, context.attempt, context.incarnation};
  const auto file = context.create(name);
  SectionWriter sections([&](std::string_view bytes) { file->write(bytes); });
  BakeScene scene{layout.size, k_margin_texels, layout.spacing, input.reach, {}, {}, {}};
  InputSeen seen = see_input(stage, manifest, input.threads);
  for (std::size_t i = 0; i < seen.boxes.size(); ++i) {
    const PartEntry& part = manifest.parts[i];
    const Box box = part.triangles == 0 ? Box{} : seen.boxes[i];
    scene.parts.push_back({box, part.file, part.boundary_vertices});
  }
  scene.seams = write_seams(seen.between, sections);
  seen = {};
  const BakeChunks chunks(result, result.columns.uvs,
                          {.texture_size = layout.size, .margin_texels = k_margin_texels});
  for (std::size_t i = 0; i < chunks.size(); ++i) {
    if (!context.progress(0)) throw IncompleteError("stopped");
    scene.chunks.push_back(sections.add(encode_bake_surface(chunks.surface(i))));
    summary.chunk_texels.push_back(static_cast<std::uint32_t>(chunks.texels(i)));
  }
  summary.scene = sections.add(encode_bake_scene(scene));
  return {file->commit(), encode_summary(summary)};
}

PictureFiles baked_picture(const Stage& stage, const Manifest& manifest,
                           const TextureLayout& layout, const BakedTexture& baked,
                           unsigned threads) {
  BakedCanvas canvas(layout.size);
  for (const FileRef& file : baked.texels) {
    canvas.add(decode_baked_texels(stage.read(file), file.name));
  }
  BakedPicture picture = canvas.finish(threads);
  tell_of_damaged(manifest, layout.pictures, baked.damaged);
  const bool lossy = std::all_of(layout.pictures.begin(), layout.pictures.end(),
                                 [](const auto& each) { return !each || each->is_lossy; });
  const auto file = std::make_shared<const std::string>(encoded_picture(
      picture.side, std::move(picture.texels), lossy ? PictureCoding::jpeg : PictureCoding::png));
  PictureFiles made;
  made.names = {lossy ? "texture.jpg" : "texture.png"};
  made.load = [file](std::size_t) { return *file; };
  return made;
}

LabelMeaning baked_labels() {
  Material material{.name = "texture"};
  material.maps = {{MapUse::colour, 0}};
  material.wrap_u = material.wrap_v = TextureWrap::clamp;
  return {"material", {material}};
}

}  // namespace meshfarm
