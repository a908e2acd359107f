// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/io/labels.hpp>

#include "mtl.hpp"
#include "obj_libraries.hpp"
#include "obj_names.hpp"

namespace meshfarm {

/// What is kept of the textures of an OBJ's materials.
struct ObjMaps {
  PictureFiles pictures;
  std::vector<std::string> skipped;  // "map_Ks (3)"
  std::vector<MtlMap> moves;         // of each label's texture coordinates; empty if none moves
};

/// Gives the materials the pictures that their libraries name. `meaning` is that of the names.
/// Pictures that are missing or invalid are reported to `warn` and left out.
ObjMaps keep_obj_maps(const std::filesystem::path& path, const ObjNames& names,
                      std::span<const ObjLibraryMaterial> libraries, LabelMeaning& meaning,
                      const std::function<void(const std::string& line)>& warn);

/// Applies the placement of their materials to the texture coordinates of labelled triangles.
class MovedUvs {
 public:
  using Take = std::function<void(const TriangleView&)>;
  explicit MovedUvs(std::span<const MtlMap> moves) : moves_(moves) {}
  /// Valid until the next call.
  TriangleView of(const TriangleView& batch);

 private:
  std::span<const MtlMap> moves_;
  std::vector<CornerUvs> moved_;
};

}  // namespace meshfarm
