// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The header of a PLY file (Turk 1994), as real writers make it:
//   header   = "ply" format line* "end_header"       lines end in LF, CR LF, or CR throughout
//   format   = "format" ("ascii" | "binary_little_endian" | "binary_big_endian") "1.0"
//   line     = "comment" ... | "comment TextureFile" file | "obj_info" ... | element property*
//   element  = "element" name count
//   property = "property" type name | "property" "list" type type name
#include "ply_header.hpp"

#include <charconv>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr std::string_view k_header_blanks = " \t\r\v\f";
constexpr std::string_view k_byte_order_mark = "\xef\xbb\xbf";  // of UTF-8: some editors add it
constexpr std::size_t k_most_header_names = 4096;  // each new name is compared with all before it

std::string_view trimmed(std::string_view text, std::string_view what) {
  const std::size_t first = text.find_first_not_of(what);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(what) - first + 1);
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  while (!(line = trimmed(line, k_header_blanks)).empty()) {
    words.push_back(line.substr(0, line.find_first_of(k_header_blanks)));
    line.remove_prefix(words.back().size());
  }
  return words;
}

class HeaderParser {
 public:
  HeaderParser(std::string_view start, const std::filesystem::path& path)
      : rest_(start), total_(start.size()), path_(path) {}

  PlyHeader parse() {
    find_magic();
    while (!parse_line(next_line())) {
    }
    if (!has_format_) fail("there is no format line");
    header_.size_bytes = total_ - rest_.size();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw DataError(path_.string() + ": header line " + std::to_string(header_.lines) + ": " + why);
  }

  void find_magic() {
    if (rest_.starts_with(k_byte_order_mark)) rest_.remove_prefix(k_byte_order_mark.size());
    while (rest_.starts_with('\n') || rest_.starts_with('\r')) {
      if (rest_.front() == '\n') ++header_.lines;
      rest_.remove_prefix(1);
    }
    const std::string_view end = rest_.substr(std::min(rest_.find_first_of("\r\n"), rest_.size()));
    const bool old_mac = end.size() > 1 && end.starts_with('\r') && end[1] != '\n';
    if (old_mac) header_.line_end = '\r';
    next_line();
  }

  std::string_view next_line() {
    const std::size_t end = rest_.find(header_.line_end);
    if (end == std::string_view::npos) {
      throw DataError(path_.string() + ": the header has no end_header within " +
                      std::to_string(total_) + " bytes");
    }
    const std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    ++header_.lines;
    return line;
  }

  /// True for the last line of the header.
  bool parse_line(std::string_view line) {
    const std::vector<std::string_view> words = words_of(line);
    if (words.size() > 2 && words[0] == "comment" && words[1] == "TextureFile") {
      const auto start = static_cast<std::size_t>(words[2].data() - line.data());
      header_.texture_files.emplace_back(trimmed(line.substr(start), k_header_blanks));
    }
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") return false;
    if (words[0] == "end_header") return true;
    if (words[0] == "format") {
      parse_format(words);
    } else if (words[0] == "element") {
      parse_element(words);
    } else if (words[0] == "property") {
      parse_property(words);
    } else if (header_.elements.empty()) {
      // Some writers omit the word `comment` here, where nothing else can be meant.
      header_.oddities.push_back(path_.string() + ": header line " + std::to_string(header_.lines) +
                                 ": taken for a comment: " + shown(line));
    } else {
      fail("unknown keyword " + shown(words[0]));
    }
    return false;
  }

  void parse_format(const std::vector<std::string_view>& words) {
    if (has_format_) fail("a second format line");
    if (words.size() != 3) fail("a format line has three words");
    if (words[1] == "ascii") {
      header_.format = PlyFormat::ascii;
    } else if (words[1] == "binary_little_endian") {
      header_.format = PlyFormat::binary_little;
    } else if (words[1] == "binary_big_endian") {
      header_.format = PlyFormat::binary_big;
    } else {
      fail("unknown format " + shown(words[1]));
    }
    if (words[2] != "1.0") fail("unknown version " + shown(words[2]));
    has_format_ = true;
  }

