// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The n-th file call (write, read, create, rename, remove) of worker, sink or ventilator fails, is
// cut short, or kills the process (support/fault_shim.cpp). Each run must end, or stop with one
// clear line and be resumable, with the same bytes. MESHFARM_FAULTS=all tries every n with every
// kind of fault. The default, to be quick, tries the first and sometimes a later n, with fewer
// kinds.
#include <cstdlib>
#include <utility>

#include <doctest/doctest.h>

#include "support/farm_bench.hpp"
#include "support/process.hpp"

using meshfarm::test::FarmBench;
using meshfarm::test::Ran;
namespace fs = std::filesystem;

namespace {

/// A small mesh, a stage cut from it, and the options of its runs.
class Bench : public FarmBench {
 public:
  Bench(const std::string& triangles, const std::vector<std::string>& how_cut,
        std::vector<std::string> how_run)
      : FarmBench(triangles), cut_(cut(how_cut)), how_run_(std::move(how_run)) {
    fs::copy(cut_, path("quiet"), fs::copy_options::recursive);
    expect(replay("quiet", "quiet.ply"), path("quiet.ply"));
  }

  std::vector<std::string> replay_words(const std::string& stage, const std::string& output) {
    std::vector<std::string> words = {"replay", path(stage), "-o", path(output)};
    words.insert(words.end(), how_run_.begin(), how_run_.end());
    return words;
  }
  Ran replay(const std::string& stage, const std::string& output) {
    return meshfarm(replay_words(stage, output));
  }
  /// A fresh stage, with all its files below path("run").
  void fresh() {
    fs::remove_all(path("run"));
    fs::create_directories(path("run"));
    fs::copy(cut_, path("run/stage"), fs::copy_options::recursive);
    fs::remove(path("fired"));
  }

 private:
  std::string cut_;
  std::vector<std::string> how_run_;
};

Bench& parts() {
  static Bench instance("20000", {"--parts", "3"}, {"--workers", "2", "--ratio", "0.05"});
  return instance;
}

/// Streams whose swept results are larger than a writer's buffer.
Bench& streams() {
  static Bench instance("200000", {"--scheme", "stream", "--parts", "2", "--window", "10000"},
                        {"--workers", "1", "--ratio", "0.9"});
  return instance;
}

/// The first run does the cut, and finishes in pieces: it surveys, counts, scatters, climbs,
/// splits, reduces and measures, and streams the pieces into the output.
Bench& farmed() {
  static Bench instance(
      "20000", {"--parts", "3", "--cut", "farm", "--blocks", "2"},
      {"--workers", "2", "--ratio", "0.3", "--finish", "farm", "--composition", "sink"});
  return instance;
}

bool all_of_them() {
  const char* wish = std::getenv("MESHFARM_FAULTS");
  return wish != nullptr && std::string(wish) == "all";
}

/// Sets the environment of the processes started during its lifetime.
class Injection {
 public:
  Injection(const Bench& bench, const std::string& role, const std::string& fault) {
    set("LD_PRELOAD", MESHFARM_FAULT_SHIM);
    set("MESHFARM_FAULT", fault);
    set("MESHFARM_FAULT_ROLE", role);
    set("MESHFARM_FAULT_BELOW", bench.path("run"));
    set("MESHFARM_FAULT_FIRED", bench.path("fired"));
  }
  /// The disk is full while the file `full_while` exists.
  Injection(const std::string& below, const std::string& full_while) {
    set("LD_PRELOAD", MESHFARM_FAULT_SHIM);
    set("MESHFARM_FAULT_BELOW", below);
    set("MESHFARM_FAULT_WHILE", full_while);
  }
  ~Injection() {
    for (const std::string& name : names_) ::unsetenv(name.c_str());
  }

