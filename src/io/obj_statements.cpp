// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "obj_statements.hpp"

#include <algorithm>
#include <array>

#include <meshfarm/util/errors.hpp>

#include "obj_reader.hpp"
#include "text_scanner.hpp"

namespace meshfarm {
namespace {

/// The skipped statements and what they are called; those of free-form surfaces keep their own
/// words.
constexpr std::array<std::pair<std::string_view, std::string_view>, 11> k_names = {{
    {"vt", "texture coordinates"},
    {"vn", "normals"},
    {"usemtl", "uses of materials"},
    {"mtllib", "material libraries"},
    {"o", "objects"},
    {"g", "groups"},
    {"s", "smoothing groups"},
    {"l", "lines"},
    {"p", "points"},
    {"mg", "merging groups"},
    {"lod", "levels of detail"},
}};

constexpr std::array<std::string_view, 30> k_more = {
    "v",     "f",     "vp",       "cstype",   "deg",    "bmat",   "step",       "curv",
    "curv2", "surf",  "parm",     "trim",     "hole",   "scrv",   "sp",         "end",
    "con",   "bevel", "c_interp", "d_interp", "maplib", "usemap", "shadow_obj", "trace_obj",
    "ctech", "stech", "call",     "csh",      "fo",     "bsp"};

constexpr std::size_t k_most_words = 64;
constexpr std::size_t k_most_names = 100'000;

/// Whether it may be a statement of some writer's own.
bool may_be_statement(std::string_view word) {
  const auto is_letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  return word.size() <= 32 && std::all_of(word.begin(), word.end(), is_letter) &&
         !(word[0] >= '0' && word[0] <= '9');
}

bool add_to(std::vector<std::pair<std::string, std::uint64_t>>& counts, std::string_view word,
            std::uint64_t count) {
  const auto at = std::find_if(counts.begin(), counts.end(),
                               [word](const auto& each) { return each.first == word; });
  if (at != counts.end()) {
    at->second += count;
    return true;
  }
  if (counts.size() == k_most_words) return false;
  counts.emplace_back(word, count);
  return true;
}

}  // namespace

std::string_view rest_of_line(const char* at, std::string_view text, char line_end) {
  constexpr std::string_view k_blanks = " \t\r\v\f";
  std::string_view rest = text.substr(static_cast<std::size_t>(at - text.data()));
  rest = rest.substr(0, rest.find(line_end));
  const std::size_t first = rest.find_first_not_of(k_blanks);
  if (first == std::string_view::npos) return {};
  return rest.substr(first, rest.find_last_not_of(k_blanks) + 1 - first);
}

bool is_obj_statement(std::string_view word) {
  return std::any_of(k_names.begin(), k_names.end(),
                     [word](const auto& name) { return name.first == word; }) ||
         std::find(k_more.begin(), k_more.end(), word) != k_more.end();
}

void ObjStatements::count(std::string_view text, char line_end, FacePlaces places) {
  TextScanner scanner(text, line_end);
  for (; scanner.next_value(); scanner.next_line()) {
    const char* start = scanner.at();
    const std::string_view word = scanner.word();
    if (word == "v") {
      ++vertices;
      if (has_colours && has_weights && has_alphas) continue;
      std::size_t values = 0;
      for (; scanner.has_value(); scanner.word()) ++values;
      has_colours = has_colours || values >= 6;
      has_weights = has_weights || values == 4;
      has_alphas = has_alphas || values == 7;
    } else if (word == "f") {
      ++faces;
      materials.face();
      groups.face();
      objects.face();
      if (has_relative && (has_places || places == FacePlaces::passed_over)) continue;
      scanner.next_line();
      look_at_face({start, static_cast<std::size_t>(scanner.at() - start)}, places);
      scanner.go_to(start + 1);
    } else {
      if (!may_be_statement(word)) {
        scanner.go_to(start);
        scanner.fail(shown(word) + " begins no statement of OBJ");
      }
      if (!add_to(others, word, 1)) scanner.fail("too many kinds of statements that OBJ has not");
      if (word == "usemtl" || word == "mtllib" || word == "g" || word == "o") {
        add_name(word, rest_of_line(scanner.at(), text, line_end));
      }
    }
  }
}

void ObjStatements::look_at_face(std::string_view line, FacePlaces places) {
  has_relative = has_relative || line.find('-') != std::string_view::npos;
  if (has_places || places == FacePlaces::passed_over) return;
  const std::size_t next = line.find('/') + 1;  // 0 if there is none
  has_places = next > 0 && next < line.size() &&
               (line[next] == '-' || (line[next] >= '0' && line[next] <= '9'));
}

void ObjStatements::begin_text() {
  for (ObjNames* names : {&materials, &groups, &objects}) names->begin_text();
}

void ObjStatements::add_name(std::string_view word, std::string_view name) {
  if (word == "mtllib") return add_library(name);
  if (word == "usemtl") return materials.set(name);
  (word == "g" ? groups : objects).set(name);
}

void ObjStatements::add_library(std::string_view name) {
  if (libraries.size() < k_most_names &&
      std::find(libraries.begin(), libraries.end(), name) == libraries.end()) {
    libraries.emplace_back(name);
  }
}

std::uint64_t ObjStatements::count_of(std::string_view word) const {
  const auto found = std::find_if(others.begin(), others.end(),
                                  [word](const auto& each) { return each.first == word; });
  return found == others.end() ? 0 : found->second;
}

void ObjStatements::add(const ObjStatements& next) {
  for (const std::string& name : next.libraries) add_library(name);
  materials.add(next.materials);
  groups.add(next.groups);
  objects.add(next.objects);
  has_colours = has_colours || next.has_colours;
  has_weights = has_weights || next.has_weights;
  has_alphas = has_alphas || next.has_alphas;
  has_places = has_places || next.has_places;
  vertices += next.vertices;
  faces += next.faces;
  has_relative = has_relative || next.has_relative;
  for (const auto& [word, count] : next.others) {
    if (!add_to(others, word, count)) {
      throw DataError("too many kinds of statements that OBJ has not: " + word + ", for one");
    }
  }
}

std::vector<std::string> ObjStatements::skipped_names(
    bool keeps_colours, std::span<const std::string_view> kept) const {
  std::vector<std::string> names;
  if (has_colours && !keeps_colours) names.emplace_back("vertex.colour");
  if (has_weights) names.emplace_back("vertex.weight");
  if (has_alphas) names.emplace_back("vertex.alpha");
  for (const auto& [word, count] : others) {
    if (std::find(kept.begin(), kept.end(), word) != kept.end()) continue;
    const auto known = std::find_if(k_names.begin(), k_names.end(),
                                    [&w = word](const auto& name) { return name.first == w; });
    const std::string name(known == k_names.end() ? std::string_view(word) : known->second);
    names.push_back(name + " (" + std::to_string(count) + ")");
  }
  return names;
}

bool is_obj_file(const InputFile& file) {
  const std::unique_ptr<ByteStream> stream = file.open();
  const std::string_view start = stream->window(ByteStream::k_max_window_bytes);
  if (!is_text(start)) return false;
  TextScanner scanner(start, line_end_of(start));
  const bool is_named_so = has_extension(file, ".obj");
  if (!scanner.next_value()) return is_named_so;
  // Without the file's name, a nameless group is too weak a sign: a line of one letter.
  return is_obj_statement(scanner.word()) && (scanner.has_value() || is_named_so);
}

}  // namespace meshfarm
