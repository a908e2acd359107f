// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The commands as a user types them: what they print, where, and their exit codes.
#include <algorithm>
#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include "support/shell.hpp"

using meshfarm::test::has;
using meshfarm::test::lines;
using meshfarm::test::Ran;
using meshfarm::test::read_text;
using meshfarm::test::Shell;
namespace fs = std::filesystem;
namespace test = meshfarm::test;

TEST_CASE("a cut keeps its scratch where --scratch says, or says why it cannot") {
  Shell shell;
  const std::string scratch = shell.path("scratch");
  for (const char* scheme : {"cut", "stream"}) {
    CAPTURE(scheme);
    const std::string stage = shell.path(std::string("stage-") + scheme);
    const std::vector<std::string> words = {"cut",     shell.cube(), "--scheme",  scheme,
                                            "--stage", stage,        "--scratch", scratch};
    const Ran without = shell(words);
    CHECK(without.code == 1);
    CHECK(has(without.err, scratch + ": No such file or directory"));
    fs::create_directory(scratch);
    CHECK(shell(words).code == 0);
    CHECK(fs::is_empty(scratch));
    fs::remove(scratch);
  }
}

TEST_CASE("a channel that the input has not, or no input, leaves no stage behind") {
  Shell shell;
  const std::string stage = shell.path("stage");
  const std::string output = shell.path("out.ply");
  const std::string cube = shell.cube();
  const Ran cut = shell({"cut", cube, "--stage", stage, "--attributes", "red,blue"});
  CHECK(cut.code == 2);
  CHECK(has(cut.err, "--attributes: there is no channel 'blue'; there are: "));
  CHECK_FALSE(fs::exists(stage));
  const Ran simplify = shell({"simplify", cube, "-o", output, "--ratio", "1", "--attributes", "x"});
  CHECK(simplify.code == 2);
  CHECK(has(simplify.err, "--attributes: there is no channel 'x'; there are: "));
  CHECK_FALSE(fs::exists(output + ".stage"));
  CHECK(shell({"cut", shell.file("bad.ply", "ply\n"), "--stage", stage}).code == 1);
  CHECK_FALSE(fs::exists(stage));
  // Once a cut is complete, the channels are those of the stage.
  REQUIRE(shell({"cut", cube, "--stage", stage}).code == 0);
  CHECK(shell({"cut", cube, "--stage", stage}).code == 0);
  CHECK(shell({"cut", cube, "--stage", stage, "--attributes", "x"}).code == 1);
}

TEST_CASE("help and version go to stdout, and say what there is") {
  Shell shell;
  for (const std::vector<std::string>& words : {std::vector<std::string>{"help"}, {"--help"}}) {
    const Ran ran = shell(words);
    CHECK(ran.code == 0);
    for (const char* command :
         {"simplify", "cut", "run", "worker", "replay", "ventilator", "sink", "info", "compare",
          "convert", "generate", "simulate", "status", "report"}) {
      CHECK(has(ran.out, command));
    }
  }
  CHECK(shell({"--version"}).out == "meshfarm " MESHFARM_VERSION "\n");
  const Ran ran = shell({"simplify", "--help"});
  CHECK(ran.code == 0);
  for (const char* option :
       {"--output", "--ratio", "--triangles", "--workers", "--parts", "--stage", "--keep-stage",
        "--weld", "--quiet", "--json", "--config"}) {
    CHECK(has(ran.out, option));
  }
  CHECK_FALSE(has(ran.out, "supervised"));
}