 private:
  void set(const std::string& name, const std::string& value) {
    ::setenv(name.c_str(), value.c_str(), 1);
    names_.push_back(name);
  }
  std::vector<std::string> names_;
};

std::size_t errors_in(const std::string& text) {
  std::size_t count = 0;
  for (std::size_t at = text.find(": error: "); at != std::string::npos;) {
    ++count;
    at = text.find(": error: ", at + 1);
  }
  return count;
}

/// Runs with the fault. False if the fault did not strike because there are fewer calls than `nth`.
bool survives(Bench& bench, const std::string& role, const std::string& call,
              const std::string& kind, int nth) {
  const std::string fault = call + ":" + kind + ":" + std::to_string(nth);
  CAPTURE(role);
  CAPTURE(fault);
  bench.fresh();
  Ran ran;
  {
    const Injection injection(bench, role, fault);
    ran = bench.replay("run/stage", "run/out.ply");
  }
  CAPTURE(ran.code);
  CAPTURE(ran.err);
  if (ran.code == 0) {
    bench.check_result(bench.path("run/out.ply"));
  } else {
    CHECK((ran.code == 1 || ran.code == 3));
    CHECK(errors_in(ran.err) == 1);
    CHECK_FALSE(fs::exists(bench.path("run/out.ply")));
    const bool full = kind == "ENOSPC" || kind == "EDQUOT";
    if (full) CHECK(ran.code == 3);  // the fault came before there was a run that could wait
    const Ran again = bench.replay("run/stage", "run/out.ply");
    CAPTURE(again.err);
    CHECK(again.code == 0);
    bench.check_result(bench.path("run/out.ply"));
  }
  return fs::exists(bench.path("fired"));
}

/// A full disk costs seconds: the quick mode tries it on few calls only.
std::vector<std::string> kinds_of(const std::string& call) {
  std::vector<std::string> kinds = {"kill", "EIO"};
  if (call == "read") kinds.insert(kinds.end(), {"ESTALE", "short"});
  if (call == "write") kinds.emplace_back("short");
  if (call == "rename" || call == "link" || call == "unlink") kinds.emplace_back("lost");
  const bool makes = call != "read" && call != "unlink";
  if (makes && (all_of_them() || call == "fsync")) kinds.emplace_back("ENOSPC");
  if (!all_of_them() && call == "fsync") std::erase(kinds, "EIO");
  return kinds;
}

/// The number of faults that struck.
int try_all(Bench& bench, const std::string& role) {
  int struck = 0;
  for (const std::string call :
       {"write", "fsync", "close", "rename", "link", "open", "read", "unlink", "fdatasync"}) {
    const std::vector<std::string> kinds = kinds_of(call);
    for (const std::string& kind : kinds) {
      const int step = all_of_them() ? 1 : 2;
      const bool seldom = call == "link" || call == "open" || call == "read" || call == "unlink";
      const int most = all_of_them() ? 400 : seldom ? 1 : 3;
      for (int nth = 1; nth <= most && survives(bench, role, call, kind, nth); nth += step)
        ++struck;
    }
  }
  MESSAGE(role, ": ", struck, " faults");
  return struck;
}

}  // namespace

TEST_CASE("a worker's files may fail at any call") {
  CHECK(try_all(parts(), "worker") >= 12);
}

TEST_CASE("the sink's files may fail at any call") {
  CHECK(try_all(parts(), "sink") >= 12);
}

TEST_CASE("the ventilator's files may fail at any call") {
  CHECK(try_all(parts(), "ventilator") >= 12);
}

TEST_CASE("a run that is cut and finished by jobs survives a fault at any call") {
  if (all_of_them()) {
    for (const char* role : {"worker", "sink", "ventilator"}) CHECK(try_all(farmed(), role) >= 12);
    return;
  }
  CHECK(survives(farmed(), "worker", "rename", "kill", 5));
  CHECK(survives(farmed(), "worker", "write", "EIO", 9));
  CHECK(survives(farmed(), "sink", "write", "kill", 6));
  CHECK(survives(farmed(), "sink", "rename", "lost", 1));
  CHECK(survives(farmed(), "ventilator", "write", "kill", 3));
}

