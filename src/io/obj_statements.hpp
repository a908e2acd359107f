// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "obj_names.hpp"

namespace meshfarm {

/// Whether to look for corners of faces that have texture coordinates.
enum class FacePlaces : std::uint8_t { passed_over, looked_for };

/// How many statements of each kind an OBJ text has.
struct ObjStatements {
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;
  bool has_relative = false;  // a face may have a relative index
  bool has_places = false;    // a face has texture coordinates; only if looked for
  bool has_colours = false;   // a vertex has a colour
  bool has_weights = false;
  bool has_alphas = false;
  std::vector<std::pair<std::string, std::uint64_t>> others;  // by their first words
  std::vector<std::string> libraries;                         // what follows "mtllib"; limited
  ObjNames materials;                                         // what follows "usemtl"
  ObjNames groups;                                            // "g"
  ObjNames objects;                                           // "o"

  /// At the start of a whole text.
  void begin_text();
  /// Counts the statements of a text that has only whole ones. Throws TextError for a line that is
  /// none.
  void count(std::string_view text, char line_end, FacePlaces places = FacePlaces::passed_over);
  /// Adds the counts of the text that follows.
  void add(const ObjStatements& next);
  /// How many of `others` begin with this word.
  std::uint64_t count_of(std::string_view word) const;
  /// "vertex.colour", "normals (435,545)", ... `kept`: words of statements that are not skipped.
  std::vector<std::string> skipped_names(bool keeps_colours,
                                         std::span<const std::string_view> kept = {}) const;

 private:
  void look_at_face(std::string_view line, FacePlaces places);
  void add_library(std::string_view name);
  void add_name(std::string_view word, std::string_view name);
};

/// The text from `at` to the end of its line, without blanks around it.
std::string_view rest_of_line(const char* at, std::string_view text, char line_end);

/// Whether OBJ has statements that begin with the word.
bool is_obj_statement(std::string_view word);

}  // namespace meshfarm
