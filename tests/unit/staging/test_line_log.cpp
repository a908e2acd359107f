// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <doctest/doctest.h>

#include <meshfarm/staging/line_log.hpp>
#include <meshfarm/util/file.hpp>
#include <meshfarm/util/log.hpp>

#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

/// Whether the file's content becomes `text` within ten seconds.
bool comes_to_hold(const std::filesystem::path& path, const std::string& text) {
  for (int i = 0; i < 1000; ++i) {
    if (std::filesystem::exists(path) && read_file(path) == text) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

}  // namespace

TEST_CASE("lines are there at the latest when their log is gone, in order") {
  test::TempFolder folder;
  const auto path = folder / "log" / "lines";  // the folder is created
  std::string expected;
  {
    LineLog log(path);
    for (int i = 0; i < 1000; ++i) {
      log.add("line " + std::to_string(i));
      expected += "line " + std::to_string(i) + "\n";
    }
  }
  CHECK(read_file(path) == expected);
}

TEST_CASE("others see the lines while the log grows") {
  test::TempFolder folder;
  LineLog log(folder / "lines");
  log.add("one");
  CHECK(comes_to_hold(folder / "lines", "one\n"));
  log.add("two");
  CHECK(comes_to_hold(folder / "lines", "one\ntwo\n"));
}

TEST_CASE("a log that cannot be written holds nobody up") {
  test::TempFolder folder;
  std::ofstream(folder / "lines") << "another's";
  set_log("test", LogLevel::off);
  {
    LineLog log(folder / "lines");
    log.add("one");
  }
  set_log("test", LogLevel::info);
  CHECK(read_file(folder / "lines") == "another's");
}

TEST_CASE("a log goes on after an error, and nothing is missing or there twice") {
  test::TempFolder folder;
  const auto path = folder / "lines";
  std::ofstream(path) << "another's";
  set_log("test", LogLevel::off);
  LineLog log(path);
  log.add("one");
  std::this_thread::sleep_for(std::chrono::milliseconds(800));  // it has failed by now
  log.add("two");
  std::filesystem::remove(path);
  CHECK(comes_to_hold(path, "one\ntwo\n"));
  log.add("three");
  CHECK(comes_to_hold(path, "one\ntwo\nthree\n"));
  set_log("test", LogLevel::info);
}

TEST_CASE("a log without lines makes no file") {
  test::TempFolder folder;
  { const LineLog log(folder / "lines"); }
  CHECK_FALSE(std::filesystem::exists(folder / "lines"));
}
