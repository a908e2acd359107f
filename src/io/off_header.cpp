// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The input:
//   header = ["ST"] ["C"] ["N"] "OFF" vertices faces [edges], on one line or more; the letters
//            before "OFF" in any order
//   vertex = x y z [normal, of N] [colour of 3 or 4 values, of C] [s t, of ST]
//            x y z colour of 4 values, normal, [s t], if N comes before C: MeshLab writes so
//   face   = count corners [any values]
// '#' begins a comment. "OFF8 6 12" is read as "OFF 8 6 12": ModelNet is full of such files.
#include "off_header.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include <meshfarm/util/errors.hpp>

#include "text_scanner.hpp"

namespace meshfarm {
namespace {

constexpr int k_lines_looked_at = 1000;

/// The first word, letter by letter.
struct Keyword {
  bool has_texture = false;
  bool has_colour = false;
  bool has_normal = false;
  bool has_normal_last = false;  // after the colour
  bool has_fourth = false;       // homogeneous
  bool has_dimensions = false;   // the file gives the number of dimensions
  std::size_t size = 0;
};

std::optional<Keyword> keyword_of(std::string_view text) {
  Keyword word;
  std::string_view left = text;
  const auto take = [&left](std::string_view part) {
    if (!left.starts_with(part)) return false;
    left.remove_prefix(part.size());
    return true;
  };
  const auto take_once = [&take](bool& has, std::string_view part) {
    if (has) return false;
    has = take(part);
    return has;
  };
  while (take_once(word.has_texture, "ST") || take_once(word.has_colour, "C") ||
         take_once(word.has_normal, "N")) {
  }
  const std::string_view letters = text.substr(0, text.size() - left.size());
  word.has_normal_last =
      word.has_normal && word.has_colour && letters.find('N') < letters.find('C');
  word.has_fourth = take("4");
  word.has_dimensions = take("n");
  if (!take("OFF")) return std::nullopt;
  if (!left.empty() && (left[0] < '0' || left[0] > '9')) return std::nullopt;
  word.size = text.size() - left.size();
  return word;
}

class OffHeaderParser {
 public:
  OffHeaderParser(std::string_view start, const std::filesystem::path& path)
      : start_(start), path_(path), scanner_(start, line_end_of(start)) {
    header_.title = "OFF ascii";
    header_.line_end = line_end_of(start);
    header_.has_comments = true;
  }

  PlyHeader parse() {
    try {
      parse_words();
    } catch (const TextError& error) {
      throw DataError(path_.string() + ": line " + std::to_string(lines_before(error.at) + 1) +
                      ": " + error.why);
    }
    return std::move(header_);
  }

 private:
  void parse_words() {
    scanner_.next_value();
    const Keyword word = keyword_of(scanner_.peek()).value();
    if (word.has_fourth || word.has_dimensions) {
      scanner_.fail("this OFF is not of three dimensions, and cannot be read");
    }
    scanner_.go_to(scanner_.at() + word.size);
    if (scanner_.has_value() && scanner_.peek() == "BINARY") {
      scanner_.fail("binary OFF is not read: write it as ascii OFF, or as PLY");
    }
    const std::uint64_t vertices = read_count("vertices");
    const std::uint64_t faces = read_count("faces");
    if (scanner_.has_value()) read_count("edges");
    if (scanner_.has_value()) scanner_.fail("there is more than the counts on this line");
    scanner_.next_line();
    header_.size_bytes = static_cast<std::uint64_t>(scanner_.at() - start_.data());
    header_.lines = lines_before(scanner_.at());
    header_.elements = {vertex_element(word, vertices), face_element(faces)};
  }

  std::uint64_t read_count(const char* what) {
    if (!scanner_.next_value()) {
      scanner_.fail(std::string("the file ends before its count of ") + what);
    }
    std::int64_t count = 0;
    const char* stop = read_number(scanner_.at(), scanner_.limit(), count);
    if (stop == nullptr || !scanner_.ends_value(stop) || count < 0) {
      scanner_.fail("the count of " + std::string(what) + " is " + scanner_.token());
    }
    scanner_.go_to(stop);
    return static_cast<std::uint64_t>(count);
  }

  /// Whether no colour at the start of the file has a decimal point: then colours are whole numbers
  /// up to 255, else numbers up to 1. `before` and `after`: the values of other kinds in a line.
  bool has_levels(std::size_t before, std::size_t after) {
    const char* start = scanner_.at();
    bool any = false;
    std::vector<std::string_view> values;
    for (int lines = 0; lines < k_lines_looked_at && scanner_.next_value(); ++lines) {
      values.clear();
      while (scanner_.has_value()) values.push_back(scanner_.word());
      for (std::size_t i = before; i + after < values.size(); ++i) {
        any = any || values[i].find('.') != std::string_view::npos;
      }
      scanner_.next_line();
    }
    scanner_.go_to(start);
    return !any;
  }

  PlyElement vertex_element(const Keyword& word, std::uint64_t count) {
    PlyElement element{.name = "vertex", .count = count, .properties = {}};
    element.role = PlyRole::vertices;
    element.axes = {0, 1, 2};
    std::vector<std::string> names = {"x", "y", "z"};
    const auto add_normal = [&] { names.insert(names.end(), {"nx", "ny", "nz"}); };
    if (word.has_normal && !word.has_normal_last) add_normal();
    const std::size_t first_colour = names.size();
    if (word.has_colour) names.insert(names.end(), {"red", "green", "blue"});
    if (word.has_normal_last) names.emplace_back("alpha");
    const std::size_t end_of_colour = names.size();
    if (word.has_normal_last) add_normal();
    if (word.has_texture) names.insert(names.end(), {"s", "t"});
    const bool is_whole = word.has_colour && has_levels(first_colour, names.size() - end_of_colour);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const bool is_level = is_whole && i >= first_colour && i < end_of_colour;
      element.properties.push_back({.name = names[i],
                                    .type = is_level ? PlyType::uint8 : PlyType::float32,
                                    .count_type = {}});
    }
    // A colour may have an alpha.
    element.more = word.has_colour ? MoreValues::known : MoreValues::told;
    return element;
  }

  static PlyElement face_element(std::uint64_t count) {
    PlyElement element{.name = "face", .count = count, .properties = {}};
    element.role = PlyRole::faces;
    element.properties = {
        {.name = "vertex_indices", .type = PlyType::int32, .count_type = PlyType::int32}};
    element.more = MoreValues::told;
    return element;
  }

  std::uint64_t lines_before(const char* at) const {
    return static_cast<std::uint64_t>(std::count(start_.data(), at, header_.line_end));
  }

  std::string_view start_;
  const std::filesystem::path& path_;
  TextScanner scanner_;
  PlyHeader header_;
};

}  // namespace

bool is_off(std::string_view start) {
  TextScanner scanner(start, line_end_of(start));
  return scanner.next_value() && keyword_of(scanner.peek()).has_value();
}

PlyHeader parse_off_header(std::string_view start, const std::filesystem::path& path) {
  return OffHeaderParser(start, path).parse();
}

}  // namespace meshfarm
