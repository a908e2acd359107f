// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/texture_bake.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <meshfarm/geometry/atlas.hpp>
#include <meshfarm/geometry/bake.hpp>
#include <meshfarm/io/material_colours.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/memory.hpp>

#include "pipeline/input_colours.hpp"

namespace meshfarm {
namespace {

constexpr std::uint32_t k_margin_texels = 4;

/// The power of two that has about as many texels.
std::uint32_t side_for(std::uint64_t texels) {
  constexpr std::uint32_t k_least = 256;
  constexpr std::uint32_t k_most = 4096;
  const double side = std::sqrt(static_cast<double>(texels));
  std::uint32_t power = k_least;
  while (power < k_most && power < side) power *= 2;
  return power;
}

}  // namespace

BakedTexture bake_texture(const Stage& stage, const Manifest& manifest, Mesh& result,
                          const TextureBakeOptions& options) {
  const MaterialColours materials(*manifest.labels, pictures_of(stage, manifest.pictures),
                                  {.name = manifest.input});
  BakedTexture made;
  made.size = options.texture_size != 0 ? options.texture_size : side_for(materials.texels());
  options.progress("charts");
  Atlas atlas = make_atlas(
      result,
      {.texture_size = made.size, .margin_texels = k_margin_texels, .threads = options.threads});
  made.charts = atlas.charts;
  made.coverage = atlas.coverage;
  options.progress("texture");
  const std::optional<MemoryRoom> room = available_memory();
  InputColours::Options of_input;
  of_input.threads = options.threads;
  if (atlas.texels_per_unit > 0) of_input.spacing = 1 / atlas.texels_per_unit;
  of_input.reach = options.reach;
  of_input.memory_bytes = room ? room->bytes / 2 : UINT64_MAX;
  InputColours input(stage, manifest, materials, of_input);
  BakeOptions bake_options;
  bake_options.texture_size = made.size;
  bake_options.margin_texels = k_margin_texels;
  bake_options.level_of = srgb_level;
  bake_options.threads = options.threads;
  BakedPicture picture =
      bake(result, atlas.uvs, bake_options,
           [&](std::span<const Vec3> points, std::span<const Vec3> normals,
               std::span<BakedColour> colours) { input.find(points, normals, colours); });
  const bool lossy = materials.are_lossy();
  const auto file = std::make_shared<const std::string>(encoded_picture(
      picture.side, std::move(picture.texels), lossy ? PictureCoding::jpeg : PictureCoding::png));
  made.pictures.names = {lossy ? "texture.jpg" : "texture.png"};
  made.pictures.load = [file](std::size_t) { return *file; };
  Material material{.name = "texture"};
  material.maps = {{MapUse::colour, 0}};
  material.wrap_u = material.wrap_v = TextureWrap::clamp;
  made.labels = {"material", {material}};
  result.columns.uvs = std::move(atlas.uvs);
  result.columns.labels.assign(result.triangles.size(), 0);
  return made;
}

}  // namespace meshfarm