  void parse_element(const std::vector<std::string_view>& words) {
    if (words.size() != 3) fail("an element line is: element NAME COUNT");
    if (header_.elements.size() == k_most_header_names) fail("too many elements");
    PlyElement element;
    element.name = words[1];
    for (const PlyElement& other : header_.elements) {
      if (other.name == element.name) fail("a second element " + shown(words[1]));
    }
    const char* end = words[2].data() + words[2].size();
    const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
    if (error != std::errc{} || stop != end) {
      fail("the count of element " + shown(words[1]) + " is " + shown(words[2]));
    }
    header_.elements.push_back(std::move(element));
  }

  void parse_property(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("a property before any element");
    PlyProperty property;
    const bool list = words.size() > 1 && words[1] == "list";
    if (words.size() != (list ? 5 : 3)) fail("a property line is: property [list TYPE] TYPE NAME");
    if (list) property.count_type = type_of(words[2]);
    property.type = type_of(words[list ? 3 : 1]);
    property.name = words.back();
    PlyElement& element = header_.elements.back();
    if (element.properties.size() == k_most_header_names) fail("too many properties");
    for (const PlyProperty& other : element.properties) {
      if (other.name == property.name) {
        fail("element " + shown(element.name) + " has a second property " + shown(property.name));
      }
    }
    element.properties.push_back(std::move(property));
  }

  PlyType type_of(std::string_view word) const {
    const std::optional<PlyType> type = ply_type(word);
    if (!type) fail("unknown type " + shown(word));
    return *type;
  }

  std::string_view rest_;
  std::size_t total_;
  const std::filesystem::path& path_;
  PlyHeader header_;
  bool has_format_ = false;
};

std::optional<std::size_t> find_property(const PlyElement& element, std::string_view name) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    if (element.properties[i].name == name) return i;
  }
  return std::nullopt;
}

void find_axes(PlyElement& element, const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 3> k_names{"x", "y", "z"};
  element.role = PlyRole::vertices;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<std::size_t> found = find_property(element, k_names[axis]);
    if (!found || element.properties[*found].is_list()) {
      throw DataError(path.string() + ": the vertices have no " + std::string(k_names[axis]));
    }
    element.axes[axis] = *found;
  }
}

void find_corners(PlyElement& element, const std::filesystem::path& path) {
  std::optional<std::size_t> found = find_property(element, "vertex_indices");
  if (!found) found = find_property(element, "vertex_index");
  if (found && element.properties[*found].is_list()) {
    element.role = element.name == "face" ? PlyRole::faces : PlyRole::strips;
    element.index_list = *found;
  } else if (element.count > 0) {
    throw DataError(path.string() + ": element " + element.name + " has no list vertex_indices");
  }
}

}  // namespace

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& property) { return property.is_list(); });
}

std::uint64_t PlyElement::record_bytes(PlyFormat format) const {
  if (format == PlyFormat::ascii) return 2 * properties.size();  // a digit and a space each
  std::uint64_t size = 0;
  for (const PlyProperty& property : properties) {
    size += size_of(property.count_type.value_or(property.type));
  }
  return size;
}

/// Floats hold every 16-bit integer, doubles every 32-bit one.
PositionType position_type_of(const PlyElement& vertices) {
  for (const std::size_t axis : vertices.axes) {
    const PlyType type = vertices.properties[axis].type;
    if (type != PlyType::float32 && size_of(type) > 2) return PositionType::float64;
  }
  return PositionType::float32;
}

const PlyElement& PlyHeader::vertices() const {
  return *std::find_if(elements.begin(), elements.end(),
                       [](const PlyElement& element) { return element.role == PlyRole::vertices; });
}

bool is_ply(std::string_view start) {
  if (start.starts_with(k_byte_order_mark)) start.remove_prefix(k_byte_order_mark.size());
  start.remove_prefix(std::min(start.find_first_not_of("\r\n"), start.size()));
  if (!start.starts_with("ply")) return false;
  start = start.substr(3, start.find_first_of("\r\n") - 3);
  return trimmed(start, k_header_blanks).empty();
}

PlyHeader parse_ply_header(std::string_view start, const std::filesystem::path& path) {
  PlyHeader header = HeaderParser(start, path).parse();
  bool has_vertices = false;
  for (PlyElement& element : header.elements) {
    if (element.name == "vertex") {
      find_axes(element, path);
      has_vertices = true;
    }
    if (element.name == "face" || element.name == "tristrips") find_corners(element, path);
  }
  if (!has_vertices) throw DataError(path.string() + ": the header has no element vertex");
  return header;
}

}  // namespace meshfarm
