// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The stream scheme with the real program's processes. The farm itself is tested harder with the
// cut; these tests are about the streams, their jobs and their damage.
#include <fstream>

#include <doctest/doctest.h>

#include <meshfarm/io/stream_file.hpp>

#include "support/farm_bench.hpp"
#include "support/process.hpp"

using meshfarm::test::FarmBench;
using meshfarm::test::Process;
using meshfarm::test::Ran;
using meshfarm::test::read_text;
using meshfarm::test::results_in;
using meshfarm::test::wait_for_results;
namespace fs = std::filesystem;

namespace {

/// A mesh of 300,000 triangles, and the result of an undisturbed run: 6 streams, each swept.
class Bench : public FarmBench {
 public:
  Bench() : FarmBench("300000") {
    const std::string output = path("expected.ply");
    expect(meshfarm(simplify(output, "2")), output);
  }

  std::vector<std::string> simplify(const std::string& output, const std::string& workers) const {
    return {"simplify", mesh(),    "-o", output,     "--ratio", "0.02",      "--scheme",
            "stream",   "--parts", "6",  "--window", "20000",   "--workers", workers};
  }
  std::string streams() { return cut({"--scheme", "stream", "--parts", "6", "--window", "20000"}); }
  /// The same, but sorted by the farm.
  std::string slabs() {
    return cut({"--scheme", "stream", "--sort", "farm", "--parts", "6", "--window", "20000"});
  }
  Ran replay(const std::string& stage) {
    return meshfarm({"replay", stage, "-o", stage + ".ply", "--ratio", "0.02", "--workers", "2"});
  }
};

/// The number of files in a stage's folder that hold a stream.
std::size_t streams_in(const std::string& stage, const char* folder) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(stage) / folder)) {
    const std::string text = read_text(entry.path().string());
    count += entry.path().extension() != ".tmp" && meshfarm::is_stream(text);
  }
  return count;
}

Bench& bench() {
  static Bench instance;
  return instance;
}

void check_whole_run(const std::string& workers, const std::vector<std::string>& more) {
  CAPTURE(workers);
  const std::string output = bench().path("whole.ply");
  fs::remove(output);
  std::vector<std::string> words = bench().simplify(output, workers);
  words.insert(words.end(), more.begin(), more.end());
  const Ran ran = bench().meshfarm(words);
  CHECK(ran.code == 0);
  CHECK(ran.out.find("streams          6, stitched to") != std::string::npos);
  bench().check_result(output);
  CHECK_FALSE(fs::exists(output + ".stage"));
}

}  // namespace

TEST_CASE("streams: 1 and 5 workers make the same bytes as 2") {
  for (const char* workers : {"1", "5"}) check_whole_run(workers, {});
}

TEST_CASE("streams: killed while samples are climbed and while streams are swept, a run goes on") {
  const std::string stage = bench().streams();
  for (const std::size_t results : {2, 7, 10}) {
    Process run =
        bench().start({"replay", stage, "-o", stage + ".ply", "--ratio", "0.02", "--workers", "1"});
    REQUIRE(wait_for_results(stage, results));
    run.signal(SIGKILL);  // its children end with it
    CHECK(run.wait() == -SIGKILL);
    CHECK_FALSE(fs::exists(stage + ".ply"));
  }
  CHECK(bench().replay(stage).code == 0);
  bench().check_result(stage + ".ply");
}

TEST_CASE("streams: a worker killed in a sweep costs nothing but time") {
  const std::string stage = bench().streams();
  Process run =
      bench().start({"run", stage, "--ratio", "0.02", "-o", stage + ".ply", "--bind", "127.0.0.1"});
  Process killed = bench().start({"worker", stage});
  REQUIRE(wait_for_results(stage, 7));
  killed.signal(SIGKILL);
  CHECK(killed.wait() == -SIGKILL);
  Process heir = bench().start({"worker", stage});
  CHECK(run.wait() == 0);
  CHECK(heir.wait() == 0);
  bench().check_result(stage + ".ply");
}

TEST_CASE("streams: composed as a tree, by any number of workers and through kills") {
  const auto composed = [](const std::string& stage, const std::string& workers) {
    return std::vector<std::string>{"replay", stage,       "-o",    stage + ".ply",  "--ratio",
                                    "0.02",   "--workers", workers, "--composition", "tree"};
  };
  const std::string first = bench().streams();
  REQUIRE(bench().meshfarm(composed(first, "2")).code == 0);
  CHECK(results_in(first) >= 6 + 6 + 2);  // the six are joined to at most two
  const std::string expected = read_text(first + ".ply");
  CHECK(expected.size() == bench().expected().size());
  for (const char* workers : {"1", "5"}) {
    const std::string stage = bench().streams();
    CHECK(bench().meshfarm(composed(stage, workers)).code == 0);
    CHECK(read_text(stage + ".ply") == expected);
  }
  const std::string stage = bench().streams();
  for (const std::size_t results : {11, 12, 13}) {
    Process run = bench().start(composed(stage, "1"));
    REQUIRE(wait_for_results(stage, results));
    run.signal(SIGKILL);
    run.wait();
  }
  CHECK(bench().meshfarm(composed(stage, "2")).code == 0);
  CHECK(read_text(stage + ".ply") == expected);
}

TEST_CASE("streams: sorted by the farm, by any number of workers, the result is the same") {
  for (const char* workers : {"1", "2", "5"}) check_whole_run(workers, {"--sort", "farm"});
}