TEST_CASE("a NaN costs the triangles that use it, and everybody says so") {
  Shell shell;
  std::string text = read_text(shell.cube());
  text.replace(text.find("0 0 0 9"), 7, "nan 0 0 9");
  text.replace(text.find("vertex 8"), 8, "vertex 9");
  text.replace(text.find("0 1 1 9\n"), 8, "0 1 1 9\n0 inf 0 9\n");
  const std::string input = shell.file("nan.ply", text);
  for (const std::string scheme : {"cut", "stream"}) {
    const Ran ran = shell({"simplify", input, "-o", shell.path("out.ply"), "--triangles", "8",
                           "--scheme", scheme, "--quiet"});
    CHECK(ran.code == 0);
    CHECK(has(ran.out, "triangles with positions that are not finite"));
    CHECK_FALSE(has(ran.out, "dropped          0"));
    CHECK(has(ran.out, "5 triangles with positions that are not finite"));
  }
  const Ran info = shell({"info", input});
  CHECK(info.code == 0);
  CHECK(has(info.out, "2 of them with a coordinate that is not finite"));
  CHECK(has(info.out, "left out         5 triangles with positions that are not finite"));
  CHECK(has(shell({"info", input, "--no-topology", "--json"}).out, "\"not_finite\": 2"));
}

TEST_CASE("faces of fewer than three corners are left out, and simplify says so too") {
  Shell shell;
  std::string text = read_text(shell.cube());
  text.replace(text.find("face 6"), 6, "face 8");
  const std::string input = shell.file("lines.ply", text + "2 0 1\n1 3\n");
  const std::string left_out = input + ": left out: 2 faces of 0 to 2 corners\n";
  for (const std::string scheme : {"cut", "stream"}) {
    const Ran ran = shell({"simplify", input, "-o", shell.path("out.ply"), "--ratio", "1",
                           "--scheme", scheme, "--quiet"});
    CHECK(ran.code == 0);
    CHECK(has(ran.err, left_out));
  }
  CHECK(has(shell({"info", input}).out, "left out         2 faces of 0 to 2 corners\n"));
}

TEST_CASE("a cut that leaves the sorting to the farm says so, and the run then knows streams") {
  Shell shell;
  const std::string stage = shell.path("stage");
  const std::string sphere = shell.path("sphere.ply");
  REQUIRE(shell({"generate", "-o", sphere, "--triangles", "20000"}).code == 0);
  const Ran cut = shell(
      {"cut", sphere, "--stage", stage, "--scheme", "stream", "--sort", "farm", "--parts", "4"});
  CHECK(cut.code == 0);
  CHECK(has(cut.out, "4 slabs to be sorted, "));
  CHECK(has(shell({"info", stage, "--json"}).out, "\"sorted\": false"));
  const Ran run = shell({"replay", stage, "--ratio", "0.1", "-o", shell.path("o.ply")});
  CHECK(run.code == 0);
  CHECK(has(run.out, "streams          4, stitched to"));
  CHECK(has(shell({"status", stage}).out, "8 of 8 done"));  // four of them sorted
}

TEST_CASE("a run is traced: status, report and simulate tell of it") {
  Shell shell;
  const std::string stage = shell.path("stage");
  const std::string sphere = shell.path("sphere.ply");
  REQUIRE(shell({"generate", "-o", sphere, "--triangles", "20000"}).code == 0);
  REQUIRE(shell({"cut", sphere, "--stage", stage, "--parts", "8"}).code == 0);
  CHECK(has(shell({"status", stage}).out, "none yet; the cut is whole"));
  CHECK(shell({"simulate", stage}).code == 1);  // no trace yet
  REQUIRE(shell({"replay", stage, "--ratio", "0.1", "-o", shell.path("o.ply")}).code == 0);

  const Ran status = shell({"status", stage, "--watch"});  // the run is over, so it looks once
  CHECK(status.code == 0);
  CHECK(has(status.out, "phase            done"));
  CHECK(has(status.out, "8 of 8 done"));
  CHECK(has(status.out, "last summary"));
  CHECK(has(shell({"status", stage, "--json"}).out, "\"over\": true"));

  CHECK(shell({"report", stage, "-o", shell.path("r.html")}).code == 0);
  const std::string page = read_text(shell.path("r.html"));
  CHECK(has(page, "all was done"));
  CHECK(has(page, "<rect"));
  CHECK(page.ends_with("</html>\n"));

  const Ran plan = shell({"simulate", stage, "--workers", "2,16x1+8x0.333"});
  CHECK(plan.code == 0);
  CHECK(has(plan.out, "8 jobs, dynamic schedule"));
  CHECK(has(plan.out, "16x1+8x0.333"));
  const Ran paper = shell({"simulate", stage, "--paper", "-o", shell.path("figure.svg")});
  CHECK(has(paper.out, "Table 1 (cutting), simulated on 24 workers"));
  CHECK(has(paper.out, "Figure 4"));
  CHECK(read_text(shell.path("figure.svg")).ends_with("</svg>\n"));
}

