// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The files of a texture that is baked anew; payloads of sealed files.
// Scene, kind "BAKE", version 1:
//   texture size u32 | margin u32 | spacing f64 | reach f64 |
//   parts u32 x (box 6 x f64 | file | boundary vertices u32) | seams u32 x (box | section) |
//   chunks u32 x section
//   file = name | size u64 | hash u64; section = offset u64 | size u64 | hash u64
// Surface, kind "BAKS", version 1:
//   vertices u64 | triangles u64 | positions 3 x f64 each | normals 3 x f64 each |
//   corners 3 x u32 each | texture coordinates 6 x f32 each | is own u8 each
// Texels, kind "TEXL", version 1:
//   runs u64 x (x u32 | y u32 | count u32) | their texels x 3 x u8
#include <algorithm>
#include <cmath>

#include <meshfarm/geometry/atlas.hpp>
#include <meshfarm/io/bake_file.hpp>
#include <meshfarm/staging/file_ref.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/byte_lists.hpp>
#include <meshfarm/util/bytes.hpp>

#include "io/staged_positions.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_scene = {'B', 'A', 'K', 'E'};
constexpr FileKind k_surface = {'B', 'A', 'K', 'S'};
constexpr FileKind k_texels = {'T', 'E', 'X', 'L'};
constexpr std::uint32_t k_bake_version = 1;

bool is_length(double x) {
  return std::isfinite(x) && x >= 0;
}

Box get_box(ByteReader& in) {
  Box box;
  box.lo = in.get<Vec3>();
  box.hi = in.get<Vec3>();
  for (int k = 0; k < 3; ++k) {
    if (std::isnan(box.lo[k]) || std::isnan(box.hi[k])) in.fail("a box that is not a number");
  }
  return box;
}

void put_box(ByteWriter& out, const Box& box) {
  out.put(box.lo);
  out.put(box.hi);
}

}  // namespace

std::string encode_bake_scene(const BakeScene& scene) {
  ByteWriter out;
  out.put(scene.texture_size);
  out.put(scene.margin_texels);
  out.put(scene.spacing);
  out.put(scene.reach);
  out.put(static_cast<std::uint32_t>(scene.parts.size()));
  for (const BakePart& part : scene.parts) {
    put_box(out, part.box);
    put_file(out, part.file);
    out.put(part.boundary_vertices);
  }
  out.put(static_cast<std::uint32_t>(scene.seams.size()));
  for (const BakeSeam& seam : scene.seams) {
    put_box(out, seam.box);
    out.put(seam.section);
  }
  put_list(out, scene.chunks);
  return seal(k_scene, k_bake_version, out.bytes());
}

BakeScene decode_bake_scene(std::string_view bytes, std::string_view what) {
  ByteReader in(unseal(bytes, k_scene, k_bake_version, what), what);
  BakeScene scene;
  scene.texture_size = in.get<std::uint32_t>();
  scene.margin_texels = in.get<std::uint32_t>();
  if (scene.texture_size > k_most_atlas_side || scene.margin_texels > scene.texture_size) {
    in.fail("a texture of an impossible size");
  }
  scene.spacing = in.get<double>();
  scene.reach = in.get<double>();
  if (!is_length(scene.spacing) || !is_length(scene.reach)) in.fail("impossible lengths");
  const auto parts = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < parts; ++i) {
    BakePart part;
    part.box = get_box(in);
    part.file = get_file(in);
    part.boundary_vertices = in.get<std::uint32_t>();
    scene.parts.push_back(std::move(part));
  }
  const auto seams = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < seams; ++i) {
    const Box box = get_box(in);
    scene.seams.push_back({box, in.get<FileSection>()});
  }
  scene.chunks = get_list<FileSection>(in);
  in.expect_end();
  return scene;
}

std::string encode_bake_surface(const BakeSurface& surface) {
  ByteWriter out;
  out.put(static_cast<std::uint64_t>(surface.positions.size()));
  out.put(static_cast<std::uint64_t>(surface.triangles.size()));
  put_positions(out, surface.positions, PositionType::float64);
  put_positions(out, surface.normals, PositionType::float64);
  out.put_array(std::span<const Triangle>(surface.triangles));
  out.put_array(std::span<const CornerUvs>(surface.uvs));
  out.put_array(std::span<const std::uint8_t>(surface.is_own));
  return seal(k_surface, k_bake_version, out.bytes());
}

BakeSurface decode_bake_surface(std::string_view bytes, std::string_view what) {
  ByteReader in(unseal(bytes, k_surface, k_bake_version, what), what);
  BakeSurface surface;
  const auto vertices = in.get<std::uint64_t>();
  const auto triangles = in.get<std::uint64_t>();
  surface.positions = get_positions(in, vertices, PositionType::float64);
  surface.normals = get_positions(in, vertices, PositionType::float64);
  surface.triangles = in.get_array<Triangle>(triangles);
  check_corners(in, surface.positions.size(), surface.triangles);
  surface.uvs = in.get_array<CornerUvs>(triangles);
  for (const CornerUvs& corners : surface.uvs) {
    for (const Uv& uv : corners) {
      // Painting something far outside the picture would take for ever.
      const auto fits = [](float x) { return x >= 0 && x <= 1; };
      if (!fits(uv[0]) || !fits(uv[1])) in.fail("texture coordinates beside the picture");
    }
  }
  surface.is_own = in.get_array<std::uint8_t>(triangles);
  in.expect_end();
  return surface;
}

std::string encode_baked_texels(const BakedTexels& texels) {
  ByteWriter out;
  out.put(static_cast<std::uint64_t>(texels.runs.size()));
  out.put_array(std::span<const TexelRun>(texels.runs));
  out.put_array(std::span<const TexelLevels>(texels.levels));
  return seal(k_texels, k_bake_version, out.bytes());
}

BakedTexels decode_baked_texels(std::string_view bytes, std::string_view what) {
  ByteReader in(unseal(bytes, k_texels, k_bake_version, what), what);
  BakedTexels texels;
  texels.runs = in.get_array<TexelRun>(in.get<std::uint64_t>());
  std::uint64_t count = 0;
  for (const TexelRun& run : texels.runs) count += run.count;
  texels.levels = in.get_array<TexelLevels>(count);
  in.expect_end();
  return texels;
}

}  // namespace meshfarm
