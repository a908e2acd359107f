// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "obj_libraries.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>

#include <meshfarm/util/errors.hpp>

#include "files_beside.hpp"
#include "label_names.hpp"
#include "ply_types.hpp"
#include "srgb.hpp"

namespace meshfarm {
namespace {

class Libraries {
 public:
  Libraries(const std::filesystem::path& path, const ObjStatements& statements,
            const std::function<void(const std::string& line)>& warn)
      : path_(path), statements_(statements), warn_(warn) {}

  std::vector<ObjLibraryMaterial> read() {
    for (const std::string& names : statements_.libraries) add_named(names);
    return std::move(made_);
  }

 private:
  /// One file with blanks in its name, or several files.
  void add_named(const std::string& names) {
    const std::filesystem::path folder = path_.parent_path();
    if (const auto whole = find_beside(folder, names)) return add(*whole);
    constexpr std::string_view k_between = " \t";
    std::string_view rest = names;
    while (!rest.empty()) {
      const std::string_view name = rest.substr(0, rest.find_first_of(k_between));
      rest.remove_prefix(name.size());
      rest.remove_prefix(std::min(rest.find_first_not_of(k_between), rest.size()));
      if (const auto found = find_beside(folder, name)) {
        add(*found);
      } else {
        warn_(path_.string() + ": the material library " + shown(names) +
              " is not beside it: its materials have no colour");
        return;
      }
    }
  }

  void add(const std::filesystem::path& library) {
    constexpr std::uint64_t k_most_bytes = std::uint64_t{64} << 20;  // 100,000 names of 600 bytes
    // The mesh is useful without it.
    try {
      for (const MtlMaterial& material : parse_mtl(read_beside(library, k_most_bytes))) {
        const bool is_used = statements_.materials.label_of(material.name).has_value();
        if (!is_used || !known_.insert(material.name).second) continue;
        made_.push_back({material, library.parent_path()});
      }
    } catch (const Error& error) {
      warn_(error.what());
    }
  }

  const std::filesystem::path& path_;
  const ObjStatements& statements_;
  const std::function<void(const std::string& line)>& warn_;
  std::set<std::string> known_;
  std::vector<ObjLibraryMaterial> made_;
};

/// White materials, named as the labels are; an empty name is replaced by a free one.
LabelMeaning named_meaning(std::string name, const ObjNames& names) {
  LabelMeaning made{std::move(name), {}};
  FreeNames free;
  for (const std::string& each : names.names()) free.take(each);
  for (const std::string& each : names.names()) {
    made.materials.push_back({.name = each.empty() ? free.next("default") : each});
  }
  return made;
}

}  // namespace

std::vector<ObjLibraryMaterial> read_obj_libraries(
    const std::filesystem::path& path, const ObjStatements& statements,
    const std::function<void(const std::string& line)>& warn) {
  return Libraries(path, statements, warn).read();
}

/// With a picture, the colour is ignored: many writers then give an arbitrary one, or black.
LabelMeaning meaning_of_materials(const ObjNames& names,
                                  const std::vector<ObjLibraryMaterial>& materials) {
  LabelMeaning made = named_meaning("material", names);
  for (const auto& [material, folder] : materials) {
    const std::optional<Label> label = names.label_of(material.name);
    if (!label) continue;
    std::array<float, 4>& colour = made.materials[*label].colour;
    for (std::size_t i = 0; i < 3 && material.map.file.empty(); ++i) {
      colour[i] = static_cast<float>(linear_of_srgb(material.colour[i]));
    }
    colour[3] = static_cast<float>(material.alpha);
  }
  return made;
}

LabelMeaning meaning_of_groups(const ObjNames& names) {
  return named_meaning("group", names);
}

}  // namespace meshfarm