TEST_CASE("simulate tells what came of its seeds, the same each time") {
  Shell shell;
  const std::vector<std::string> words = {"simulate", "--seeds", "20", "--workers",
                                          "6",        "--jobs",  "50"};
  const Ran ran = shell(words);
  CHECK(ran.code == 0);
  CHECK(has(ran.out, "20 seeds, 6 workers, 50 jobs: "));
  CHECK(has(ran.out, ", 0 failed"));
  const auto trace = [](const std::string& out) { return out.substr(out.find("trace "), 22); };
  CHECK(trace(shell(words).out) == trace(ran.out));
  CHECK(trace(shell({"simulate", "--seed", "2", "--jobs", "50"}).out) != trace(ran.out));
  CHECK(has(shell({"simulate", "--seed", "3", "--json"}).out, "\"problems\": []"));
}

TEST_CASE("wrong usage is one line and exit 2") {
  Shell shell;
  const std::string cube = shell.cube();
  const std::vector<std::vector<std::string>> wrong = {
      {"simplfy"},
      {"simulate"},
      {"simulate", "--seeds", "5", "--workers", "0"},
      {"simulate", "--seeds", "5", "--jobs", "3"},
      {"simulate", "stage", "--seeds", "5"},
      {"simulate", "stage", "--workers", "24x"},
      {"simulate", "stage", "--schedule", "maybe"},
      {"simulate", "stage", "--storage", "0"},
      {"status"},
      {"simplify"},
      {"simplify", cube},
      {"simplify", cube, "-o", shell.path("o.ply")},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "1.5"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "nan"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "half"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--triangles", "3"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--triangles", "-3"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--weld", "maybe"},
      {"cut", cube, "--stage", shell.path("s"), "--scheme", "stream", "--sort", "there"},
      {"cut", cube, "--stage", shell.path("s"), "--sort", "farm"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--workers", "0"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--parts", "-1"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--drop-components", "x"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--drop-components", "%"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--crease-angle", "180"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--crease-angle", "-1"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--error", "1%"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--error", "0"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--error", "1km"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--certify"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--error", "1%", "--certify",
       "--drop-components", "1%"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--topology", "maybe"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--colour"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--uv", "tight"},
      {"convert", cube, shell.path("o.ply"), "--uv", "paint"},
      {"convert", cube, shell.path("o.stl"), "--uv", "keep"},
      {"convert", cube, shell.path("o.obj"), "--uv", "bake"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--weight", "colour"},
      {"simplify", cube, "-o", shell.path("o.ply"), "--ratio", "0.5", "--weight", "uv=2"},
      {"convert", cube, shell.path("o.off"), "--uv", "keep"},
      {"run", shell.path("s"), "--ratio", "0.5", "--ports", "9-8"},
      {"run", shell.path("s"), "--ratio", "0.5", "--uv", "colours"},
      {"run", shell.path("s"), "-o", shell.path("o.stl"), "--ratio", "0.5", "--uv", "keep"},
      {"compare", cube},
  };
  for (const auto& words : wrong) {
    std::string typed;
    for (const std::string& word : words) typed += word + " ";
    CAPTURE(typed);
    const Ran ran = shell(words);
    CHECK(ran.code == 2);
    CHECK(lines(ran.err) == 1);
    CHECK(ran.out.empty());
  }
  CHECK_FALSE(fs::exists(shell.path("o.ply")));
}

TEST_CASE("what is missing is named as help names it") {
  Shell shell;
  const auto says = [&](const std::vector<std::string>& words, const std::string& missing) {
    return has(shell(words).err, missing + " is missing: meshfarm " + words[0] + " ");
  };
  CHECK(says({"compare"}, "A"));
  CHECK(says({"compare", "a.ply"}, "B"));
  CHECK(says({"cut", "a.ply"}, "--stage"));
}

TEST_CASE("what cannot be read or written is one line and exit 1") {
  Shell shell;
  const std::string cube = shell.cube();
  const std::string text = shell.file("text.ply", "no mesh\n");
  const std::string obj = shell.file("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  const std::string off = shell.file("mesh.off", "OFF\n3 x 0\n");
  const std::string stl = shell.file("mesh.stl", "solid x\nfacet normal 0 0 1\nouter\n");
  const std::string bad =
      shell.file("word.ply",
                 "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                 "property float z\nend_header\n0 word 0\n");
  const std::vector<std::pair<std::vector<std::string>, std::string>> failing = {
      {{"simplify", shell.path("absent.ply"), "-o", shell.path("o.ply"), "--ratio", "0.5"},
       "absent.ply"},
      {{"simplify", cube, "-o", shell.path("no/such/folder/o.ply"), "--ratio", "0.5"},
       "no/such/folder"},
      {{"simplify", text, "-o", shell.path("o.ply"), "--ratio", "0.5"}, "text.ply"},
      {{"simplify", obj, "-o", shell.path("o.ply"), "--ratio", "0.5"}, "mesh.obj: line 4: "},
      {{"simplify", off, "-o", shell.path("o.ply"), "--ratio", "0.5"}, "mesh.off: line 2: "},
      {{"simplify", stl, "-o", shell.path("o.ply"), "--ratio", "0.5"}, "mesh.stl: line 4: "},
      {{"simplify", bad, "-o", shell.path("o.ply"), "--ratio", "0.5"}, "vertex 0"},
      {{"replay", shell.path("absent"), "--ratio", "0.5"}, "absent"},
      {{"worker", shell.path("absent")}, "absent"},
      {{"info", shell.path("absent.ply")}, "absent.ply"},
      {{"compare", cube, text}, "text.ply"},
      {{"cut", cube, "--stage", shell.path("cube.ply")}, "cube.ply"},
  };
  for (const auto& [words, place] : failing) {
    std::string typed;
    for (const std::string& word : words) typed += word + " ";
    CAPTURE(typed);
    const Ran ran = shell(words);
    CAPTURE(ran.err);
    CHECK(ran.code == 1);
    CHECK(lines(ran.err) == 1);
    CHECK(has(ran.err, "error: "));
    CHECK(has(ran.err, place));
    CHECK(ran.out.empty());
  }
}

TEST_CASE("an output of another format is refused before any work") {
  Shell shell;
  const std::string cube = shell.cube();
  const std::string stage = shell.path("stage");
  REQUIRE(shell({"cut", cube, "--stage", stage, "--quiet"}).code == 0);
  const std::string output = shell.path("x.fbx");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"simplify", cube, "-o", output, "--ratio", "0.5"},
        {"replay", stage, "-o", output, "--ratio", "0.5"},
        {"run", stage, "-o", output, "--ratio", "0.5"},
        {"sink", stage, "-o", output, "--ratio", "0.5", "--wait", "1"},
        {"generate", "-o", output, "--triangles", "1000"}}) {
    const Ran ran = shell(words);
    INFO(words[0] << ": " << ran.err);
    CHECK(ran.code == 1);
    CHECK(lines(ran.err) == 1);
    CHECK(has(ran.err, "cannot write .fbx"));
    CHECK_FALSE(fs::exists(output));
    CHECK_FALSE(fs::exists(output + ".stage"));
  }
}

TEST_CASE("the manual pages are made of the options that help shows") {
  Shell shell;
  const std::string manual = shell.path("manual");
  REQUIRE(shell({"--write-manual", manual}).code == 0);
  const std::string page = read_text(manual + "/man1/meshfarm-cut.1");
  CHECK(has(page, "\\fB\\-\\-scheme\\fR \\fIcut|stream\\fR"));
  CHECK(has(page, "(default: cut)"));
  CHECK_FALSE(has(page, "\\-\\-input"));  // a positional argument
  const std::string completion = read_text(manual + "/completions/meshfarm");
  CHECK(has(completion, "'cut --scheme') words='cut stream'"));
  CHECK(has(completion, "'simplify --output' | 'simplify -o') compopt -o default"));
  CHECK(shell({"--write-manual", shell.file("file", "") + "/manual"}).code == 1);
}

TEST_CASE("a cube goes through, and what is not kept is named") {
  Shell shell;
  const std::vector<std::string> words = {
      "simplify", shell.cube(), "-o", shell.path("o.ply"), "--ratio", "1", "--workers", "1"};
  const Ran ran = shell(words);
  CHECK(ran.code == 0);
  CHECK(has(ran.out, "12 triangles, 8 vertices"));
  CHECK(has(ran.out, "channels         red 0"));
  std::vector<std::string> without = words;
  without.insert(without.end(), {"--attributes", "none"});
  CHECK(has(shell(without).out, "not kept         vertex.red"));
  const Ran info = shell({"info", shell.path("o.ply"), "--json"});
  CHECK(info.code == 0);
  CHECK(has(info.out, "\"euler\": 2"));
  CHECK(has(info.out, "\"border_edges\": 0"));
}

TEST_CASE("quiet says nothing on stderr; json is on stdout") {
  Shell shell;
  const Ran ran = shell({"simplify", shell.cube(), "-o", shell.path("o.ply"), "--triangles", "4",
                         "--workers", "1", "--quiet", "--json"});
  CHECK(ran.code == 0);
  CHECK(ran.err.empty());
  CHECK(ran.out.front() == '{');
  CHECK(has(ran.out, "\"target\": 4"));
}

TEST_CASE("options may stand in a config file; the command line wins") {
  Shell shell;
  const std::string config = shell.file("run.conf", "# a comment\nratio = 0.5\nworkers = 1\n");
  const Ran ran = shell({"simplify", shell.cube(), "-o", shell.path("o.ply"), "--config", config,
                         "--json", "--workers", "2"});
  CHECK(ran.code == 0);
  CHECK(has(ran.out, "\"target\": 6"));
  const std::string wrong = shell.file("wrong.conf", "rato = 0.5\n");
  CHECK(shell({"simplify", shell.cube(), "-o", shell.path("o.ply"), "--config", wrong}).code == 2);
}

TEST_CASE("the example config files are understood") {
  Shell shell;
  const std::string conf = std::string(MESHFARM_SOURCE_DIR) + "/conf/";
  const Ran ran =
      shell({"simplify", shell.cube(), "-o", shell.path("o.ply"), "--config",
             conf + "simplify.conf", "--ratio", "0.5", "--stage", shell.path("s"), "--keep-stage"});
  CAPTURE(ran.err);
  CHECK(ran.code == 0);
  // Without a sink it waits until it is stopped: it only matters that it got that far.
  test::Process ventilator(
      {"ventilator", shell.path("s"), "--bind", "127.0.0.1", "--config", conf + "ventilator.conf"},
      shell.path("ventilator"));
  CHECK(test::wait_until([&] { return has(ventilator.err(), "listens on"); }));
  ventilator.signal(SIGTERM);
  CHECK(ventilator.wait() == 3);
  const Ran worker =
      shell({"worker", shell.path("s"), "--config", conf + "worker.conf", "--wait", "0"});
  CHECK(worker.code == 3);
  CHECK(has(worker.err, "start 'meshfarm run'"));
}

TEST_CASE("a stage that holds a finished cut is not cut again") {
  Shell shell;
  const std::string cube = shell.cube();
  const std::string stage = shell.path("stage");
  CHECK(shell({"cut", cube, "--stage", stage}).code == 0);
  const auto made = std::filesystem::last_write_time(stage + "/manifest");
  SUBCASE("the same command takes it up") {
    const Ran ran = shell({"cut", cube, "--stage", stage, "--threads", "1"});
    CHECK(ran.code == 0);
    CHECK(has(ran.err, "already holds this cut"));
    CHECK(std::filesystem::last_write_time(stage + "/manifest") == made);
  }
  SUBCASE("other options are refused") {
    const Ran ran = shell({"cut", cube, "--stage", stage, "--weld", "off"});
    CHECK(ran.code == 1);
    CHECK(has(ran.err, "--weld auto"));
    CHECK(has(ran.err, "meshfarm replay"));
  }
  SUBCASE("another input is refused") {
    std::ofstream(cube, std::ios::app) << " ";
    const Ran ran = shell({"cut", cube, "--stage", stage});
    CHECK(ran.code == 1);
    CHECK(has(ran.err, "another input"));
  }
  CHECK(has(shell({"info", stage}).out, "1 parts"));
}

TEST_CASE("a cut that was interrupted begins anew by itself") {
  Shell shell;
  const std::string stage = shell.path("stage");
  CHECK(shell({"cut", shell.cube(), "--stage", stage}).code == 0);
  std::filesystem::remove(stage + "/manifest");
  CHECK(shell({"cut", shell.cube(), "--stage", stage}).code == 0);
  CHECK(has(shell({"info", stage}).out, "1 parts"));
}

TEST_CASE("a point cloud and a mesh without anything make an empty result") {
  Shell shell;
  const std::string head = "ply\nformat ascii 1.0\nelement vertex ";
  const std::string xyz = "\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string faces = "element face 0\nproperty list uchar int vertex_indices\nend_header\n";
  for (const std::string& text :
       {head + "2" + xyz + "end_header\n0 0 0\n1 1 1\n", head + "0" + xyz + faces}) {
    const std::string input = shell.file("points.ply", text);
    const Ran ran = shell({"simplify", input, "-o", shell.path("o.ply"), "--ratio", "0.5"});
    CAPTURE(ran.err);
    CHECK(ran.code == 0);
    CHECK(has(ran.out, "0 triangles"));
  }
}

TEST_CASE("generate, info and compare fit together") {
  Shell shell;
  CHECK(shell({"generate", "-o", shell.path("t.ply"), "--triangles", "20000"}).code == 0);
  const Ran info = shell({"info", shell.path("t.ply")});
  CHECK(has(info.out, "1 component, 0 border edges, 0 non-manifold edges"));
  CHECK(has(info.out, "Euler characteristic 0"));
  CHECK(shell({"simplify", shell.path("t.ply"), "-o", shell.path("s.ply"), "--triangles", "2000"})
            .code == 0);
  const Ran same =
      shell({"compare", shell.path("t.ply"), shell.path("t.ply"), "--samples", "1000"});
  const std::size_t rms = same.out.find("rms ");
  REQUIRE(rms != std::string::npos);
  CHECK(std::stod(same.out.substr(rms + 4)) < 1e-9);
  const Ran ran = shell({"compare", shell.path("t.ply"), shell.path("s.ply"), "--json"});
  CHECK(ran.code == 0);
  CHECK(has(ran.out, "\"triangles\": 2000,"));
}

TEST_CASE("one mesh has one result, as whatever format it comes and goes") {
  Shell shell;
  const auto path = [&](const char* name) { return shell.path(name); };
  const auto simplified = [&](const char* from, const char* to) {
    CAPTURE(from);
    const Ran ran =
        shell({"simplify", path(from), "-o", path(to), "--triangles", "2000", "--plain"});
    CHECK(ran.code == 0);
    return read_text(path(to));
  };
  REQUIRE(shell({"generate", "-o", path("t.ply"), "--triangles", "20000"}).code == 0);
  for (const char* name : {"t.obj", "t.off", "t.glb", "t.gltf", "t.stl"}) {
    CHECK(shell({"convert", path("t.ply"), path(name), "--quiet", "--plain"}).code == 0);
  }
  CHECK(shell({"convert", path("t.stl"), path("soup.ply")}).code == 0);
  const std::string result = simplified("t.ply", "from-ply.ply");
  CHECK(simplified("t.obj", "from-obj.ply") == result);
  CHECK(simplified("t.off", "from-off.ply") == result);
  CHECK(simplified("t.glb", "from-glb.ply") == result);
  CHECK(simplified("t.gltf", "from-gltf.ply") == result);
  // A soup has different vertices, and so different parts.
  const std::string from_soup = simplified("t.stl", "from-stl.ply");
  CHECK(from_soup == simplified("soup.ply", "from-soup.ply"));
  CHECK(has(shell({"info", path("from-stl.ply")}).out, "triangles        2,000\n"));
  for (const char* name : {"r.obj", "r.off", "r.glb", "r.gltf"}) {
    simplified("t.ply", name);
    CHECK(shell({"convert", path(name), path("r.ply")}).code == 0);
    CHECK(read_text(path("r.ply")) == result);
  }
  simplified("t.ply", "r.stl");
  CHECK(has(shell({"compare", path("r.stl"), path("from-ply.ply"), "--samples", "1000"}).out,
            "1 component, 0 border edges, 0 non-manifold edges"));
}

TEST_CASE("generate makes the same mesh in all formats") {
  Shell shell;
  for (const char* name : {"t.ply", "t.obj", "t.off"}) {
    CHECK(shell({"generate", "-o", shell.path(name), "--triangles", "5000"}).code == 0);
  }
  CHECK(shell({"convert", shell.path("t.ply"), shell.path("a.off")}).code == 0);
  CHECK(shell({"convert", shell.path("t.obj"), shell.path("b.off")}).code == 0);
  CHECK(read_text(shell.path("a.off")) == read_text(shell.path("t.off")));
  CHECK(read_text(shell.path("b.off")) == read_text(shell.path("t.off")));
}

TEST_CASE("generate makes shapes by their names") {
  Shell shell;
  const std::string block = shell.path("b.ply"), mixed = shell.path("m.ply");
  CHECK(shell({"generate", "-o", block, "--shape", "block", "--triangles", "10000"}).code == 0);
  CHECK(has(shell({"info", block}).out, "Euler characteristic -10"));
  CHECK(shell({"generate", "-o", mixed, "--shape", "block", "--triangles", "10000", "--shuffle"})
            .code == 0);
  CHECK(has(shell({"info", mixed}).out, "Euler characteristic -10"));
  const Ran ran = shell({"generate", "-o", block, "--shape", "cube"});
  CHECK(ran.code == 2);
  CHECK(has(ran.err, "torus, foam, dust, soup, terrain, block, shell"));
}

TEST_CASE("benchmark tells the speed, the memory and the cores, and remembers the speed") {
  Shell shell;
  ::setenv("XDG_CACHE_HOME", shell.path("cache").c_str(), 1);
  const Ran text = shell({"benchmark"});
  CHECK(text.code == 0);
  CHECK(has(text.out, "triangles/s"));
  CHECK(lines(text.out) == 3);
  CHECK(has(shell({"benchmark", "--json"}).out, "\"triangles_per_second\": "));
  CHECK(fs::exists(shell.path("cache/meshfarm")));
  ::unsetenv("XDG_CACHE_HOME");
}

TEST_CASE("a worker's memory is a size") {
  Shell shell;
  for (const std::string bad : {"8X", "G", "8GB", "", "1e99"}) {
    CAPTURE(bad);
    const Ran ran = shell({"worker", shell.path("none"), "--memory", bad});
    CHECK(ran.code == (bad.empty() ? 1 : 2));
  }
  CHECK(shell({"worker", shell.path("none"), "--memory", "8G"}).code == 1);  // no such stage
}