TEST_CASE("a journal that cannot be written any more stops the run for now, in one line") {
  Bench& bench = parts();
  bench.fresh();
  const std::string stage = bench.path("run/stage");
  meshfarm::test::Process run = bench.start(
      {"run", stage, "--ratio", "0.05", "-o", bench.path("run/out.ply"), "--bind", "127.0.0.1"});
  REQUIRE(meshfarm::test::wait_until([&] {
    return bench.meshfarm({"status", stage}).out.find("waiting for workers") != std::string::npos;
  }));
  fs::rename(stage + "/journal", stage + "/journal-away");
  std::ofstream(stage + "/journal") << "no folder";
  meshfarm::test::Process worker = bench.start({"worker", stage});
  CHECK(run.wait() == 3);
  CAPTURE(run.err());
  CHECK(errors_in(run.err()) == 1);
  CHECK(run.err().find("run the same command again") != std::string::npos);
  fs::remove(stage + "/journal");
  fs::rename(stage + "/journal-away", stage + "/journal");
  CHECK(bench.replay("run/stage", "run/out.ply").code == 0);
  bench.check_result(bench.path("run/out.ply"));
}

TEST_CASE("a ventilator that fails before a sink was told says why") {
  Bench& bench = parts();
  bench.fresh();
  const std::string stage = bench.path("run/stage");
  REQUIRE(bench.replay("run/stage", "run/out.ply").code == 0);
  for (const auto& entry : fs::directory_iterator(stage + "/control")) {
    if (entry.path().extension() == ".keys") std::ofstream(entry.path()) << "damaged";
  }
  const Ran ran = bench.meshfarm({"ventilator", stage, "--ratio", "0.05", "--supervised"});
  CHECK(ran.code == 1);
  CHECK(errors_in(ran.err) == 1);
}

TEST_CASE("a disk that is full for a while is waited for, and status says so") {
  Bench& bench = parts();
  bench.fresh();
  const std::string full = bench.path("full");
  std::string where = "run/stage/results";
  std::string phase = "no room on the stage, waiting";
  SUBCASE("for results") {}
  SUBCASE("for the journal") {
    where = "run/stage/journal";
  }
  SUBCASE("for the result of it all") {
    where = "run/.out.ply";
    phase = "no room for the result, waiting";
  }
  std::ofstream(full) << "x";
  const Injection injection(bench.path(where), full);
  meshfarm::test::Process run = bench.start(bench.replay_words("run/stage", "run/out.ply"));
  const bool waits = meshfarm::test::wait_until([&] {
    return bench.meshfarm({"status", bench.path("run/stage")}).out.find(phase) != std::string::npos;
  });
  fs::remove(full);
  CHECK(waits);
  CHECK(run.wait() == 0);
  CAPTURE(run.err());
  CHECK(errors_in(run.err()) == 0);
  CHECK(run.err().find("run the same command again") == std::string::npos);  // it went on by itself
  bench.check_result(bench.path("run/out.ply"));
}

TEST_CASE("status compares no two hosts' clocks") {
  Bench& bench = parts();
  for (const char* ahead : {"-3600", "3600"}) {
    CAPTURE(ahead);
    bench.fresh();
    const std::string stage = bench.path("run/stage");
    ::setenv("LD_PRELOAD", MESHFARM_FAULT_SHIM, 1);
    ::setenv("MESHFARM_FAULT_CLOCK_S", ahead, 1);
    meshfarm::test::Process ventilator =
        bench.start({"ventilator", stage, "--ratio", "0.05", "--bind", "127.0.0.1"});
    ::unsetenv("LD_PRELOAD");
    ::unsetenv("MESHFARM_FAULT_CLOCK_S");
    const auto says = [&](const char* words) {
      return bench.meshfarm({"status", stage}).out.find(words) != std::string::npos;
    };
    const auto waits = [&] { return says("waiting for the sink"); };
    CHECK(meshfarm::test::wait_until(waits, 10));
    ventilator.signal(SIGKILL);
    CHECK(ventilator.wait() == -SIGKILL);
    CHECK(says("waiting for the sink"));  // it was alive a moment ago
    const auto gone = [&] { return says("no word from the ventilator for 1"); };
    CHECK(meshfarm::test::wait_until(gone, 30));
  }
}

