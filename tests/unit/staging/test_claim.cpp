// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <meshfarm/staging/claim.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/temp_folder.hpp"

namespace meshfarm {
namespace {

std::vector<std::string> words_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::string> words;
  for (std::string word; file >> word;) words.push_back(word);
  return words;
}

void write_words(const std::filesystem::path& path, const std::vector<std::string>& words) {
  std::ofstream file(path);
  for (const std::string& word : words) file << word << ' ';
}

TEST_CASE("of two who claim one thing the second hears who has it") {
  const test::TempFolder folder;
  const auto file = claim_of(folder / "out.ply");
  {
    const Claim mine(file, "out.ply: is being made");
    CHECK_THROWS_WITH_AS(Claim(file, "out.ply: is being made"),
                         doctest::Contains(("process " + std::to_string(::getpid())).c_str()),
                         DataError);
    CHECK(std::filesystem::exists(file));
  }
  CHECK_FALSE(std::filesystem::exists(file));
  CHECK_NOTHROW(Claim(file, ""));
}

TEST_CASE("a claim of the dead is taken over, one of whom we cannot see is not") {
  const test::TempFolder folder;
  const auto file = folder / "claim";
  std::vector<std::string> words;
  {
    const Claim mine(file, "");
    words = words_of(file);
  }
  REQUIRE(words.size() == 6);
  SUBCASE("a process that ended") {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(0);
    ::waitpid(child, nullptr, 0);
    words[3] = std::to_string(child);
    write_words(file, words);
    CHECK_NOTHROW(Claim(file, ""));
  }
  SUBCASE("another process has its number now") {
    words[4] = "1";
    write_words(file, words);
    CHECK_NOTHROW(Claim(file, ""));
  }
  SUBCASE("a host that was started again since") {
    words[1] = "7";
    words[5] = "1";
    write_words(file, words);
    CHECK_NOTHROW(Claim(file, ""));
  }
  SUBCASE("another host") {
    words[0] = "elsewhere";
    words[1] = "7";
    write_words(file, words);
    CHECK_THROWS_WITH_AS(Claim(file, "x"), doctest::Contains("on host elsewhere"), DataError);
  }
  SUBCASE("another container of this host, where the number means another process") {
    words[2] = "pid:[1]";
    words[4] = "1";
    write_words(file, words);
    CHECK_THROWS_AS(Claim(file, "x"), DataError);
  }
}

TEST_CASE("a claim that has become another's is not removed") {
  const test::TempFolder folder;
  const auto file = folder / "claim";
  {
    const Claim mine(file, "");
    write_words(file, {"elsewhere", "7", "pid:[1]", "2", "3", "4"});
  }
  CHECK(std::filesystem::exists(file));
}

}  // namespace
}  // namespace meshfarm
