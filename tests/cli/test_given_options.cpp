// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Options without effect: a warning on the command line, nothing in a config file.
#include <doctest/doctest.h>

#include "support/shell.hpp"

using meshfarm::test::has;
using meshfarm::test::lines;
using meshfarm::test::Ran;
using meshfarm::test::Shell;
namespace fs = std::filesystem;

namespace {

struct Line {
  std::vector<std::string> words;
  std::string told;
};

}  // namespace

TEST_CASE("an option that changes nothing is told, and what it needs") {
  Shell shell;
  const std::string cube = shell.cube();
  const std::string out = shell.path("o.ply");
  const std::string stage = shell.path("s");
  REQUIRE(shell({"cut", cube, "--stage", stage}).code == 0);
  const Line warned[] = {
      {{"simplify", cube, "-o", out, "--ratio", "1", "--cut", "here", "--blocks", "3"},
       "--blocks changes nothing without --cut farm"},
      {{"cut", cube, "--stage", shell.path("t"), "--blocks", "3"},
       "--blocks changes nothing without --cut farm"},
      {{"simplify", cube, "-o", out, "--ratio", "1", "--window", "2000"},
       "--window changes nothing without --scheme stream"},
      {{"batch", cube, "-o", shell.path("all"), "--ratio", "1", "--window", "2000"},
       "--window changes nothing without --scheme stream"},
      {{"simplify", cube, "-o", shell.path("o.stl"), "--ratio", "1", "--texture-size", "512"},
       "--texture-size changes nothing without --uv bake"},
      {{"replay", stage, "--ratio", "0.5", "--uv", "keep", "--texture-size", "512"},
       "--texture-size changes nothing without --uv bake"},
      {{"replay", stage, "--ratio", "0.5", "--expect-workers", "2"},
       "--expect-workers changes nothing without --schedule static"},
      {{"simulate", "--seeds", "2", "--jobs", "16", "--limits"},
       "--limits changes nothing without a STAGE"},
      {{"simulate", stage, "--jobs", "50"}, "--jobs changes nothing without --seed or --seeds"},
      {{"simulate", stage, "--off", "0.1"}, "--off changes nothing without --paper"},
      {{"simulate", stage, "--paper", "--workers", "3"},
       "--workers changes nothing: --paper has farms of its own"},
  };
  for (const Line& line : warned) {
    const Ran ran = shell(line.words);
    CAPTURE(line.told);
    CAPTURE(ran.err);
    CHECK(ran.code == 0);
    CHECK(has(ran.err, "warning: " + line.told));
    CHECK(ran.err.find(line.told) == ran.err.rfind(line.told));
  }
  CHECK_FALSE(
      has(shell({"simplify", cube, "-o", out, "--ratio", "1", "--blocks", "3"}).err, "--blocks"));
}

TEST_CASE("an option that means another result than the command's is refused") {
  Shell shell;
  const std::string cube = shell.cube();
  const std::string out = shell.path("o.ply");
  const Line refused[] = {
      {{"simulate", "--seeds", "2", "-o", out}, "-o needs a STAGE and --paper"},
      {{"simulate", "s", "-o", out}, "-o needs --paper"},
      {{"generate", "-o", out, "--shuffle", "--from", cube, "--triangles", "100"},
       "--triangles cannot be combined with --from: no mesh is made then"},
      {{"generate", "-o", out, "--shuffle", "--from", cube, "--shape", "torus"},
       "--shape cannot be combined with --from: no mesh is made then"},
  };
  for (const Line& line : refused) {
    const Ran ran = shell(line.words);
    CAPTURE(line.told);
    CAPTURE(ran.err);
    CHECK(ran.code == 2);
    CHECK(lines(ran.err) == 1);
    CHECK(has(ran.err, line.told));
  }
  CHECK_FALSE(fs::exists(out));
}

TEST_CASE("a config file may say what a command has no use of") {
  Shell shell;
  const std::string cube = shell.cube();
  const std::string out = shell.path("o.ply");
  const std::string config = shell.file("all.conf",
                                        "blocks = 3\nwindow = 2000\nplain = true\n"
                                        "ratio = 1\nworkers = 1\n");
  const std::string sized = shell.file("sized.conf", "texture-size = 512\nuv = keep\nratio = 1\n");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"simplify", cube, "-o", out, "--config", config},
        {"simplify", cube, "-o", out, "--config", sized},
        {"batch", cube, "-o", shell.path("all"), "--config", config}}) {
    const Ran ran = shell(words);
    CAPTURE(ran.err);
    CHECK(ran.code == 0);
    CHECK_FALSE(has(ran.err, "warning"));
  }
  const std::string plan = shell.file("plan.conf", "limits = true\noutput = figure.svg\n");
  CHECK(shell({"simulate", "--seed", "2", "--jobs", "16", "--config", plan}).code == 0);
  const std::string farm = shell.file("farm.conf", "expect-workers = 2\n");
  REQUIRE(shell({"cut", cube, "--stage", shell.path("s")}).code == 0);
  CHECK(shell({"replay", shell.path("s"), "--ratio", "1", "--config", farm}).code == 0);
}

TEST_CASE("a config file may begin with a byte order mark, and its lines may end as on Windows") {
  Shell shell;
  const std::string config = shell.file("mark.conf",
                                        "\xEF\xBB\xBF"
                                        "ratio = 1\r\nworkers = 1\r\n");
  const Ran ran = shell({"simplify", shell.cube(), "-o", shell.path("o.ply"), "--config", config});
  CAPTURE(ran.err);
  CHECK(ran.code == 0);
}

