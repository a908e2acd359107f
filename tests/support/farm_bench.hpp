// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include <doctest/doctest.h>

#include "support/process.hpp"
#include "support/temp_folder.hpp"

namespace meshfarm::test {

/// A folder with a generated mesh, processes that work on it, and the result of an undisturbed run,
/// whose bytes every other run must reproduce.
class FarmBench {
 public:
  explicit FarmBench(const std::string& triangles) {
    REQUIRE(meshfarm({"generate", "-o", mesh(), "--triangles", triangles}).code == 0);
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string mesh() const { return path("mesh.ply"); }
  const std::string& expected() const { return expected_; }
  Ran meshfarm(const std::vector<std::string>& words) { return run_meshfarm(words, next_log()); }
  Process start(const std::vector<std::string>& words) { return Process(words, next_log()); }
  void check_result(const std::string& output) const { CHECK(read_text(output) == expected_); }

 protected:
  /// Makes the result of a run, which must have succeeded, the expected one.
  void expect(const Ran& ran, const std::string& output) {
    REQUIRE(ran.code == 0);
    expected_ = read_text(output);
    REQUIRE(expected_.size() > 1000);
  }
  /// A new stage, cut with these options.
  std::string cut(const std::vector<std::string>& how) {
    const std::string stage = path("stage" + std::to_string(++stages_));
    std::vector<std::string> words = {"cut", mesh(), "--stage", stage};
    words.insert(words.end(), how.begin(), how.end());
    REQUIRE(meshfarm(words).code == 0);
    return stage;
  }

 private:
  std::string next_log() { return path("log" + std::to_string(++logs_)); }

  TempFolder folder_;
  std::string expected_;
  int logs_ = 0;
  int stages_ = 0;
};

/// The number of published files in a stage's results.
inline std::size_t results_in(const std::string& stage) {
  std::error_code ignored;
  std::size_t count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(stage) / "results", ignored)) {
    count += entry.path().filename().string().front() != '.';
  }
  return count;
}

inline bool wait_for_results(const std::string& stage, std::size_t count) {
  return wait_until([&] { return results_in(stage) >= count; });
}

}  // namespace meshfarm::test
