// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The command that draws pictures: its options and messages.
#include <filesystem>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/shell.hpp"

using meshfarm::test::has;
using meshfarm::test::lines;
using meshfarm::test::Ran;
using meshfarm::test::read_text;
using meshfarm::test::Shell;
namespace fs = std::filesystem;

TEST_CASE("render writes a PNG of the size and the view that are asked for") {
  Shell shell;
  const std::string mesh = shell.path("torus.ply");
  REQUIRE(shell({"generate", "-o", mesh, "--triangles", "2000", "-q"}).code == 0);
  const auto picture = [&](std::vector<std::string> more) {
    const std::string to = shell.path("a.png");
    more.insert(more.begin(), {"render", mesh, "-o", to, "--size", "120x80"});
    const Ran ran = shell(more);
    CHECK_MESSAGE(ran.code == 0, ran.err);
    CHECK(ran.out.empty());
    CHECK(has(ran.err, "a.png: 2000 triangles"));
    return read_text(to);
  };
  const std::string first = picture({});
  CHECK(first.substr(1, 3) == "PNG");
  CHECK(first[19] == 120);
  CHECK(first[23] == 80);
  CHECK(picture({"--view", "45,35.264", "--threads", "3", "--memory", "1M"}) == first);
  for (const std::vector<std::string>& more :
       std::vector<std::vector<std::string>>{{"--view", "top"},
                                             {"--view", "-30,-20"},
                                             {"--up", "z"},
                                             {"--projection", "orthographic"},
                                             {"--samples", "1"},
                                             {"--wire"},
                                             {"--background", "20242c"},
                                             {"--background", "transparent"},
                                             {"--colour-by", "normal"},
                                             {"--colour-by", "piece"},
                                             {"--colour-by", "height"},
                                             {"--colour-by", "height", "--range", "-3:3"}}) {
    CAPTURE(more.back());
    CHECK(picture(more) != first);
  }
}

TEST_CASE("render refuses bad input in a line, and bad options as such") {
  Shell shell;
  const std::string mesh = shell.file(
      "m.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const std::string points =
      shell.file("points.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                 "property float z\nend_header\n0 0 0\n");
  const std::string to = shell.path("a.png");
  const auto refuse = [&](std::vector<std::string> words, int code, const std::string& why) {
    words.insert(words.begin(), "render");
    CAPTURE(words.back());
    const Ran ran = shell(words);
    CHECK(ran.code == code);
    CHECK(lines(ran.err) == 1);
    CHECK_MESSAGE(has(ran.err, why), ran.err);
    CHECK_FALSE(fs::exists(to));
  };
  refuse({shell.path("none.ply"), "-o", to}, 1, "none.ply");
  refuse({points, "-o", to}, 1, "points.ply: has no triangles to draw");
  refuse({mesh, "-o", to, "--colour-by", "colour"}, 1, "m.ply: has no colours");
  refuse({mesh, "-o", to, "--colour-by", "heat"}, 1, "has no channel 'heat'");
  refuse({mesh, "-o", shell.path("none") + "/a.png"}, 1, "none");
  refuse({mesh}, 2, "output");
  refuse({mesh, "-o", shell.path("a.jpg")}, 2, "must end with .png");
  for (const auto& [option, word] :
       std::vector<std::pair<std::string, std::string>>{{"--view", "above"},
                                                        {"--view", "10"},
                                                        {"--view", "10,91"},
                                                        {"--up", "w"},
                                                        {"--projection", "fisheye"},
                                                        {"--size", "1600"},
                                                        {"--size", "0x10"},
                                                        {"--size", "20000x100"},
                                                        {"--samples", "0"},
                                                        {"--samples", "9"},
                                                        {"--background", "pink"},
                                                        {"--range", "1:2"},
                                                        {"--memory", "0"}}) {
    refuse({mesh, "-o", to, option, word}, 2, option);
  }
  refuse({mesh, "-o", to, "--colour-by", "height", "--range", "2:1"}, 2, "--range");
  refuse({mesh, "-o", to, "--size", "4000x4000", "--memory", "64M"}, 2, "takes --memory");
}

TEST_CASE("a stage is drawn by its parts, however it was divided") {
  Shell shell;
  const std::string mesh = shell.path("torus.ply");
  REQUIRE(shell({"generate", "-o", mesh, "--triangles", "2000", "-q"}).code == 0);
  const std::string to = shell.path("a.png");
  const auto drawn = [&](std::vector<std::string> cut, std::vector<std::string> more) {
    const std::string stage = shell.path("s.stage");
    fs::remove_all(stage);
    cut.insert(cut.begin(), {"cut", mesh, "--stage", stage, "-q", "--parts", "4"});
    REQUIRE(shell(cut).code == 0);
    more.insert(more.begin(), {"render", stage, "-o", to, "--size", "120x80"});
    const Ran ran = shell(more);
    CHECK_MESSAGE(ran.code == 0, ran.err);
    return std::pair(read_text(to), ran.err);
  };
  const auto [parts, said] = drawn({}, {});
  CHECK(has(said, "2000 triangles, coloured by part (4)"));
  CHECK(drawn({}, {"--colour-by", "part", "--threads", "3"}).first == parts);
  REQUIRE(shell({"render", mesh, "-o", to, "--size", "120x80"}).code == 0);
  const std::string whole = read_text(to);
  CHECK(whole != parts);
  for (const std::vector<std::string>& cut :
       std::vector<std::vector<std::string>>{{},
                                             {"--scheme", "stream", "--sort", "here"},
                                             {"--scheme", "stream", "--sort", "farm"}}) {
    CHECK(drawn(cut, {"--colour-by", "none"}).first == whole);
  }
  const Ran by_height = shell({"render", shell.path("s.stage"), "-o", to, "--colour-by", "height"});
  CHECK(by_height.code != 0);
  CHECK(has(by_height.err, "a stage is coloured by part, normal or none"));
  const Ran no_stage = shell({"render", mesh, "-o", to, "--colour-by", "part"});
  CHECK(no_stage.code == 1);
  CHECK(has(no_stage.err, "is no stage, and has no parts"));
}
