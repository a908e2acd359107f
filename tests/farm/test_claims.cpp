// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Two commands that want to make the same output or stage.
#include <string>

#include <doctest/doctest.h>

#include "support/farm_bench.hpp"
#include "support/process.hpp"

namespace meshfarm::test {
namespace {

namespace fs = std::filesystem;

struct Bench : FarmBench {
  explicit Bench(const std::string& triangles) : FarmBench(triangles) {}
  using FarmBench::cut;
};

bool has_claim(const std::string& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored)) {
    if (entry.path().extension() == ".claim") return true;
  }
  return false;
}

TEST_CASE("of two commands on one output the second says who is at work, at once") {
  Bench bench("2000");
  const std::string stage = bench.cut({"--parts", "2"});
  fs::create_directory(bench.path("out"));
  const std::string output = bench.path("out/o.ply");
  const std::vector<std::string> words = {"run", stage,  "--ratio", "0.1",
                                          "-o",  output, "--bind",  "127.0.0.1"};
  Process first = bench.start(words);  // without a worker, so it waits
  REQUIRE(wait_until([&] { return has_claim(bench.path("out")); }));
  Process second = bench.start(words);
  CHECK(second.wait(20) == 1);
  CHECK(second.err().find(output + ": is being made") != std::string::npos);
  CHECK(second.err().find(std::to_string(first.pid())) != std::string::npos);
  Process worker = bench.start({"worker", stage});
  CHECK(first.wait() == 0);
  CHECK(worker.wait() == 0);
  CHECK(fs::exists(output));
  CHECK_FALSE(has_claim(bench.path("out")));
}

TEST_CASE("of two cuts into one stage the second says who is at work, and harms nothing") {
  Bench bench("1000000");
  const std::string stage = bench.path("stage");
  const std::vector<std::string> words = {"cut", bench.mesh(), "--stage", stage, "--parts", "4"};
  Process first = bench.start(words);
  REQUIRE(wait_until([&] { return has_claim(stage); }));
  first.signal(SIGSTOP);
  REQUIRE_FALSE(fs::exists(stage + "/manifest"));
  Process second = bench.start(words);
  CHECK(second.wait(20) == 1);
  CAPTURE(second.err());
  CHECK(second.err().find(std::to_string(first.pid())) != std::string::npos);
  first.signal(SIGCONT);
  CHECK(first.wait() == 0);
  CHECK(
      bench.meshfarm({"replay", stage, "--ratio", "0.01", "-o", bench.path("o.ply"), "-q"}).code ==
      0);
}

}  // namespace
}  // namespace meshfarm::test