TEST_CASE("--plain of another format than GLB is told to change nothing, once") {
  Shell shell;
  const std::string cube = shell.cube();
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"convert", cube, shell.path("o.obj"), "--plain"},
        {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "1", "--plain", "-q"},
        {"batch", cube, "-o", shell.path("all"), "--ratio", "1", "--plain", "-q"}}) {
    const Ran ran = shell(words);
    CAPTURE(ran.err);
    CHECK(ran.code == 0);
    CHECK(has(ran.err, "warning: --plain changes nothing: "));
    CHECK(has(ran.err, " is not .glb\n"));
    CHECK(ran.err.find("--plain") == ran.err.rfind("--plain"));
  }
  CHECK_FALSE(has(shell({"convert", cube, shell.path("o.glb"), "--plain"}).err, "--plain"));
}

TEST_CASE("what is wrong in a config file is told with the file and the line") {
  Shell shell;
  const std::string config = shell.path("run.conf");
  const auto error_of = [&](const std::string& text) {
    shell.file("run.conf", text);
    const Ran ran =
        shell({"simplify", shell.cube(), "-o", shell.path("o.ply"), "--config", config});
    CHECK(ran.code == 2);
    CHECK(lines(ran.err) == 1);
    return ran.err;
  };
  CHECK(has(error_of("rato = 0.5\n"), config + ": line 1: unrecognised option 'rato'"));
  CHECK(has(error_of("ratio = 1\nworkers = no\n"), config + ": line 2: "));
  CHECK(has(error_of("workers = 1\nratio = 2\n"), config + ": line 2: --ratio takes a share"));
  CHECK(has(error_of("ratio = 1\nparts = -2\n"), config + ": line 2: --parts takes no negative"));
  CHECK(has(error_of("ratio = 1\nattributes = heat\n"), config + ": line 2: --attributes: "));
  const Ran folder = shell({"info", shell.cube(), "--config", fs::path(config).parent_path()});
  CHECK(folder.code == 1);
  CHECK(has(folder.err, "Is a directory"));
}

TEST_CASE("errors show what was typed, and help ends no line with a blank") {
  Shell shell;
  CHECK(has(shell({"simulate", "s", "--workers", "x"}).err, "--workers: 'x' is no number"));
  CHECK(has(shell({"simulate", "s", "--workers", "24x"}).err, "--workers: '24x' is no number"));
  CHECK(shell({"benchmark", "--help"}).out.starts_with("meshfarm benchmark\n"));
}

TEST_CASE("an empty file, a buffer that is not there and a run that was not are told as that") {
  Shell shell;
  const std::string empty = shell.file("empty.ply", "");
  CHECK(has(shell({"info", empty}).err, empty + ": is empty\n"));
  const std::string gltf = shell.file(
      "mesh.gltf",
      R"({"asset":{"version":"2.0"},"buffers":[{"uri":"gone.bin","byteLength":36}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,)"
      R"("componentType":5126,"count":3,"type":"VEC3"}],"meshes":[{"primitives":[)"
      R"({"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],"scenes":[{"nodes":[0]}]})");
  const Ran info = shell({"info", gltf});
  CHECK(info.code == 1);
  CHECK(has(info.err, gltf));
  CHECK(has(info.err, shell.path("gone.bin")));
  const std::string stage = shell.path("s");
  REQUIRE(shell({"cut", shell.cube(), "--stage", stage}).code == 0);
  REQUIRE(shell({"replay", stage, "--ratio", "1"}).code == 0);
  const Ran report = shell({"report", stage, "--epoch", "99"});
  CHECK(report.code == 1);
  CHECK(has(report.err, stage + ": no run of epoch 99 was traced; those of 1 were\n"));
}

TEST_CASE("help says where 0 is the default, and what range a value has") {
  Shell shell;
  const auto help_of = [&](const char* command) {
    std::string words;  // without the line breaks of help's columns
    for (const char c : shell({command, "--help"}).out) {
      if (c != '\n' && c != ' ') words += c;
    }
    return words;
  };
  const std::string simplify = help_of("simplify");
  CHECK(has(simplify, "(0,thedefault:ofabout300,000each)"));
  CHECK(has(simplify, "numberofparts(0,thedefault:"));
  CHECK(has(simplify, "threadsofthecut(0,thedefault:cores)"));
  CHECK(has(simplify, "64to16384(0,thedefault:chosenfromtheinput'spictures)"));
  CHECK(has(simplify, "above0andupto1"));
  CHECK(has(simplify, "(0,thedefault:none;below180)"));
  CHECK(has(help_of("worker"), "(0,thedefault:as'meshfarmbenchmark'measured)"));
  CHECK(has(help_of("worker"), "0:nolimit"));
  CHECK(has(help_of("report"), "(0,thedefault:thelast)"));
  CHECK(has(help_of("info"), "threads(0,thedefault:cores)"));
  CHECK(has(help_of("convert"), "threadsthatparsetext(0:oneacore)"));
}

TEST_CASE("a run says once that it cannot listen, or that its keys are no file") {
  Shell shell;
  const std::string stage = shell.path("s");
  REQUIRE(shell({"cut", shell.cube(), "--stage", stage}).code == 0);
  const auto error_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words = {"run", stage, "--ratio", "1"};
    words.insert(words.end(), more.begin(), more.end());
    const Ran ran = shell(words);
    CHECK(ran.code == 1);
    CHECK(lines(ran.err) == 1);
    return ran.err;
  };
  CHECK(
      has(error_of({"--bind", "nonesuch0"}), "run: error: cannot listen on any port of nonesuch0"));
  CHECK(has(error_of({"--bind", "127.0.0.1", "--key-file", stage}), stage + ": not a file"));
}
