// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Input: "vt" u [v]
#include "obj_places.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "text_numbers.hpp"
#include "text_scanner.hpp"

namespace meshfarm {
namespace {

float read_place(TextScanner& scanner) {
  double value = 0;
  if (!scanner.has_value()) return 0;
  const std::string_view word = scanner.word();
  if (read_number(word.data(), word.data() + word.size(), value) == nullptr) {
    return std::numeric_limits<float>::quiet_NaN();
  }
  return static_cast<float>(value);
}

}  // namespace

ObjPlaces::ObjPlaces(const ObjText& text, std::uint64_t count)
    : places_(count), items_(places_.items().data()), size_(count) {
  TextBlocks blocks = text.blocks();
  std::uint64_t done = 0;
  const auto check = [&](bool holds) {
    if (!holds) throw DataError(text.file.path().string() + ": changed while it was read");
  };
  for_pieces<std::vector<Uv>>(
      blocks, text.threads,
      [&text](std::string_view piece, std::vector<Uv>& made) {
        made.clear();
        TextScanner scanner(piece, text.units.line_end);
        for (; scanner.next_value(); scanner.next_line()) {
          if (scanner.word() != "vt") continue;
          const float u = read_place(scanner);
          made.push_back({u, read_place(scanner)});
        }
      },
      [&](const std::vector<Uv>& made) {
        check(made.size() <= count - done);
        std::copy(made.begin(), made.end(),
                  places_.items().begin() + static_cast<std::ptrdiff_t>(done));
        done += made.size();
        places_.used(made.size());
      });
  check(done == count);
}

std::vector<ObjCounts> counts_before(std::span<const std::string_view> pieces, const ObjText& text,
                                     ObjCounts& before) {
  std::vector<ObjCounts> made(pieces.size());
  parallel_for(pieces.size(), text.threads, [&](std::uint64_t i) {
    TextScanner scanner(pieces[i], text.units.line_end);
    for (; scanner.next_value(); scanner.next_line()) {
      const std::string_view word = scanner.word();
      made[i].vertices += word == "v" ? 1 : 0;
      made[i].places += word == "vt" ? 1 : 0;
    }
  });
  for (ObjCounts& each : made) {
    const ObjCounts own = std::exchange(each, before);
    before.vertices += own.vertices;
    before.places += own.places;
  }
  return made;
}

}  // namespace meshfarm
