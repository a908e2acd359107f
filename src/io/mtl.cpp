// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The statements of a library that are read, one a line; names may contain blanks:
//   "newmtl" name
//   "Kd" r g b
//   "d" alpha, or "Tr" 1 - alpha if there is no "d"
//   map { option } file
//   map    = "map_Kd" | "norm" | "map_Bump" | "bump" | "map_Ke" | others, which are only named
//   option = "-o" u [v [w]] | "-s" u [v [w]] | "-clamp" on|off | others, which are passed over
#include "mtl.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "text_blocks.hpp"
#include "text_numbers.hpp"

namespace meshfarm {
namespace {

constexpr std::string_view k_blanks = " \t\r\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(k_blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(k_blanks) + 1 - first);
}

/// Removes and returns the text's first word.
std::string_view take_word(std::string_view& text) {
  text = trimmed(text);
  const std::string_view word = text.substr(0, text.find_first_of(k_blanks));
  text = trimmed(text.substr(word.size()));
  return word;
}

bool is_mtl_word(std::string_view text, std::string_view lower) {
  return std::equal(text.begin(), text.end(), lower.begin(), lower.end(), [](char a, char b) {
    return a == b || (a >= 'A' && a <= 'Z' && a + ('a' - 'A') == b);
  });
}

std::optional<double> number_of(std::string_view word) {
  double value = 0;
  if (word.empty()) return std::nullopt;
  const char* const end = word.data() + word.size();
  if (read_number(word.data(), end, value) != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// Reads up to three numbers, of which the first two are used. Missing ones stay unchanged.
void take_numbers(std::string_view& text, std::array<double, 2>& values) {
  for (std::size_t i = 0; i < 3; ++i) {
    std::string_view rest = text;
    const std::optional<double> value = number_of(take_word(rest));
    if (!value || rest.empty()) return;  // the last word is the file
    if (i < values.size()) values[i] = *value;
    text = rest;
  }
}

std::size_t arguments_of(std::string_view option) {
  return is_mtl_word(option, "-mm") ? 2 : 1;
}

void read_map(std::string_view text, MtlMap& map) {
  map = {};
  while (text.starts_with('-')) {
    std::string_view rest = text;
    const std::string_view option = take_word(rest);
    if (rest.empty()) break;  // a file whose name looks like an option
    text = rest;
    std::array<double, 2> ignored{};
    if (is_mtl_word(option, "-s")) {
      take_numbers(text, map.scale);
    } else if (is_mtl_word(option, "-o")) {
      take_numbers(text, map.offset);
    } else if (is_mtl_word(option, "-t")) {
      take_numbers(text, ignored);
    } else if (is_mtl_word(option, "-clamp")) {
      map.is_clamped = is_mtl_word(take_word(text), "on");
    } else {
      for (std::size_t i = 0; i < arguments_of(option); ++i) take_word(text);
    }
  }
  if (text.size() > 1 && text.front() == '"' && text.back() == '"') {
    text = text.substr(1, text.size() - 2);
  }
  map.file = text;
}

void read_colour(std::string_view text, MtlMaterial& material) {
  std::array<double, 3> colour{};
  for (std::size_t i = 0; i < colour.size(); ++i) {
    const std::optional<double> value = number_of(take_word(text));
    // "Kd 0.5" is grey; "Kd spectral FILE" is not read.
    if (!value && i == 0) return;
    colour[i] = value ? *value : colour[0];
  }
  material.colour = colour;
}

bool is_map(std::string_view word) {
  return (word.size() > 4 && is_mtl_word(word.substr(0, 4), "map_")) || is_mtl_word(word, "disp") ||
         is_mtl_word(word, "decal") || is_mtl_word(word, "refl");
}

/// Of the words for a normal map, "norm" is unambiguous; the others may also mean height maps.
void read_maps(std::string_view word, std::string_view line, MtlMaterial& material) {
  if (is_mtl_word(word, "map_kd")) {
    read_map(line, material.map);
  } else if (is_mtl_word(word, "map_ke")) {
    read_map(line, material.emission);
  } else if (is_mtl_word(word, "norm")) {
    read_map(line, material.normals);
  } else if (is_mtl_word(word, "map_bump") || is_mtl_word(word, "bump")) {
    if (material.normals.file.empty()) read_map(line, material.normals);
  } else if (is_map(word)) {
    material.other_maps.emplace_back(word);
  }
}

/// An alpha from 0 to 1.
std::optional<double> alpha_of(std::string_view text) {
  std::string_view word = take_word(text);
  if (is_mtl_word(word, "-halo")) word = take_word(text);
  const std::optional<double> value = number_of(word);
  return value ? std::optional(std::clamp(*value, 0.0, 1.0)) : std::nullopt;
}

}  // namespace

std::vector<MtlMaterial> parse_mtl(std::string_view text) {
  std::vector<MtlMaterial> made;
  bool has_alpha = false;  // whether the last material has one
  const char line_end = line_end_of(text);
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(line_end), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string_view word = take_word(line);
    if (is_mtl_word(word, "newmtl")) {
      made.push_back({.name = std::string(line)});
      has_alpha = false;
    } else if (made.empty()) {
      continue;
    } else if (is_mtl_word(word, "kd")) {
      read_colour(line, made.back());
    } else if (is_mtl_word(word, "d")) {
      if (const auto alpha = alpha_of(line)) made.back().alpha = *alpha;
      has_alpha = true;
    } else if (is_mtl_word(word, "tr") && !has_alpha) {
      if (const auto opposite = alpha_of(line)) made.back().alpha = 1 - *opposite;
    } else {
      read_maps(word, line, made.back());
    }
  }
  return made;
}

}  // namespace meshfarm
