// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Every n-th write, fsync, close and rename of worker, sink and ventilator fails, is cut short, or
// is the process's last deed (support/fault_shim.cpp). Each run must end, or stop with one clear
// line and be taken up again, with the same bytes. MESHFARM_FAULTS=all tries every n with every
// kind of fault; else the first and a later n of each, and kills, for a quick answer.
#include <algorithm>
#include <cstdlib>
#include <map>

#include <doctest/doctest.h>

#include "support/process.hpp"
#include "support/temp_folder.hpp"

using meshfarm::test::Ran;
using meshfarm::test::read_text;
using meshfarm::test::run_meshfarm;
using meshfarm::test::TempFolder;
namespace fs = std::filesystem;

namespace {

class Bench {
 public:
  Bench() {
    REQUIRE(meshfarm({"generate", "-o", path("mesh.ply"), "--triangles", "20000"}).code == 0);
    REQUIRE(meshfarm({"cut", path("mesh.ply"), "--stage", path("cut"), "--parts", "3"}).code == 0);
    fs::copy(path("cut"), path("quiet"), fs::copy_options::recursive);
    REQUIRE(replay("quiet", "quiet.ply").code == 0);
    expected_["cut"] = read_text(path("quiet.ply"));
    REQUIRE(expected().size() > 1000);
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  const std::string& expected() const { return expected_.at(stage_); }
  Ran meshfarm(std::vector<std::string> words) {
    return run_meshfarm(words, path("log" + std::to_string(++logs_)));
  }
  Ran replay(const std::string& stage, const std::string& output) {
    std::vector<std::string> words = {"replay", path(stage), "-o", path(output)};
    const bool streams = stage_ == "streams";
    words.insert(words.end(),
                 {"--workers", streams ? "1" : "2", "--ratio", streams ? "0.9" : "0.05"});
    return meshfarm(words);
  }
  /// From now on runs are of streams, whose swept results are larger than a writer's buffer.
  void use_streams() {
    stage_ = "streams";
    if (expected_.contains(stage_)) return;
    REQUIRE(meshfarm({"generate", "-o", path("long.ply"), "--triangles", "200000"}).code == 0);
    REQUIRE(meshfarm({"cut", path("long.ply"), "--stage", path(stage_), "--scheme", "stream",
                      "--parts", "2", "--window", "10000"})
                .code == 0);
    fs::copy(path(stage_), path("swept"), fs::copy_options::recursive);
    REQUIRE(replay("swept", "swept.ply").code == 0);
    expected_[stage_] = read_text(path("swept.ply"));
  }
  void use_parts() { stage_ = "cut"; }
  /// A fresh stage, all whose files are below path("run").
  void fresh() {
    fs::remove_all(path("run"));
    fs::create_directories(path("run"));
    fs::copy(path(stage_), path("run/stage"), fs::copy_options::recursive);
    fs::remove(path("fired"));
  }

 private:
  TempFolder folder_;
  std::string stage_ = "cut";
  std::map<std::string, std::string> expected_;  // by stage
  int logs_ = 0;
};

Bench& bench() {
  static Bench instance;
  return instance;
}

bool all_of_them() {
  const char* wish = std::getenv("MESHFARM_FAULTS");
  return wish != nullptr && std::string(wish) == "all";
}

/// Sets the environment of the processes that are started meanwhile.
class Injection {
 public:
  Injection(const std::string& role, const std::string& fault) {
    set("LD_PRELOAD", MESHFARM_FAULT_SHIM);
    set("MESHFARM_FAULT", fault);
    set("MESHFARM_FAULT_ROLE", role);
    set("MESHFARM_FAULT_BELOW", bench().path("run"));
    set("MESHFARM_FAULT_FIRED", bench().path("fired"));
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

/// Runs with the fault. False if it did not strike, as there are fewer calls than that.
bool survives(const std::string& role, const std::string& call, const std::string& kind, int nth) {
  const std::string fault = call + ":" + kind + ":" + std::to_string(nth);
  CAPTURE(role);
  CAPTURE(fault);
  bench().fresh();
  Ran ran;
  {
    const Injection injection(role, fault);
    ran = bench().replay("run/stage", "run/out.ply");
  }
  CAPTURE(ran.code);
  CAPTURE(ran.err);
  if (ran.code == 0) {
    CHECK(read_text(bench().path("run/out.ply")) == bench().expected());
  } else {
    CHECK((ran.code == 1 || ran.code == 3));
    CHECK(errors_in(ran.err) == 1);
    CHECK_FALSE(fs::exists(bench().path("run/out.ply")));
    const bool full = kind == "ENOSPC" || kind == "EDQUOT";
    if (full) CHECK(ran.code == 3);
    const Ran again = bench().replay("run/stage", "run/out.ply");
    CAPTURE(again.err);
    CHECK(again.code == 0);
    CHECK(read_text(bench().path("run/out.ply")) == bench().expected());
  }
  return fs::exists(bench().path("fired"));
}

void try_all(const std::string& role) {
  int struck = 0;
  for (const std::string call : {"write", "fsync", "close", "rename"}) {
    std::vector<std::string> kinds = {"ENOSPC", "EIO", "kill"};
    if (call == "write") kinds.push_back("short");
    if (call == "rename") kinds.push_back("lost");
    if (!all_of_them()) kinds.erase(kinds.begin() + (call == "fsync" ? 1 : 0));
    for (const std::string& kind : kinds) {
      const int step = all_of_them() ? 1 : 2;
      const int most = all_of_them() ? 100 : 3;
      for (int nth = 1; nth <= most && survives(role, call, kind, nth); nth += step) ++struck;
    }
  }
  MESSAGE(role, ": ", struck, " faults");
  CHECK(struck >= 12);
}

}  // namespace

TEST_CASE("a worker's files may fail at any call") {
  try_all("worker");
}

TEST_CASE("the sink's files may fail at any call") {
  try_all("sink");
}

TEST_CASE("the ventilator's files may fail at any call") {
  try_all("ventilator");
}

TEST_CASE("a worker whose file system hangs is left behind") {
  CHECK(survives("worker", "write", "hang", 1));
  CHECK(survives("worker", "fsync", "hang", 2));
}

TEST_CASE("a worker may fail at any piece of what it writes while it sweeps") {
  bench().use_streams();
  // A sample's result is one write each; then come the pieces of the swept ones.
  for (const char* kind : {"ENOSPC", "kill", "short"}) {
    for (const int nth : {3, 4, 6}) CHECK(survives("worker", "write", kind, nth));
  }
  CHECK(survives("worker", "rename", "kill", 4));
  bench().use_parts();
}

TEST_CASE("a part that kills every worker is given up with its reason, the rest is kept") {
  const std::string stage = bench().path("run/stage");
  bench().fresh();
  const std::string poison = "write:kill:1";
  Ran ran;
  {
    const Injection injection("worker", poison);
    ::setenv("MESHFARM_FAULT_FIRED", "", 1);  // it strikes again and again
    ::setenv("MESHFARM_FAULT_BELOW", (stage + "/results").c_str(), 1);  // once there is a job
    ran = bench().replay("run/stage", "run/out.ply");
  }
  CAPTURE(ran.err);
  CHECK(ran.code == 3);
  CHECK(ran.err.find("failed for good") != std::string::npos);
  CHECK(errors_in(ran.err) == 1);
  CHECK(bench().replay("run/stage", "run/out.ply").code == 0);
  CHECK(read_text(bench().path("run/out.ply")) == bench().expected());
}
