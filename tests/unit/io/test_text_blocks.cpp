// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <optional>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "io/text_blocks.hpp"
#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

bool ends_anywhere(std::string_view, std::size_t) {
  return true;
}

/// A unit ends with a line that ends with '.'.
bool ends_at_point(std::string_view text, std::size_t at) {
  return at > 0 && text[at - 1] == '.';
}

/// All pieces in order.
std::vector<std::string> pieces_in(TextBlocks& blocks) {
  std::vector<std::string> all;
  for (auto pieces = blocks.next(); !pieces.empty(); pieces = blocks.next()) {
    all.insert(all.end(), pieces.begin(), pieces.end());
  }
  return all;
}

std::string lines_of(std::size_t bytes, const std::string& line) {
  std::string text;
  while (text.size() < bytes) text += line;
  return text;
}

struct TextFile {
  explicit TextFile(std::string_view text) {
    write_file(folder / "text", text);
    file.emplace(folder / "text");
  }
  TempFolder folder;
  std::optional<InputFile> file;
};

}  // namespace

TEST_CASE("the pieces of a text are all of it, and end where units end") {
  const std::string text = lines_of(3 << 20, "one line\nand its end.\n");
  const TextFile text_file(text);
  for (const unsigned threads : {1U, 2U, 3U, 7U}) {
    TextBlocks blocks(*text_file.file, {'\n', ends_at_point}, threads);
    const std::vector<std::string> pieces = pieces_in(blocks);
    CHECK(pieces.size() >= 6);
    std::string all;
    for (const std::string& piece : pieces) {
      REQUIRE(piece.ends_with(".\n"));
      all += piece;
    }
    CHECK(all == text);
  }
}

TEST_CASE("the last unit of a text needs no end, and a text may be empty") {
  const TextFile text_file("a\nb");
  TextBlocks blocks(*text_file.file, {'\n', ends_anywhere}, 2);
  CHECK(pieces_in(blocks) == std::vector<std::string>{"a\nb"});
  const TextFile empty("");
  TextBlocks none(*empty.file, {'\n', ends_anywhere}, 2);
  CHECK(none.next().empty());
}

TEST_CASE("a unit may be longer than a block, but not without bounds") {
  const std::string text = "short.\n" + lines_of(5 << 20, "long\n") + ".\nshort.\n";
  const TextFile text_file(text);
  TextBlocks blocks(*text_file.file, {'\n', ends_at_point}, 2);
  std::string all;
  for (const std::string& piece : pieces_in(blocks)) all += piece;
  CHECK(all == text);
  const TextFile endless("short.\n" + lines_of(65 << 20, "long\n"));
  TextBlocks too_long(*endless.file, {'\n', ends_at_point}, 1);
  CHECK(too_long.next().size() == 1);
  CHECK_THROWS_WITH_AS(
      too_long.next(),
      (endless.file->path().string() + ": line 2: what begins here has no end in 64 MB").c_str(),
      DataError);
}

TEST_CASE("what is wrong in a piece is told with its line in the file, the first of all") {
  std::string text;
  for (int i = 1; i <= 300'000; ++i) text += "line " + std::to_string(i) + "\n";
  const TextFile text_file(text);
  for (const unsigned threads : {1U, 4U}) {
    TextBlocks blocks(*text_file.file, {'\n', ends_anywhere}, threads);
    const auto parse = [](std::string_view piece, int&) {
      for (const auto* wrong : {"line 250001\n", "line 290001\n"}) {
        const std::size_t at = piece.find(wrong);
        if (at != std::string_view::npos) throw TextError{piece.data() + at, "it is wrong"};
      }
    };
    CHECK_THROWS_WITH_AS(for_pieces<int>(blocks, threads, parse, [](int) {}),
                         (text_file.file->path().string() + ": line 250001: it is wrong").c_str(),
                         DataError);
  }
}

TEST_CASE("line ends are told from the start of a text") {
  CHECK(line_end_of("a\nb") == '\n');
  CHECK(line_end_of("a\r\nb") == '\n');
  CHECK(line_end_of("a\rb") == '\r');
  CHECK(line_end_of("a") == '\n');
  CHECK(is_text("a"));
  CHECK_FALSE(is_text(std::string_view("a\0b", 3)));
}