TEST_CASE("by --no-wait a full disk ends the run for now") {
  Bench& bench = parts();
  for (const char* where : {"run/stage/results", "run/stage/journal", "run/.out.ply"}) {
    CAPTURE(where);
    bench.fresh();
    const std::string full = bench.path("full");
    std::ofstream(full) << "x";
    std::vector<std::string> words = bench.replay_words("run/stage", "run/out.ply");
    words.emplace_back("--no-wait");
    {
      const Injection injection(bench.path(where), full);
      const Ran ran = bench.meshfarm(words);
      CAPTURE(ran.err);
      CHECK(ran.code == 3);
      CHECK(ran.err.find("make room") != std::string::npos);
      CHECK(errors_in(ran.err) == 1);
    }
    fs::remove(full);
    CHECK(bench.meshfarm(words).code == 0);
    bench.check_result(bench.path("run/out.ply"));
  }
}

TEST_CASE("a disk that fails while the input is read is one line that names it, and exit 1") {
  Bench& bench = parts();
  bench.fresh();
  const std::string input = bench.path("run/input.ply");
  fs::copy(bench.mesh(), input);
  const std::vector<std::vector<std::string>> commands = {
      {"info", input},
      {"compare", bench.mesh(), input},
      {"cut", input, "--stage", bench.path("of-input")},
      {"cut", input, "--scheme", "stream", "--stage", bench.path("of-input")},
      {"simplify", input, "-o", bench.path("run/out.ply"), "--ratio", "0.1"}};
  for (const std::vector<std::string>& words : commands) {
    int nth = 1;
    for (bool struck = true; struck; ++nth) {
      CAPTURE(words[0]);
      CAPTURE(nth);
      fs::remove_all(bench.path("of-input"));
      fs::remove(bench.path("fired"));
      Ran ran;
      {
        const Injection injection(bench, words[0], "pread:EIO:" + std::to_string(nth));
        ::setenv("MESHFARM_FAULT_BELOW", input.c_str(), 1);
        ran = bench.meshfarm(words);
      }
      CAPTURE(ran.err);
      struck = fs::exists(bench.path("fired"));
      CHECK(ran.code == (struck ? 1 : 0));
      CHECK(errors_in(ran.err) == (struck ? 1 : 0));
      CHECK((ran.err.find(input + ": Input/output error") != std::string::npos) == struck);
      CHECK(fs::exists(bench.path("of-input/manifest")) == (!struck && words[0] == "cut"));
    }
    CHECK(nth > 4);  // faults in the header, the vertices and the triangles
  }
}

TEST_CASE("a worker whose file system hangs is left behind") {
  CHECK(survives(parts(), "worker", "write", "hang", 1));
  CHECK(survives(parts(), "worker", "fsync", "hang", 2));
}

TEST_CASE("a worker may fail at any piece of what it writes while it sweeps") {
  // A sample's result is one write each; the pieces of the swept results follow.
  for (const char* kind : {"ENOSPC", "kill", "short"}) {
    for (const int nth : {3, 4, 6}) CHECK(survives(streams(), "worker", "write", kind, nth));
  }
  CHECK(survives(streams(), "worker", "rename", "kill", 4));
}

TEST_CASE("a part that kills every worker is given up with its reason, the rest is kept") {
  const std::string stage = parts().path("run/stage");
  parts().fresh();
  const std::string poison = "write:kill:1";
  Ran ran;
  {
    const Injection injection(parts(), "worker", poison);
    ::setenv("MESHFARM_FAULT_FIRED", "", 1);                            // strikes on every attempt
    ::setenv("MESHFARM_FAULT_BELOW", (stage + "/results").c_str(), 1);  // only once there are jobs
    ran = parts().replay("run/stage", "run/out.ply");
  }
  CAPTURE(ran.err);
  CHECK(ran.code == 3);
  CHECK(ran.err.find("failed for good") != std::string::npos);
  CHECK(errors_in(ran.err) == 1);
  CHECK(parts().replay("run/stage", "run/out.ply").code == 0);
  parts().check_result(parts().path("run/out.ply"));
}
