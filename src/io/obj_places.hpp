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

/// An OBJ's text, to be read again and again.
struct ObjText {
  const InputFile& file;
  TextUnits units;
  unsigned threads = 1;
  TextBlocks blocks() const { return {file, units, threads}; }
};

/// The texture coordinates that the "vt" statements of an OBJ have: up to 48 MB in memory, more in
/// a scratch file.
class ObjPlaces {
 public:
  /// Reads them; v goes up from the picture's lower side. What is no number is NaN. Throws
  /// DataError if there are not so many.
  ObjPlaces(const ObjText& text, std::uint64_t count);

  std::uint64_t size() const { return size_; }
  /// Threads may ask at the same time.
  const Uv& at(std::uint64_t place) const { return items_[place]; }
  /// To be told of so many that were asked for, by one thread.
  void used(std::size_t count) { places_.used(count); }

 private:
  ScratchArray<Uv> places_;
  const Uv* items_ = nullptr;
  std::uint64_t size_ = 0;
};

/// How many vertices and texture coordinates come before something.
struct ObjCounts {
  std::uint64_t vertices = 0;
  std::uint64_t places = 0;
};

/// Those before each of the pieces of a text. `before`: those before all, and then after them.
std::vector<ObjCounts> counts_before(std::span<const std::string_view> pieces, const ObjText& text,
                                     ObjCounts& before);

/// An index as faces have it: from 1 on, or backwards from the last of `before`. What is before the
/// first becomes far too large.
inline std::uint64_t obj_index(std::int64_t number, std::uint64_t before) {
  return (number < 0 ? before : ~std::uint64_t{0}) + static_cast<std::uint64_t>(number);
}

}  // namespace meshfarm
