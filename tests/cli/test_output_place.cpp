// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <sys/stat.h>

#include "support/shell.hpp"

using meshfarm::test::has;
using meshfarm::test::lines;
using meshfarm::test::Ran;
using meshfarm::test::read_text;
using meshfarm::test::Shell;
namespace fs = std::filesystem;

TEST_CASE("no result is written over the input that it is made of") {
  Shell shell;
  const std::string cube = shell.cube();
  const std::string before = read_text(cube);
  fs::create_symlink(cube, shell.path("link.ply"));
  for (const std::string& output : {cube, shell.path("link.ply")}) {
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"simplify", cube, "-o", output, "--ratio", "0.5"},
          {"convert", cube, output}}) {
      const Ran ran = shell(words);
      CHECK(ran.code == 2);
      CHECK(lines(ran.err) == 1);
      CHECK(has(ran.err, "would write over the input"));
      CHECK(read_text(cube) == before);
      CHECK_FALSE(fs::exists(output + ".stage"));
    }
  }
}

TEST_CASE("no file is written over the input, the result or the stage that it is made of") {
  Shell shell;
  const std::string cube = shell.cube();
  const std::string before = read_text(cube);
  const std::string stage = shell.path("s");
  const std::string result = shell.path("r.ply");
  REQUIRE(shell({"cut", cube, "--stage", stage}).code == 0);
  const std::string manifest = read_text(stage + "/manifest");
  const std::vector<std::string> simplify = {"simplify", cube, "-o", result, "--ratio", "0.5"};
  const std::vector<std::string> replay = {"replay", stage, "--ratio", "0.5"};
  const auto refused = [&](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    const Ran ran = shell(words);
    CAPTURE(ran.err);
    CHECK(ran.code == 2);
    CHECK(lines(ran.err) == 1);
    CHECK(has(ran.err, "would write over "));
    CHECK(read_text(cube) == before);
    CHECK(read_text(stage + "/manifest") == manifest);
  };
  refused(simplify, {"--report", cube});
  refused(simplify, {"--report", result});
  refused(simplify, {"--stage", stage, "--report", stage + "/manifest"});
  refused(replay, {"-o", cube});
  refused(replay, {"-o", result, "--report", result});
  refused(replay, {"-o", result, "--report", cube});
  refused(replay, {"-o", result, "--report", stage + "/manifest"});
  refused({"generate", "--shuffle", "--from", cube, "-o", cube}, {});
  CHECK_FALSE(fs::exists(result));

  REQUIRE(shell({"replay", stage, "--ratio", "0.5", "-o", result}).code == 0);
  const std::string made = read_text(result);
  refused({"report", stage, "-o", result}, {});
  refused({"report", stage, "-o", stage + "/manifest"}, {});
  refused({"simulate", stage, "--paper", "-o", stage + "/manifest"}, {});
  refused({"simulate", stage, "--paper", "-o", cube}, {});
  CHECK(read_text(result) == made);
  CHECK(shell({"report", stage}).code == 0);
}

TEST_CASE("a stage that was cut before is kept by a command that takes it up") {
  Shell shell;
  const std::string cube = shell.cube();
  const std::string stage = shell.path("s");
  REQUIRE(shell({"cut", cube, "--stage", stage}).code == 0);
  const std::vector<std::string> simplify = {"simplify", cube,  "-o",     shell.path("r.ply"),
                                             "--ratio",  "0.5", "--stage"};
  const auto with = [&](const std::string& name) {
    std::vector<std::string> words = simplify;
    words.push_back(name);
    return shell(words);
  };
  const Ran ran = with(stage);
  CHECK(ran.code == 0);
  CHECK(has(ran.err, stage + " is kept"));
  CHECK(shell({"replay", stage, "--ratio", "0.5"}).code == 0);
  const std::string other = shell.path("t");
  CHECK(with(other).code == 0);
  CHECK_FALSE(fs::exists(other));
}

TEST_CASE("what cannot be a file to write is refused before the work") {
  Shell shell;
  const std::string cube = shell.cube();
  const std::string pipe = shell.path("pipe.ply");
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  const std::string link = shell.path("link.ply");
  fs::create_symlink("elsewhere.ply", link);
  for (const std::string& output : {std::string(), std::string("-x.ply"), pipe, link}) {
    CAPTURE(output);
    const Ran ran = shell({"simplify", cube, "-o", output, "--ratio", "0.5"});
    CHECK(ran.code != 0);
    CHECK(lines(ran.err) == 1);
    CHECK_FALSE(fs::exists(output + ".stage"));
  }
  CHECK(fs::is_symlink(link));
  const Ran file = shell({"replay", cube, "--ratio", "0.5"});
  CHECK(file.code == 1);
  CHECK(has(file.err, "Not a directory"));
}

TEST_CASE("an input that turns out to be unfit leaves no stage that was not there") {
  Shell shell;
  // The header is valid, but a vertex is not.
  const std::string bad =
      shell.file("bad.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                 "property float z\nend_header\n0 word 0\n");
  const std::string output = shell.path("o.ply");
  const std::string stage = shell.path("s");
  CHECK(shell({"simplify", bad, "-o", output, "--ratio", "1"}).code == 1);
  CHECK_FALSE(fs::exists(output + ".stage"));
  CHECK(shell({"cut", bad, "--stage", stage}).code == 1);
  CHECK_FALSE(fs::exists(stage));
  CHECK(shell({"cut", shell.cube(), "--stage", stage, "--cut", "farm"}).code == 2);  // it is ascii
  CHECK_FALSE(fs::exists(stage));
  // A folder that existed before belongs to somebody.
  fs::create_directory(stage);
  shell.file("s/mine.txt", "x");
  CHECK(shell({"cut", bad, "--stage", stage}).code == 1);
  CHECK(fs::exists(stage + "/mine.txt"));
}

TEST_CASE("a map of distances goes to a format that has a place for them") {
  Shell shell;
  const std::string cube = shell.cube();
  const std::string map = shell.path("map.stl");
  const Ran ran = shell({"compare", cube, cube, "--map", map});
  CHECK(ran.code == 2);
  CHECK(lines(ran.err) == 1);
  CHECK(has(ran.err, "--map " + map + ": this format has no place for distances"));
  CHECK_FALSE(fs::exists(map));
  CHECK(shell({"compare", cube, cube, "--map", shell.path("map.obj")}).code == 0);
}
