// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The page of a run: it exists, is complete, and loads nothing.
#include <filesystem>
#include <regex>
#include <string>

#include <doctest/doctest.h>

#include "support/shell.hpp"

using meshfarm::test::has;
using meshfarm::test::Ran;
using meshfarm::test::read_text;
using meshfarm::test::Shell;
namespace fs = std::filesystem;

namespace {

std::size_t count_of(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
    ++count;
  }
  return count;
}

/// The page without its times and its timeline.
std::string without_times(const std::string& page) {
  const std::size_t time = page.find("<h2>Time</h2>");
  const std::size_t again = page.find("<h2>Again</h2>");
  REQUIRE(time < again);
  const std::string rest = page.substr(0, time) + page.substr(again);
  return std::regex_replace(rest, std::regex("<b>[^<]*</b><span>from input to result"), "");
}

}  // namespace

TEST_CASE("simplify --report writes one page of the run, with pictures, that loads nothing") {
  Shell shell;
  const std::string mesh = shell.path("torus.ply");
  REQUIRE(shell({"generate", "-o", mesh, "--triangles", "20000", "-q"}).code == 0);
  const auto page_of = [&](const std::string& scheme) {
    const Ran ran =
        shell({"simplify", mesh, "-o", shell.path("small.ply"), "--ratio", "0.05", "--parts", "3",
               "--scheme", scheme, "--workers", "1", "-q", "--report", shell.path("page.html")});
    REQUIRE_MESSAGE(ran.code == 0, ran.err);
    CHECK_FALSE(fs::exists(shell.path("small.ply.stage")));
    return read_text(shell.path("page.html"));
  };
  const std::string page = page_of("cut");
  CHECK(page.starts_with("<!DOCTYPE html>"));
  CHECK(page.ends_with("</html>\n"));
  CHECK(page.size() < 6'000'000);
  CHECK(count_of(page, "<img ") == 10);
  CHECK(count_of(page, "src=\"data:image/png;base64,iVBOR") == 10);
  CHECK(count_of(page, "src=") == 10);
  CHECK(count_of(page, "http:") == count_of(page, "http://www.w3.org/2000/svg"));
  for (const char* const tag : {"section", "table", "figure", "svg", "div", "pre", "script"}) {
    CAPTURE(tag);
    const std::string name(tag);
    CHECK(count_of(page, "<" + name + ">") + count_of(page, "<" + name + " ") ==
          count_of(page, "</" + name + ">"));
  }
  CHECK(has(page, "<pre>meshfarm simplify "));
  CHECK(has(page, "<td>handles</td><td>1</td><td>1</td>"));
  CHECK(without_times(page_of("cut")) == without_times(page));
  CHECK(has(page_of("stream"), "slabs in colours"));
}

TEST_CASE("report makes the page of a stage, and says what is missing") {
  Shell shell;
  const std::string mesh = shell.path("torus.ply");
  const std::string stage = shell.path("s.stage");
  const std::string small = shell.path("small.ply");
  REQUIRE(shell({"generate", "-o", mesh, "--triangles", "5000", "-q"}).code == 0);
  REQUIRE(shell({"cut", mesh, "--stage", stage, "-q"}).code == 0);
  CHECK(shell({"report", stage}).code == 1);
  REQUIRE(shell({"replay", stage, "-o", small, "--ratio", "0.1", "--workers", "1", "-q"}).code ==
          0);
  REQUIRE(shell({"report", stage}).code == 0);
  const std::string page = read_text(stage + "/report.html");
  CHECK(count_of(page, "<img ") == 10);
  CHECK(has(page, "<pre>meshfarm replay "));
  fs::remove(small);
  REQUIRE(shell({"report", stage}).code == 0);
  CHECK(has(read_text(stage + "/report.html"), "There are no pictures"));
  const Ran nowhere = shell(
      {"replay", stage, "-o", small, "--ratio", "0.1", "--report", shell.path("none/page.html")});
  CHECK(nowhere.code == 1);
  CHECK(has(nowhere.err, "cannot write into"));
}
