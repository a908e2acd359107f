// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "io/text_scanner.hpp"

using namespace meshfarm;

namespace {

/// The values of all lines: "a b/c" for two on the first line and one on the second.
std::string walked(std::string_view text, char line_end = '\n') {
  TextScanner scanner(text, line_end);
  std::string made;
  while (!scanner.at_end()) {
    bool is_first = true;
    for (; scanner.has_value(); is_first = false) {
      made += (is_first ? "" : " ") + std::string(scanner.word());
    }
    made += '/';
    scanner.next_line();
  }
  return made;
}

double number(std::string_view text) {
  TextScanner scanner(text, '\n');
  return scanner.real(true);
}

}  // namespace

TEST_CASE("a scanner goes from value to value, and from line to line") {
  CHECK(walked("a b\nc\n") == "a b/c/");
  CHECK(walked("  a\t b \r\n\r\nc") == "a b//c/");
  CHECK(walked("a\rb", '\r') == "a/b/");
  CHECK(walked("") == "");
}

TEST_CASE("a scanner passes over comments") {
  CHECK(walked("# a\nb # c\nd#e\n") == "/b/d/");
  CHECK(walked("a # b \\\nc") == "a/c/");
}

TEST_CASE("a scanner joins lines that end with a backslash") {
  CHECK(walked("a \\\nb\\\r\nc\nd") == "a b c/d/");
  CHECK(walked("a \\ b\n") == "a \\ b/");
  CHECK(walked("a \\") == "a/");
  TextScanner scanner("a \\\n b\nc", '\n');
  scanner.next_line();
  CHECK(scanner.word() == "c");
}

TEST_CASE("a scanner reads coordinates, and tells where there is none") {
  CHECK(number("1.5 2") == 1.5);
  CHECK(number("+1e2") == 100);
  CHECK(number("-.5#") == -0.5);
  for (const auto text : {"x", "1.5x", "1,5", "+-1", "0x1"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(number(text), TextError);
  }
  CHECK_THROWS_AS(number(" \n1"), TextError);
  CHECK_THROWS_AS(number(std::string(300, '1')), TextError);
}

TEST_CASE("a scanner tells whether a float has lost digits") {
  TextScanner scanner("0.1 16777217 1", '\n');
  CHECK(scanner.real(false) == static_cast<double>(0.1F));
  CHECK_FALSE(scanner.has_lost_digits());
  CHECK(scanner.real(false) == 16777216);
  CHECK(scanner.has_lost_digits());
}
