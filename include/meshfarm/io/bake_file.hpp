// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/bake.hpp>
#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// A part of the input that colours are looked up in.
struct BakePart {
  Box box;
  FileRef file;  // a part or a sorted stream
  std::uint32_t boundary_vertices = 0;
};
/// Some of the triangles between parts: a section that is encoded as a part.
struct BakeSeam {
  Box box;
  FileSection section;
};

/// What the jobs that paint a new texture know beside the stage. The file holds the chunks and
/// seams as sections; this directory of them is its last section.
struct BakeScene {
  std::uint32_t texture_size = 0;
  std::uint32_t margin_texels = 0;
  double spacing = 0;  // texel size on the surface, a length
  double reach = 0;    // distance of the result from the input
  std::vector<BakePart> parts;
  std::vector<BakeSeam> seams;
  std::vector<FileSection> chunks;
};

std::string encode_bake_scene(const BakeScene& scene);
/// Throws DataError naming `what` for anything that encode_bake_scene did not make.
BakeScene decode_bake_scene(std::string_view bytes, std::string_view what);

/// A chunk of the result, as bake_texels takes it.
std::string encode_bake_surface(const BakeSurface& surface);
/// Throws as above.
BakeSurface decode_bake_surface(std::string_view bytes, std::string_view what);

/// The texels that a job made of a chunk.
std::string encode_baked_texels(const BakedTexels& texels);
/// Throws as above.
BakedTexels decode_baked_texels(std::string_view bytes, std::string_view what);

}  // namespace meshfarm
