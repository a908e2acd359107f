// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/io/labels.hpp>
#include <meshfarm/staging/atomic_file.hpp>

#include "label_materials.hpp"
#include "label_names.hpp"
#include "pictures_beside.hpp"

namespace meshfarm {

/// The labels of an OBJ that is written: "usemtl" statements and, beside it, a library of the same
/// name, "mesh.mtl", with its pictures; or "g" statements if they are groups.
class ObjLabels {
 public:
  /// Begins the library. Throws IoError.
  ObjLabels(const std::filesystem::path& obj, const LabelMeaning& meaning,
            const PictureFiles& pictures = {});

  /// The text for the start of the OBJ.
  std::string header() const;
  /// The text before a triangle of this label: a line, or nothing if the previous triangle has the
  /// same label.
  std::string_view statement(Label label);
  /// Writes the library and the pictures that it names, still under temporary names.
  void finish();
  void commit();

 private:
  const std::string& line_of(std::size_t place);
  std::string library_text();
  std::string maps_text(const Material& material);

  std::filesystem::path obj_;
  bool are_groups_;
  LabelMaterials materials_;
  FreeNames free_names_;
  std::vector<std::string> lines_;  // of each material; empty until used
  std::optional<std::size_t> last_;
  std::optional<AtomicFile> library_;
  PicturesBeside pictures_;
};

}  // namespace meshfarm
