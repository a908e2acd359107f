// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

#include "byte_stream.hpp"

namespace meshfarm {

/// An error in a text, and its place in the memory that holds it.
struct TextError {
  const char* at = nullptr;
  std::string why;
};

/// '\n', or '\r' for a text without '\n'.
char line_end_of(std::string_view start);

/// Whether the start of a file may be text: it has no zero byte.
bool is_text(std::string_view start);

/// Where a text may be divided.
struct TextUnits {
  char line_end = '\n';
  /// Whether the text after the line end at `at` is independent of the text before it.
  bool (*ends_at)(std::string_view text, std::size_t at) = nullptr;
};

/// A text as blocks of pieces, one per thread, each of whole units. A unit that is longer than a
/// block extends the block, up to 64 MB.
class TextBlocks {
 public:
  /// `file` must outlive this.
  TextBlocks(const InputFile& file, TextUnits units, unsigned threads);

  /// The pieces of the next block, in order; none at the end. Valid until the next call.
  std::span<const std::string_view> next();
  /// The number of the line at `at`, a place in the block.
  std::uint64_t line_of(const char* at) const;
  /// Throws the error as a DataError that names file and line.
  [[noreturn]] void fail(const TextError& error) const;

 private:
  void fill();
  std::size_t whole_units() const;
  void divide(std::string_view text);

  std::filesystem::path path_;
  std::unique_ptr<ByteStream> stream_;
  TextUnits units_;
  unsigned threads_;
  std::size_t capacity_;
  std::unique_ptr<char[]> buffer_;
  std::size_t held_ = 0;
  std::size_t block_ = 0;    // bytes of the current block
  std::uint64_t lines_ = 0;  // before the current block
  bool at_end_ = false;
  std::vector<std::string_view> pieces_;
};

/// For each block: calls `prepare(pieces, made)`, `parse(text, made)` for each of its pieces on up
/// to `threads` threads, and `take(made)` for each in the order of the text. `made` is reused. A
/// TextError thrown by `parse` becomes a DataError with its line.
template <class Made, class Prepare, class Parse, class Take>
void for_pieces(TextBlocks& blocks, unsigned threads, const Prepare& prepare, const Parse& parse,
                const Take& take) {
  std::vector<Made> made;
  while (true) {
    const std::span<const std::string_view> pieces = blocks.next();
    if (pieces.empty()) return;
    if (made.size() < pieces.size()) made.resize(pieces.size());
    prepare(pieces, std::span(made));
    try {
      parallel_for(pieces.size(), threads, [&](std::uint64_t i) { parse(pieces[i], made[i]); });
    } catch (const TextError& error) {
      blocks.fail(error);
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) take(made[i]);
  }
}

template <class Made, class Parse, class Take>
void for_pieces(TextBlocks& blocks, unsigned threads, const Parse& parse, const Take& take) {
  const auto prepare = [](std::span<const std::string_view>, std::span<Made>) {};
  for_pieces<Made>(blocks, threads, prepare, parse, take);
}

}  // namespace meshfarm
