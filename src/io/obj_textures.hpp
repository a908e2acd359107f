// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "obj_libraries.hpp"
#include "obj_places.hpp"
#include "obj_statements.hpp"
#include "texture_colours.hpp"

namespace meshfarm {

/// The materials of an OBJ's libraries that its faces use.
struct ObjMaterials {
  static constexpr std::size_t k_none = 0;  // the material of faces that have none

  std::vector<TextureImage> images;
  std::vector<TextureMaterial> materials{TextureMaterial{}};
  std::map<std::string, std::size_t, std::less<>> numbers;  // by name
};

ObjMaterials texture_materials(std::span<const ObjLibraryMaterial> materials);

/// Samples the textures of an OBJ that has some. Null if none can be read. A malformed face gives
/// no colour: it is reported when the faces are read.
std::unique_ptr<TextureColours> sample_obj_textures(const ObjText& text,
                                                    const ObjStatements& statements,
                                                    const ObjMaterials& materials,
                                                    std::uint64_t picture_bytes);

}  // namespace meshfarm
