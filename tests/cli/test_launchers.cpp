// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The launchers, and what they ask the program for. tests/lab runs them on real hosts.
#include <cstdlib>

#include <doctest/doctest.h>

#include "support/process.hpp"
#include "support/temp_folder.hpp"

namespace meshfarm::test {
namespace {

namespace fs = std::filesystem;

/// A stage of a small mesh.
class Shell {
 public:
  Shell() {
    REQUIRE((*this)({"generate", "-o", path("m.ply"), "--triangles", "2000"}).code == 0);
    REQUIRE((*this)({"cut", path("m.ply"), "--stage", stage(), "--parts", "2"}).code == 0);
  }
  Ran operator()(const std::vector<std::string>& words) {
    return run_meshfarm(words, folder_.path() / ("log" + std::to_string(++logs_)));
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string stage() const { return path("stage"); }
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return path(name);
  }

 private:
  TempFolder folder_;
  int logs_ = 0;
};

TEST_CASE("a run tells what its workers are to be started with, wherever its options stand") {
  Shell shell;
  const Ran plain = shell({"run", shell.stage(), "--ratio", "0.1", "--worker-words"});
  REQUIRE(plain.code == 0);
  CHECK(plain.out.size() == std::string("--run\n0123456789abcdef\n").size());
  CHECK(plain.out.starts_with("--run\n"));
  const std::string config =
      shell.file("run.conf", "ratio = 0.1\nkey-file = /keys/of run\nallow-soft = true\n");
  const std::string expected = plain.out + "--key-file\n/keys/of run\n--allow-soft\n";
  CHECK(shell({"run", shell.stage(), "--config", config, "--worker-words"}).out == expected);
  CHECK(shell({"run", "--allow-soft", "--worker-words", "--key-file=/keys/of run", "--ratio", "0.1",
               shell.stage(), "--workers", "3"})
            .out == expected);
  const Ran other = shell({"run", shell.stage(), "--ratio", "0.2", "--worker-words"});
  CHECK(other.out != plain.out);
}

TEST_CASE("launch-local.sh takes --workers before the stage and among the run's options") {
  Shell shell;
  const std::string script =
      "MESHFARM=" MESHFARM_PROGRAM " " MESHFARM_SOURCE_DIR "/scripts/launch-local.sh ";
  const std::string run = shell.stage() + " --ratio 0.1 -q -o " + shell.path("o.ply");
  for (const std::string& words : {"--workers 2 " + run, run + " --workers 2", run + " --workers=2",
                                   "--workers 2 " + run + " --workers 1"}) {
    CAPTURE(words);
    fs::remove(shell.path("o.ply"));
    CHECK(std::system((script + words + " > /dev/null").c_str()) == 0);
    CHECK(fs::exists(shell.path("o.ply")));
  }
}

}  // namespace
}  // namespace meshfarm::test
