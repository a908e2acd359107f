// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The output; names have no blanks:
//   in the OBJ:     "mtllib" NAME.mtl, and "usemtl" name before the triangles that have it;
//                   of groups "g" name alone
//   in the library: { "newmtl" name, "Kd" r g b as sRGB, "d" alpha, { map } }
//   map = "map_Kd" of, "map_Bump" of, or "Ke 1 1 1" "map_Ke" of;  of = ["-clamp on"] picture
#include "obj_labels.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include <meshfarm/util/errors.hpp>

#include "file_sink.hpp"
#include "srgb.hpp"

namespace meshfarm {
namespace {

constexpr std::string_view k_line_breaks = "\r\n";

std::filesystem::path library_path(const std::filesystem::path& obj) {
  return std::filesystem::path(obj).replace_extension(".mtl");
}

/// One word that no reader misinterprets.
std::string word_of(const std::string& name) {
  std::string word = name.empty() ? "material" : name;
  for (char& c : word) {
    if (static_cast<unsigned char>(c) <= ' ' || c == '#' || c == '\\' || c == '\x7f') c = '_';
  }
  return word;
}

/// The word before a picture's name; empty if there is none.
std::string_view map_word(MapUse use) {
  switch (use) {
    case MapUse::colour:
      return "map_Kd";
    case MapUse::normal:
      return "map_Bump";
    case MapUse::emission:
      return "Ke 1 1 1\nmap_Ke";
    default:
      return {};
  }
}

std::string number_text(double number) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), static_cast<float>(number)).ptr;
  return {text.data(), end};
}

}  // namespace

ObjLabels::ObjLabels(const std::filesystem::path& obj, const LabelMeaning& meaning,
                     const PictureFiles& pictures)
    : obj_(obj),
      are_groups_(meaning.name == "group"),
      materials_(meaning),
      pictures_(obj, pictures) {
  if (are_groups_) return;
  if (obj.filename().native().find_first_of(k_line_breaks) != std::string::npos) {
    throw UsageError("an OBJ cannot name a library with a line break in its name");
  }
  library_.emplace(checked_output(library_path(obj)));
}

std::string ObjLabels::header() const {
  return library_ ? "mtllib " + library_path(obj_).filename().string() + "\n" : "";
}

std::string_view ObjLabels::statement(Label label) {
  const std::size_t place = materials_.place_of(label);
  if (last_ == place) return {};
  last_ = place;
  return line_of(place);
}

const std::string& ObjLabels::line_of(std::size_t place) {
  if (lines_.size() <= place) lines_.resize(materials_.all().size());
  std::string& line = lines_[place];
  if (line.empty()) {
    line = (are_groups_ ? "g " : "usemtl ") +
           free_names_.next(word_of(materials_.all()[place].name)) + "\n";
  }
  return line;
}

void ObjLabels::finish() {
  materials_.warn_of_shared(obj_);
  if (!library_) return;
  library_->write(library_text());
  library_->sync();
  pictures_.finish();
}

void ObjLabels::commit() {
  if (!library_) return;
  pictures_.commit();
  library_->commit();
}

std::string ObjLabels::library_text() {
  std::string text;
  for (std::size_t place = 0; place < materials_.all().size(); ++place) {
    if (!materials_.is_used(place)) continue;
    const Material& material = materials_.all()[place];
    const auto& [red, green, blue, alpha] = material.colour;
    text += "newmtl " + line_of(place).substr(std::string_view("usemtl ").size()) + "Kd";
    for (const float level : {red, green, blue}) {
      text += " " + number_text(srgb_of_linear(static_cast<double>(level)));
    }
    text += "\nd " + number_text(static_cast<double>(alpha)) + "\n" + maps_text(material);
  }
  return text;
}

/// Nothing for maps that a library has no word for: roughness, occlusion, mirrored textures.
std::string ObjLabels::maps_text(const Material& material) {
  const bool is_clamped =
      material.wrap_u == TextureWrap::clamp && material.wrap_v == TextureWrap::clamp;
  std::string text;
  for (const MaterialMap& map : material.maps) {
    const std::string_view word = map_word(map.use);
    if (word.empty()) continue;
    text.append(word) += is_clamped ? " -clamp on " : " ";
    text += pictures_.name_of(map.picture) + "\n";
  }
  return text;
}

}  // namespace meshfarm