TEST_CASE("streams: killed while the farm sorts and samples, a run goes on, and sorts only once") {
  const std::string stage = bench().slabs();
  CHECK(streams_in(stage, "streams") == 0);
  for (const std::size_t results : {1, 4, 8, 11, 14, 20}) {
    Process run =
        bench().start({"replay", stage, "-o", stage + ".ply", "--ratio", "0.02", "--workers", "1"});
    REQUIRE(wait_for_results(stage, results));
    run.signal(SIGKILL);  // its children end with it
    CHECK(run.wait() == -SIGKILL);
    CHECK_FALSE(fs::exists(stage + ".ply"));
  }
  CHECK(bench().replay(stage).code == 0);
  bench().check_result(stage + ".ply");

  const std::size_t sorted = streams_in(stage, "results");
  CHECK(sorted >= 6);
  const std::vector<std::string> other = {"replay",         stage,     "-o",
                                          stage + ".5.ply", "--ratio", "0.05"};
  CHECK(bench().meshfarm(other).code == 0);
  // Outputs of second attempts may have been removed since; none may have been added.
  CHECK(streams_in(stage, "results") <= sorted);
}

TEST_CASE("streams: a worker killed as it sorts costs nothing but time") {
  const std::string stage = bench().slabs();
  Process run =
      bench().start({"run", stage, "--ratio", "0.02", "-o", stage + ".ply", "--bind", "127.0.0.1"});
  Process killed = bench().start({"worker", stage});
  REQUIRE(wait_for_results(stage, 2));
  killed.signal(SIGKILL);
  CHECK(killed.wait() == -SIGKILL);
  Process heir = bench().start({"worker", stage});
  Process other = bench().start({"worker", stage});
  CHECK(run.wait() == 0);
  CHECK(heir.wait() == 0);
  CHECK(other.wait() == 0);
  bench().check_result(stage + ".ply");
}

TEST_CASE("streams: what is damaged before it is sorted is named, and nothing is written") {
  const std::string stage = bench().slabs();
  std::fstream file(fs::path(stage) / "streams" / "000003.slab",
                    std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(300'000);
  file.put('\x55');
  file.close();
  const Ran ran = bench().replay(stage);
  CHECK(ran.code == 1);
  CHECK(ran.err.find("000003.slab") != std::string::npos);
  CHECK_FALSE(fs::exists(stage + ".ply"));
}

TEST_CASE("streams: a flipped byte or a cut is named with its place, and nothing is written") {
  for (const bool cut_short : {false, true}) {
    CAPTURE(cut_short);
    const std::string stage = bench().streams();
    const fs::path stream = fs::path(stage) / "streams" / "000003.stream";
    if (cut_short) {
      fs::resize_file(stream, fs::file_size(stream) - 1);
    } else {
      std::fstream file(stream, std::ios::in | std::ios::out | std::ios::binary);
      file.seekp(300'000);
      file.put('\x55');
    }
    const Ran ran = bench().replay(stage);
    CHECK(ran.code == 1);
    CHECK(ran.err.find("error: 1 job failed for good: ") != std::string::npos);
    CHECK(ran.err.find("000003.stream") != std::string::npos);
    CHECK_FALSE(fs::exists(stage + ".ply"));
  }
}

TEST_CASE("a bound is kept inside of large triangles, too") {
  const std::string foam = bench().path("foam.ply");
  REQUIRE(
      bench().meshfarm({"generate", "--shape", "foam", "--triangles", "60000", "-o", foam}).code ==
      0);
  const Ran ran = bench().meshfarm({"simplify", foam, "-o", bench().path("bounded.ply"), "--scheme",
                                    "stream", "--error", "2%", "--json"});
  CHECK(ran.code == 0);
  const auto told = [&](const char* name, std::size_t from) {
    const std::string key = std::string("\"") + name + "\": ";
    return std::stod(ran.out.substr(ran.out.find(key, from) + key.size()));
  };
  CHECK(told("max", ran.out.find("\"error\": {")) < 1.12 * 0.02);
  CHECK(told("triangles", ran.out.find("\"output\": {")) < 2000);
}

TEST_CASE("streams: info tells what a stream holds, and names the place of damage") {
  const std::string stage = bench().streams();
  const std::string stream = (fs::path(stage) / "streams" / "000001.stream").string();
  const Ran ran = bench().meshfarm({"info", stream, "--json"});
  CHECK(ran.code == 0);
  CHECK(ran.out.find("\"format\": \"meshfarm stream\"") != std::string::npos);
  CHECK(ran.out.find("\"widest_front\": ") != std::string::npos);
  fs::resize_file(stream, fs::file_size(stream) - 1);
  const Ran damaged = bench().meshfarm({"info", stream});
  CHECK(damaged.code == 1);
  CHECK(damaged.err == "meshfarm info: error: " + stream + ": cut short at byte " +
                           std::to_string(fs::file_size(stream)) + "\n");
}

TEST_CASE("streams: a shuffled input makes the same streams, and the same result") {
  const std::string shuffled = bench().path("shuffled.ply");
  REQUIRE(
      bench().meshfarm({"generate", "-o", shuffled, "--shuffle", "--from", bench().mesh()}).code ==
      0);
  CHECK(read_text(shuffled) != read_text(bench().mesh()));
  const std::string output = bench().path("from-shuffled.ply");
  std::vector<std::string> words = bench().simplify(output, "2");
  words[1] = shuffled;
  CHECK(bench().meshfarm(words).code == 0);
  bench().check_result(output);
}
