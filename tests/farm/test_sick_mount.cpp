// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// One process's mount of the stage is sick for a while, while the others' mounts are fine
// (support/fault_shim.cpp): nothing below a folder can be found, opened or read. Files that are
// known to exist are waited for, nobody is blamed, and the bytes are the same.
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/farm_bench.hpp"
#include "support/process.hpp"

namespace meshfarm::test {
namespace {

namespace fs = std::filesystem;

/// The environment of the processes started during its lifetime.
class Environment {
 public:
  Environment(std::vector<std::pair<std::string, std::string>> variables)
      : variables_(std::move(variables)) {
    variables_.emplace_back("LD_PRELOAD", MESHFARM_FAULT_SHIM);
    for (const auto& [name, value] : variables_) ::setenv(name.c_str(), value.c_str(), 1);
  }
  ~Environment() {
    for (const auto& [name, value] : variables_) ::unsetenv(name.c_str());
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  std::vector<std::pair<std::string, std::string>> variables_;
};

class Bench : public FarmBench {
 public:
  Bench() : FarmBench("40000"), stage_(cut({"--parts", "8"})) {
    const std::string quiet = path("quiet.ply");
    expect(meshfarm(replay_words(quiet)), quiet);
    std::ofstream(sick()) << "x";
  }

  const std::string& stage() const { return stage_; }
  std::string sick() const { return path("sick"); }
  std::vector<std::string> replay_words(const std::string& output) const {
    return {"replay", stage_, "-o", output, "--workers", "1", "--ratio", "0.05"};
  }
  Process start_as(const std::string& host, const std::vector<std::string>& words,
                   std::vector<std::pair<std::string, std::string>> more = {}) {
    more.emplace_back("MESHFARM_FAULT_HOST", host);
    const Environment environment(more);
    return start(words);
  }

 private:
  std::string stage_;
};

std::size_t count_of(const std::string& text, const std::string& word) {
  std::size_t count = 0;
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

/// The text of all traces of a stage.
std::string traces_of(const std::string& stage) {
  std::string all;
  for (const auto& entry : fs::directory_iterator(stage + "/log")) {
    if (entry.path().extension() == ".trace") all += read_text(entry.path());
  }
  return all;
}

TEST_CASE("a sink that starts while its mount is sick makes nothing again that its journal knows") {
  Bench bench;
  const std::size_t done = count_of(traces_of(bench.stage()), "\"kind\":\"done\"");
  REQUIRE(done >= 8);
  std::string below;
  SUBCASE("of the whole stage") {}
  SUBCASE("of the journal") {
    below = "/journal";
  }
  SUBCASE("of the results") {
    below = "/results";
  }
  CAPTURE(below);
  const std::string output = bench.path("again.ply");
  const Environment environment({{"MESHFARM_FAULT_ROLE", "sink"},
                                 {"MESHFARM_FAULT_BELOW", bench.stage() + below},
                                 {"MESHFARM_FAULT_SICK", bench.sick()}});
  Process run = bench.start(bench.replay_words(output));
  std::this_thread::sleep_for(std::chrono::seconds(5));
  CHECK_FALSE(fs::exists(output));
  fs::remove(bench.sick());
  CHECK(run.wait() == 0);
  CAPTURE(run.err());
  bench.check_result(output);
  CHECK(count_of(traces_of(bench.stage()), "\"kind\":\"done\"") == done);
}

TEST_CASE("a worker whose mount is sick holds nobody up") {
  Bench bench;
  const std::string output = bench.path("out.ply");
  std::vector<std::string> words = bench.replay_words(output);
  words.back() = "0.06";
  const std::string quiet = bench.path("quiet6.ply");
  const std::string copy = bench.path("copy");
  fs::copy(bench.stage(), copy, fs::copy_options::recursive);
  words[1] = copy;
  words[3] = quiet;
  REQUIRE(bench.meshfarm(words).code == 0);

  Process worker = bench.start_as(
      "sick", {"worker", bench.stage()},
      {{"MESHFARM_FAULT_BELOW", bench.stage() + "/parts"}, {"MESHFARM_FAULT_SICK", bench.sick()}});
  Process run = bench.start_as("well", {"run", bench.stage(), "--ratio", "0.06", "-o", output,
                                        "--bind", "127.0.0.1", "--hang-seconds", "2"});
  REQUIRE(wait_until(
      [&] { return traces_of(bench.stage()).find("\"host\":\"sick\"") != std::string::npos; }));
  Process other = bench.start_as("well", {"worker", bench.stage()});
  CHECK(run.wait() == 0);
  CAPTURE(run.err());
  CHECK(read_text(output) == read_text(quiet));
  CHECK(other.wait() == 0);
  CHECK(worker.wait() == 0);
}

TEST_CASE("a sink whose mount stays sick asks a second reader, and the file's host is not blamed") {
  Bench bench;
  const std::string output = bench.path("out.ply");
  const std::string stage = bench.stage();
  // No results exist yet for this target.
  const std::string quiet = bench.path("quiet7.ply");
  const std::string copy = bench.path("copy");
  fs::copy(stage, copy, fs::copy_options::recursive);
  REQUIRE(bench.meshfarm({"replay", copy, "-o", quiet, "--ratio", "0.07"}).code == 0);

  Process ventilator =
      bench.start_as("server", {"ventilator", stage, "--ratio", "0.07", "--bind", "127.0.0.1"});
  // A worker with too little memory for any job: it only reads for the sink.
  Process reader = bench.start_as("reader", {"worker", stage, "--memory", "1K"},
                                  {{"MESHFARM_FAULT", "read:short:1"},
                                   {"MESHFARM_FAULT_BELOW", stage + "/results"},
                                   {"MESHFARM_FAULT_FIRED", bench.path("has_read")}});
  Process worker = bench.start_as("writer", {"worker", stage});
  const auto begin = std::chrono::steady_clock::now();
  Process sink = bench.start_as(
      "server", {"sink", stage, "--ratio", "0.07", "-o", output, "--bind", "127.0.0.1"},
      {{"MESHFARM_FAULT_BELOW", stage + "/results"}, {"MESHFARM_FAULT_SICK", bench.sick()}});
  // The sink's mount stays sick for longer than a reader's patience.
  CHECK(wait_until([&] { return fs::exists(bench.path("has_read")); }, 150));
  CHECK(std::chrono::steady_clock::now() - begin > std::chrono::seconds(60));
  fs::remove(bench.sick());
  CHECK(sink.wait() == 0);
  CHECK(ventilator.wait() == 0);
  CAPTURE(sink.err());
  CAPTURE(ventilator.err());
  CHECK(read_text(output) == read_text(quiet));
  CHECK(sink.err().find("Stale file handle") != std::string::npos);
  const std::string trace = traces_of(stage);
  CHECK(count_of(trace, "\"kind\":\"failed\"") >= 1);
  CHECK(worker.wait() == 0);
  CHECK(reader.wait() == 0);
}

}  // namespace
}  // namespace meshfarm::test
