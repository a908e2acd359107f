// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include <meshfarm/pipeline/benchmark.hpp>

#include "support/temp_folder.hpp"

namespace meshfarm::test {
namespace {

TEST_CASE("the benchmark ends within a second and gives a speed that can be") {
  const std::uint64_t speed = measure_speed();
  CHECK(speed > 1'000);  // under sanitizers, on a busy machine
  CHECK(speed < 1'000'000'000);
}

TEST_CASE("a speed is remembered under its key only") {
  const TempFolder folder;
  CHECK(remembered_speed(folder / "cache", "a") == 0);
  remember_speed(folder / "cache", "a", 123);
  remember_speed(folder / "cache", "b", 456);
  CHECK(remembered_speed(folder / "cache", "a") == 123);
  CHECK(remembered_speed(folder / "cache", "b") == 456);
  remember_speed(folder / "cache", "a", 789);
  CHECK(remembered_speed(folder / "cache", "a") == 789);
  CHECK(remembered_speed(folder / "cache", "c") == 0);
}

TEST_CASE("in haste nothing is measured, and what is remembered counts") {
  const TempFolder folder;
  const char* old = std::getenv("XDG_CACHE_HOME");
  const std::string kept = old == nullptr ? "" : old;
  ::setenv("XDG_CACHE_HOME", folder.path().c_str(), 1);
  const std::uint64_t usual = speed_of_this_host("test", Haste::great);
  CHECK(usual > 0);
  CHECK(std::filesystem::is_empty(folder.path()));
  remember_speed(speed_folder(), speed_key("test"), usual + 1);
  CHECK(speed_of_this_host("test", Haste::great) == usual + 1);
  CHECK(speed_of_this_host("test") == usual + 1);
  old == nullptr ? ::unsetenv("XDG_CACHE_HOME") : ::setenv("XDG_CACHE_HOME", kept.c_str(), 1);
}

TEST_CASE("a damaged memory, or none, is no speed and no error") {
  const TempFolder folder;
  remember_speed({}, "a", 1);
  CHECK(remembered_speed({}, "a") == 0);
  remember_speed(folder.path(), "a", 123);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    std::ofstream(entry.path()) << "a\nfast\n";
  }
  CHECK(remembered_speed(folder.path(), "a") == 0);
  std::ofstream(folder / "file") << "x";
  remember_speed(folder / "file", "a", 1);  // no folder can be made there
  CHECK(remembered_speed(folder / "file", "a") == 0);
}

TEST_CASE("versions have speeds of their own") {
  CHECK(speed_key("1.0") == speed_key("1.0"));
  CHECK(speed_key("1.0") != speed_key("1.1"));
}

}  // namespace
}  // namespace meshfarm::test
