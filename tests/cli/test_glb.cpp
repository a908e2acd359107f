// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// GLB files written by the commands.
#include <doctest/doctest.h>

#include "support/process.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm::test;

TEST_CASE("a GLB is compressed, but with --plain") {
  const TempFolder folder;
  const auto path = [&](const std::string& name) { return (folder.path() / name).string(); };
  const auto run = [&](const std::vector<std::string>& words) {
    return run_meshfarm(words, path("log")).code;
  };
  REQUIRE(run({"generate", "-o", path("t.ply"), "--triangles", "20000"}) == 0);
  REQUIRE(run({"cut", path("t.ply"), "--stage", path("stage")}) == 0);
  const std::vector<std::vector<std::string>> commands = {
      {"convert", path("t.ply"), path("convert.glb")},
      {"simplify", path("t.ply"), "-o", path("simplify.glb"), "--ratio", "0.5"},
      {"replay", path("stage"), "-o", path("replay.glb"), "--ratio", "0.5"}};
  for (std::vector<std::string> words : commands) {
    CAPTURE(words[0]);
    const auto made = [&] {
      CHECK(run(words) == 0);
      return read_text(path(words[0] + ".glb"));
    };
    const auto is_compressed = [](const std::string& bytes) {
      return bytes.find("EXT_meshopt_compression") != std::string::npos;
    };
    const std::string compressed = made();
    CHECK(is_compressed(compressed));
    CHECK((made() == compressed));
    words.emplace_back("--plain");
    const std::string plain = made();
    CHECK_FALSE(is_compressed(plain));
    CHECK(compressed.size() < plain.size() * 3 / 4);
  }
}
