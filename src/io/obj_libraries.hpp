// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mtl.hpp"
#include "obj_statements.hpp"

namespace meshfarm {

/// A material that faces use, and the folder of its library.
struct ObjLibraryMaterial {
  MtlMaterial material;
  std::filesystem::path folder;
};

/// The materials of an OBJ's libraries; for each name, the first. Libraries that are missing or
/// cannot be read are reported to `warn` and skipped.
std::vector<ObjLibraryMaterial> read_obj_libraries(
    const std::filesystem::path& path, const ObjStatements& statements,
    const std::function<void(const std::string& line)>& warn);

/// The meaning of labels for faces with these materials; those that no library has are white.
LabelMeaning meaning_of_materials(const ObjNames& names,
                                  const std::vector<ObjLibraryMaterial>& materials);
/// The same for groups.
LabelMeaning meaning_of_groups(const ObjNames& names);

}  // namespace meshfarm
