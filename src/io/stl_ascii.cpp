// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The input:
//   file  = { "solid" rest of the line | "endsolid" rest of the line | facet }
//   facet = "facet" ["normal" x y z] "outer" "loop" 3 * ("vertex" x y z) "endloop" "endfacet"
// in any case of letters, and with any blanks and lines between the words.
#include <algorithm>

#include "stl_reader.hpp"
#include "text_scanner.hpp"
#include "text_source.hpp"

namespace meshfarm {
namespace {

bool is_word(std::string_view text, std::string_view lower_case) {
  return std::equal(text.begin(), text.end(), lower_case.begin(), lower_case.end(),
                    [](char any, char lower) { return (any | 0x20) == lower; });
}

/// Whether the line that ends at `at` begins with "endfacet".
bool ends_facet(std::string_view text, std::size_t at) {
  const std::string_view before = text.substr(0, at);
  const std::size_t last = before.find_last_not_of(" \t\r");
  constexpr std::string_view k_word = "endfacet";
  if (last == std::string_view::npos || last + 1 < k_word.size()) return false;
  const std::size_t start = last + 1 - k_word.size();
  if (!is_word(before.substr(start, k_word.size()), k_word)) return false;
  // The name of a solid may be "endfacet", so the word must begin the line.
  for (std::size_t i = start; i > 0; --i) {
    const char c = before[i - 1];
    if (c == text[at]) return true;
    if (c != ' ' && c != '\t') return false;
  }
  return true;
}

/// Goes through the facets of a text, all of which must be whole, and calls `corner(scanner)` at
/// the coordinates of each vertex.
template <class Corner>
void for_facets(TextScanner& scanner, const Corner& corner) {
  const auto next = [&](std::string_view expected) {
    if (!scanner.next_value()) scanner.fail("the file ends inside a facet");
    if (!is_word(scanner.peek(), expected)) {
      scanner.fail("there is " + scanner.token() + " where '" + std::string(expected) +
                   "' should be");
    }
    scanner.word();
  };
  while (scanner.next_value()) {
    const std::string_view word = scanner.peek();
    if (is_word(word, "solid") || is_word(word, "endsolid")) {
      scanner.next_line();
      continue;
    }
    next("facet");
    if (scanner.next_value() && is_word(scanner.peek(), "normal")) {
      scanner.word();
      for (int axis = 0; axis < 3; ++axis) scanner.skip_word();
    }
    next("outer");
    next("loop");
    for (int i = 0; i < 3; ++i) {
      next("vertex");
      corner(scanner);
    }
    next("endloop");
    next("endfacet");
  }
}

class AsciiStl final : public TextSource {
 public:
  AsciiStl(InputFile file, const OpenOptions& options)
      : TextSource(std::move(file), options, "STL ascii", ends_facet) {
    TextBlocks text = blocks();
    for_pieces<std::uint64_t>(
        text, threads(),
        [this](std::string_view piece, std::uint64_t& corners) {
          TextScanner scanner(piece, line_end());
          corners = 0;
          for_facets(scanner, [&corners](TextScanner& at) {
            for (int axis = 0; axis < 3; ++axis) at.skip_word();
            ++corners;
          });
        },
        [this](std::uint64_t corners) { counted().vertices += corners; });
    counted().faces = info().vertices / 3;
    counted().skipped = {"facet.normal"};
    look_at_digits();
  }

  void scan_triangles(const std::function<void(const TriangleView&)>& take) override {
    take_soup(info().faces, take);
  }

 private:
  void parse_vertices(std::string_view text, bool wide, Points& points) const override {
    TextScanner scanner(text, line_end());
    for_facets(scanner, [&](TextScanner& at) {
      const double x = at.real(wide);
      const double y = at.real(wide);
      const Vec3 p{x, y, at.real(wide)};
      points.positions.push_back(is_finite(p) ? p : k_no_position);
    });
    points.has_lost_digits = scanner.has_lost_digits();
  }
};

}  // namespace

bool is_ascii_stl_file(const InputFile& file) {
  const std::unique_ptr<ByteStream> stream = file.open();
  const std::string_view start = stream->window(ByteStream::k_max_window_bytes);
  if (!is_text(start)) return false;
  TextScanner scanner(start, line_end_of(start));
  if (!scanner.next_value() || !is_word(scanner.peek(), "solid")) return false;
  while (scanner.next_value()) {
    const std::string_view word = scanner.peek();
    if (!is_word(word, "solid")) return is_word(word, "facet") || is_word(word, "endsolid");
    scanner.next_line();
  }
  return false;
}

std::unique_ptr<MeshSource> open_ascii_stl(InputFile file, const OpenOptions& options) {
  return std::make_unique<AsciiStl>(std::move(file), options);
}

}  // namespace meshfarm
