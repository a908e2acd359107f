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

/// A material that faces use, and where the library is that has it.
struct ObjLibraryMaterial {
  MtlMaterial material;
  std::filesystem::path folder;
};

/// Those of an OBJ's libraries; of a name the first. Libraries that are not there, or cannot be
/// read, are named by `warn` and passed over.
std::vector<ObjLibraryMaterial> read_obj_libraries(
    const std::filesystem::path& path, const ObjStatements& statements,
    const std::function<void(const std::string& line)>& warn);

/// What the labels of faces with these materials say; those that no library has are white.
LabelMeaning meaning_of_materials(const ObjNames& names,
                                  const std::vector<ObjLibraryMaterial>& materials);
/// The same of groups.
LabelMeaning meaning_of_groups(const ObjNames& names);

}  // namespace meshfarm
