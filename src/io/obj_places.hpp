// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "byte_stream.hpp"
#include "scratch_array.hpp"
#include "text_blocks.hpp"

namespace meshfarm {

/// An OBJ's text, which can be read any number of times.
struct ObjText {
  const InputFile& file;
  TextUnits units;
  unsigned threads = 1;
  TextBlocks blocks() const { return {file, units, threads}; }
};

/// The texture coordinates of an OBJ's "vt" statements: up to 48 MB in memory, more in a scratch
/// file.
class ObjPlaces {
 public:
  /// Reads them; v goes up from the picture's lower side. Invalid numbers become NaN. Throws
  /// DataError if there are not `count` of them.
  ObjPlaces(const ObjText& text, std::uint64_t count);

  std::uint64_t size() const { return size_; }
  /// Thread-safe.
  const Uv& at(std::uint64_t place) const { return items_[place]; }
  /// To be called after `count` lookups, by one thread.
  void used(std::size_t count) { places_.used(count); }

 private:
  ScratchArray<Uv> places_;
  const Uv* items_ = nullptr;
  std::uint64_t size_ = 0;
};

/// The numbers of vertices and texture coordinates before a place in the text.
struct ObjCounts {
  std::uint64_t vertices = 0;
  std::uint64_t places = 0;
};

/// The counts before each of the pieces of a text. `before`: those before all; updated to those
/// after them.
std::vector<ObjCounts> counts_before(std::span<const std::string_view> pieces, const ObjText& text,
                                     ObjCounts& before);

/// An index as in a face: from 1, or negative, backwards from the last of `before`. One before the
/// first becomes far too large.
inline std::uint64_t obj_index(std::int64_t number, std::uint64_t before) {
  return (number < 0 ? before : ~std::uint64_t{0}) + static_cast<std::uint64_t>(number);
}

}  // namespace meshfarm
