// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Whole runs whose input is cut by the farm. Killed at every stage, they end with the same bytes as
// after a cut by one process.
#include <fstream>

#include <doctest/doctest.h>

#include "support/farm_bench.hpp"
#include "support/process.hpp"

using meshfarm::test::FarmBench;
using meshfarm::test::Process;
using meshfarm::test::Ran;
using meshfarm::test::results_in;
using meshfarm::test::wait_for_results;
namespace fs = std::filesystem;

namespace {

/// A mesh of 100,000 triangles in 12 parts, and the result of a run that cut here.
class Bench : public FarmBench {
 public:
  Bench() : FarmBench("100000") {
    const std::string output = path("expected.ply");
    expect(meshfarm(simplify(output, "2", {"--cut", "here"})), output);
  }

  std::vector<std::string> simplify(const std::string& output, const std::string& workers,
                                    const std::vector<std::string>& more) const {
    std::vector<std::string> words = {"simplify", mesh(),    "-o", output,      "--ratio",
                                      "0.02",     "--parts", "12", "--workers", workers};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  /// A stage whose first run does the cut: 5 x 4 jobs and the partition come before the 12 parts.
  std::string planned() { return cut({"--cut", "farm", "--blocks", "5", "--parts", "12"}); }
  std::vector<std::string> replay(const std::string& stage, const std::string& workers) const {
    return {"replay", stage, "-o", stage + ".ply", "--ratio", "0.02", "--workers", workers};
  }
};

constexpr std::size_t k_jobs_of_cut = 21;

Bench& bench() {
  static Bench instance;
  return instance;
}

}  // namespace

TEST_CASE("a cut by the farm: any number of workers and blocks make the bytes of a cut here") {
  struct Case {
    const char* workers;
    const char* blocks;
  };
  for (const Case& each : {Case{"1", "17"}, Case{"2", "1"}, Case{"5", "3"}}) {
    CAPTURE(each.blocks);
    const std::string output = bench().path("farmed.ply");
    fs::remove(output);
    const Ran ran = bench().meshfarm(
        bench().simplify(output, each.workers, {"--cut", "farm", "--blocks", each.blocks}));
    CHECK(ran.code == 0);
    CHECK(ran.out.find("parts            12, stitched to") != std::string::npos);
    bench().check_result(output);
    CHECK_FALSE(fs::exists(output + ".stage"));
  }
}

TEST_CASE("a cut by the farm: of hundreds of parts, and of more than a message can name") {
  for (const char* parts : {"400", "2600"}) {
    CAPTURE(parts);
    const auto simplify = [&](const std::string& output, const char* place) {
      return bench().meshfarm({"simplify", bench().mesh(), "-o", output, "--ratio", "0.02",
                               "--parts", parts, "--workers", "2", "--cut", place});
    };
    const std::string here = bench().path("here.ply");
    const std::string farmed = bench().path("farmed.ply");
    CHECK(simplify(here, "here").code == 0);
    CHECK(simplify(farmed, "farm").code == 0);
    CHECK(meshfarm::test::read_text(farmed) == meshfarm::test::read_text(here));
  }
}

TEST_CASE("a cut by the farm: parts are simplified to a bound on the error as if they were kept") {
  const auto simplify = [&](const std::vector<std::string>& more) {
    const std::string output = bench().path("bound.ply");
    fs::remove(output);
    std::vector<std::string> words = {"simplify", bench().mesh(), "-o",      output, "--error",
                                      "0.2%",     "--certify",    "--parts", "12",   "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Ran ran = bench().meshfarm(words);
    CHECK(ran.code == 0);
    CHECK(ran.out.find("\"kind\": \"certified\"") != std::string::npos);
    return meshfarm::test::read_text(output);
  };
  for (const char* finish : {"here", "farm"}) {
    CAPTURE(finish);
    const std::string here = simplify({"--cut", "here", "--finish", finish, "--workers", "2"});
    CHECK(here.size() > 1000);
    CHECK(here.size() < 300'000);
    for (const char* workers : {"1", "5"}) {
      CHECK(simplify({"--cut", "farm", "--finish", finish, "--workers", workers, "--blocks",
                      "3"}) == here);
    }
  }
}

TEST_CASE("a cut by the farm: killed at every stage, a run goes on, and cuts only once") {
  const std::string stage = bench().planned();
  // During the survey, counting cells, scattering vertices and triangles, climbing parts, and at
  // the end.
  for (const std::size_t results : {2, 7, 11, 13, 18, 24, 32}) {
    Process run = bench().start(bench().replay(stage, "1"));
    REQUIRE(wait_for_results(stage, results));
    run.signal(SIGKILL);  // its children end with it
    CHECK(run.wait() == -SIGKILL);
    CHECK_FALSE(fs::exists(stage + ".ply"));
  }
  CHECK(bench().meshfarm(bench().replay(stage, "2")).code == 0);
  bench().check_result(stage + ".ply");

  // For another target the parts are climbed again, and the boundary is joined from their results.
  const std::size_t before = results_in(stage);
  CHECK(before >= k_jobs_of_cut + 12 + 2);
  const std::vector<std::string> other = {"replay",         stage,     "-o",
                                          stage + ".5.ply", "--ratio", "0.05"};
  CHECK(bench().meshfarm(other).code == 0);
  CHECK(results_in(stage) <= before + 12 + 2);
}

TEST_CASE("a cut by the farm: what parts are built of is damaged, and made again") {
  const std::string stage = bench().planned();
  Process run = bench().start(bench().replay(stage, "1"));
  REQUIRE(wait_for_results(stage, k_jobs_of_cut + 2));
  run.signal(SIGKILL);
  CHECK(run.wait() == -SIGKILL);
  std::uintmax_t damaged = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(stage) / "results")) {
    // Only bundles are this large: a new sink only looks at them, and leaves reading to their
    // readers.
    if (entry.file_size() < 256 * 1024) continue;
    std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
    for (std::uintmax_t at = 1000; at < entry.file_size(); at += 5000) {
      file.seekp(static_cast<std::streamoff>(at));
      file.put('\x55');
    }
    if (++damaged == 3) break;
  }
  REQUIRE(damaged == 3);
  const Ran ran = bench().meshfarm(bench().replay(stage, "2"));
  CHECK(ran.code == 0);
  bench().check_result(stage + ".ply");
}

TEST_CASE("a cut by the farm: workers and sinks killed cost nothing but time") {
  const std::string stage = bench().planned();
  const auto sink = [&] {
    return bench().start(
        {"sink", stage, "--ratio", "0.02", "--bind", "127.0.0.1", "-o", stage + ".ply"});
  };
  Process ventilator = bench().start(
      {"ventilator", stage, "--ratio", "0.02", "--bind", "127.0.0.1", "--heartbeat-ms", "150"});
  Process first_sink = sink();
  Process killed = bench().start({"worker", stage});
  REQUIRE(wait_for_results(stage, 3));
  killed.signal(SIGKILL);
  CHECK(killed.wait() == -SIGKILL);
  Process heir = bench().start({"worker", stage});
  REQUIRE(wait_for_results(stage, 14));
  first_sink.signal(SIGKILL);
  CHECK(first_sink.wait() == -SIGKILL);
  Process second_sink = sink();
  CHECK(second_sink.wait() == 0);
  CHECK(ventilator.wait() == 0);
  CHECK(heir.wait() == 0);
  bench().check_result(stage + ".ply");
}

TEST_CASE("a cut by the farm: an input that is changed before it is cut is named") {
  const std::string stage = bench().path("changed.stage");
  const std::string mesh = bench().path("changed.ply");
  fs::copy_file(bench().mesh(), mesh);
  REQUIRE(bench().meshfarm({"cut", mesh, "--stage", stage, "--cut", "farm"}).code == 0);
  std::ofstream(mesh, std::ios::app) << "more";
  const Ran ran = bench().meshfarm(bench().replay(stage, "1"));
  CHECK(ran.code == 1);
  CHECK(ran.err.find("changed.ply: was changed since the cut was begun") != std::string::npos);
  CHECK_FALSE(fs::exists(stage + ".ply"));
}

TEST_CASE("a cut by the farm: what it cannot read or keep is one line, and no stage is left") {
  const auto refused = [&](const std::vector<std::string>& words, const char* why) {
    const Ran ran = bench().meshfarm(words);
    CHECK(ran.code == 2);
    CHECK(ran.err.find(why) != std::string::npos);
  };
  const std::string off = bench().path("mesh.off");
  REQUIRE(bench().meshfarm({"generate", "-o", off, "--triangles", "1000"}).code == 0);
  refused({"simplify", off, "-o", off + ".ply", "--ratio", "0.5", "--cut", "farm"},
          "cannot be cut by the farm: it is no plain binary PLY file of triangles");
  const std::string shown = bench().path("shown.ply");
  refused({"simplify", bench().mesh(), "-o", shown, "--ratio", "0.5", "--cut", "farm", "--report",
           shown + ".html"},
          "use --cut here");
  CHECK_FALSE(fs::exists(shown + ".stage"));
  const std::string stage = bench().planned();
  const Ran status = bench().meshfarm({"status", stage});
  CHECK(status.code == 0);
  CHECK(status.out.find("none yet; the first run will cut the mesh") != std::string::npos);
}
