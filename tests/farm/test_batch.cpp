// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Batches of many files with one crew of workers. A file that fails does not stop the others, and
// the same command resumes the batch.
#include <doctest/doctest.h>

#include "support/process.hpp"
#include "support/temp_folder.hpp"

using meshfarm::test::Process;
using meshfarm::test::Ran;
using meshfarm::test::read_text;
using meshfarm::test::run_meshfarm;
using meshfarm::test::TempFolder;
namespace fs = std::filesystem;

namespace {

/// Meshes of several sizes, and the result of simplifying each by itself.
class Bench {
 public:
  Bench() {
    for (const char* triangles : {"20000", "100000", "40000"}) {
      const std::string input = path("mesh" + std::string(triangles) + ".ply");
      REQUIRE(meshfarm({"generate", "-o", input, "--triangles", triangles}).code == 0);
      REQUIRE(meshfarm({"simplify", input, "-o", input + ".expected.ply", "--ratio", "0.1"}).code ==
              0);
      inputs.push_back(input);
    }
  }

  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string next_log() { return path("log" + std::to_string(++logs_)); }
  Ran meshfarm(const std::vector<std::string>& words) { return run_meshfarm(words, next_log()); }
  std::vector<std::string> words(const std::vector<std::string>& files,
                                 const std::string& output) const {
    std::vector<std::string> all = {"batch", "-o",        path(output), "--ratio",
                                    "0.1",   "--workers", "2"};
    all.insert(all.end(), files.begin(), files.end());
    return all;
  }
  void check_results(const std::string& output) const {
    for (const std::string& input : inputs) {
      const fs::path result = fs::path(path(output)) / fs::path(input).filename();
      CAPTURE(result.string());
      CHECK((read_text(result) == read_text(input + ".expected.ply")));
    }
  }

  std::vector<std::string> inputs;

 private:
  TempFolder folder_;
  int logs_ = 0;
};

Bench& bench() {
  static Bench instance;
  return instance;
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("each file of a batch becomes what it would by itself; what fails stops no other") {
  const std::string bad = bench().path("bad.ply");
  std::ofstream(bad) << "no mesh";
  std::vector<std::string> files = bench().inputs;
  files.insert(files.begin() + 1, {bad, bench().path("absent.ply")});
  const Ran ran = bench().meshfarm(bench().words(files, "out"));
  CAPTURE(ran.out);
  CAPTURE(ran.err);
  CHECK(ran.code == 1);
  bench().check_results("out");
  CHECK(has(ran.out, "100,000 to 10,000 triangles, rms "));
  CHECK(has(ran.out, "bad.ply: " + bad + ": unknown format"));
  CHECK(has(ran.out, "absent.ply: No such file"));
  CHECK(has(ran.out, "5 files: 3 done, 2 failed"));

  // The same command again: finished files are not redone, failed ones are retried.
  const auto written = fs::last_write_time(fs::path(bench().path("out")) / "mesh20000.ply");
  fs::copy_file(bench().inputs[0], bad, fs::copy_options::overwrite_existing);
  files.pop_back();
  files.erase(files.begin() + 2);
  const Ran again = bench().meshfarm(bench().words(files, "out"));
  CAPTURE(again.out);
  CHECK(again.code == 0);
  CHECK(fs::last_write_time(fs::path(bench().path("out")) / "mesh20000.ply") == written);
  CHECK(fs::exists(fs::path(bench().path("out")) / "bad.ply"));
  CHECK(has(again.out, "1 done, 2 done before"));

  // For another target nothing has been done yet.
  std::vector<std::string> words = bench().words({bench().inputs[0]}, "out");
  words[4] = "0.2";
  words.emplace_back("--json");
  const Ran other = bench().meshfarm(words);
  CHECK(other.code == 0);
  CHECK(has(other.out, "\"state\": \"done\""));
  CHECK(has(other.out, "\"triangles\": 4000"));
}

TEST_CASE("a batch that is stopped, or loses workers, goes on") {
  Process batch(bench().words(bench().inputs, "stopped"), bench().next_log());
  const auto first_done = [&] {
    return fs::exists(fs::path(bench().path("stopped")) / ".batch/mesh20000.ply.done");
  };
  CHECK(meshfarm::test::wait_until(first_done));
  const std::string self = std::to_string(batch.pid());
  std::ifstream children("/proc/" + self + "/task/" + self + "/children");
  pid_t worker = 0;
  children >> worker;  // the crew is started first
  REQUIRE(worker > 0);
  ::kill(worker, SIGKILL);
  const Ran second = bench().meshfarm(bench().words(bench().inputs, "stopped"));
  const bool refused = second.code == 1 && has(second.err, "another batch is at work");
  batch.signal(SIGTERM);
  const int code = batch.wait();
  CHECK((code == 3 || code == 0));
  CHECK((refused || code == 0));
  const Ran again = bench().meshfarm(bench().words(bench().inputs, "stopped"));
  CAPTURE(again.err);
  CHECK(again.code == 0);
  CHECK(has(again.out, "done before"));
  bench().check_results("stopped");
  for (const auto& entry : fs::directory_iterator(fs::path(bench().path("stopped")) / ".batch")) {
    CHECK(entry.path().extension() != ".stage");
  }
}

TEST_CASE("files that would become one, or be written over, are refused") {
  const std::string mesh = bench().inputs[0];
  const std::string twin = bench().path("twin");
  fs::create_directory(twin);
  const Ran same = bench().meshfarm(
      bench().words({mesh, twin + "/" + fs::path(mesh).filename().string() + ".gz"}, "o"));
  CHECK(same.code == 2);
  CHECK(has(same.err, "would both become"));
  const Ran over = bench().meshfarm(
      {"batch", mesh, "-o", fs::path(mesh).parent_path().string(), "--ratio", "0.1"});
  CHECK(over.code == 2);
  CHECK(bench().meshfarm({"batch", mesh, "--ratio", "0.1"}).code == 2);
}

TEST_CASE("the results of a batch are in the formats of the files, or PLY") {
  const std::string mesh = bench().inputs[0];
  const std::string obj = bench().path("mesh20000.obj");
  REQUIRE(bench().meshfarm({"convert", mesh, obj}).code == 0);
  const std::string glb = bench().path("mesh20000.glb");
  REQUIRE(bench().meshfarm({"convert", mesh, glb, "--plain"}).code == 0);
  const std::string other = bench().path("other.mesh");
  fs::copy_file(mesh, other);
  std::vector<std::string> words = bench().words({mesh, obj, glb, other}, "formats");
  words.emplace_back("--plain");
  const Ran ran = bench().meshfarm(words);
  CAPTURE(ran.err);
  CHECK(ran.code == 0);
  const std::string expected = read_text(mesh + ".expected.ply");
  const fs::path results = bench().path("formats");
  CHECK((read_text(results / "mesh20000.ply") == expected));
  CHECK((read_text(results / "other.ply") == expected));
  const std::string back = bench().path("back.ply");
  for (const char* name : {"mesh20000.obj", "mesh20000.glb"}) {
    REQUIRE(bench().meshfarm({"convert", (results / name).string(), back}).code == 0);
    CHECK((read_text(back) == expected));
  }
  // Compressed GLB is a different result.
  const auto plain_bytes = fs::file_size(results / "mesh20000.glb");
  words.pop_back();
  CHECK(bench().meshfarm(words).code == 0);
  CHECK(fs::file_size(results / "mesh20000.glb") < plain_bytes * 3 / 4);
}
