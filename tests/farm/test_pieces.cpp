// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Runs of the real program whose finish is split into jobs. Whatever is killed, the bytes are the
// same.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/util/file.hpp>

#include "support/farm_bench.hpp"
#include "support/meshes.hpp"
#include "support/process.hpp"

using meshfarm::test::FarmBench;
using meshfarm::test::Process;
using meshfarm::test::Ran;
using meshfarm::test::results_in;
using meshfarm::test::wait_for_results;

namespace {

/// 50,000 triangles in 8 parts, each of which becomes a piece.
class PiecesBench : public FarmBench {
 public:
  PiecesBench() : FarmBench("50000") {
    const std::string output = path("expected.ply");
    expect(meshfarm(with_target(
               {"simplify", mesh(), "-o", output, "--parts", "8", "--workers", "2", "--json"})),
           output);
  }

  static std::vector<std::string> with_target(std::vector<std::string> words) {
    words.insert(words.end(), {"--ratio", "0.2", "--finish", "farm", "--composition", "sink"});
    return words;
  }
  std::string cut() { return FarmBench::cut({"--parts", "8"}); }
  std::string planned() {
    return FarmBench::cut({"--parts", "8", "--cut", "farm", "--blocks", "3"});
  }
  Process ventilator(const std::string& stage) {
    return start(
        with_target({"ventilator", stage, "--bind", "127.0.0.1", "--heartbeat-ms", "150"}));
  }
  Process sink(const std::string& stage) {
    return start(
        with_target({"sink", stage, "--bind", "127.0.0.1", "-o", stage + ".ply", "--json"}));
  }
};

PiecesBench& bench() {
  static PiecesBench instance;
  return instance;
}

// 8 climbs and 8 splits, the seams, 9 pieces reduced and measured.
constexpr std::size_t k_all_results = 8 + 8 + 1 + 9 + 9;

}  // namespace

TEST_CASE("1 and 5 workers finish pieces to the same bytes and figures") {
  std::string figures;
  for (const char* workers : {"1", "5"}) {
    CAPTURE(workers);
    const std::string output = bench().path(std::string("w") + workers + ".ply");
    const Ran ran = bench().meshfarm(
        PiecesBench::with_target({"simplify", bench().mesh(), "-o", output, "--parts", "8",
                                  "--workers", workers, "--json"}));
    CHECK(ran.code == 0);
    bench().check_result(output);
    const std::size_t first = ran.out.find("\"error\"");
    const std::string error = ran.out.substr(first, ran.out.find("\"channels\"", first) - first);
    if (figures.empty()) figures = error;
    CHECK(error == figures);
    CHECK(ran.out.find("\"by\": \"farm\"") != std::string::npos);
  }
}

TEST_CASE("1 and 5 workers finish streams in pieces to the same bytes") {
  std::string expected;
  for (const char* workers : {"1", "5"}) {
    CAPTURE(workers);
    const std::string output = bench().path(std::string("s") + workers + ".ply");
    const Ran ran = bench().meshfarm(PiecesBench::with_target(
        {"simplify", bench().mesh(), "-o", output, "--scheme", "stream", "--parts", "8", "--window",
         "4000", "--workers", workers, "--json"}));
    CHECK(ran.code == 0);
    CHECK(ran.out.find("\"by\": \"farm\"") != std::string::npos);
    const std::string bytes = meshfarm::read_file(output);
    if (expected.empty()) expected = bytes;
    CHECK(bytes == expected);
  }
  const meshfarm::Topology t =
      meshfarm::measure_topology(meshfarm::read_mesh(*meshfarm::open_mesh(bench().path("s5.ply"))));
  CHECK(t.triangles == 10'000);
  CHECK(t.border_edges + t.nonmanifold_edges + t.duplicate == 0);
  CHECK(t.euler == 0);
}

TEST_CASE("pieces of an input that jobs have cut: the same bytes and figures") {
  struct Case {
    const char* workers;
    const char* blocks;
  };
  const auto error_of = [](const std::string& out) {
    const std::size_t first = out.find("\"error\"");
    return out.substr(first, out.find("\"channels\"", first) - first);
  };
  std::string figures;
  for (const Case& each : {Case{"2", ""}, Case{"1", "3"}, Case{"2", "17"}, Case{"5", "1"}}) {
    CAPTURE(each.blocks);
    const std::string output = bench().path("cut.ply");
    std::filesystem::remove(output);
    std::vector<std::string> words = {"simplify", bench().mesh(), "-o",         output,  "--parts",
                                      "8",        "--workers",    each.workers, "--json"};
    const bool farms = *each.blocks != '\0';
    words.insert(words.end(), {"--cut", farms ? "farm" : "here"});
    if (farms) words.insert(words.end(), {"--blocks", each.blocks});
    const Ran ran = bench().meshfarm(PiecesBench::with_target(words));
    CHECK(ran.code == 0);
    bench().check_result(output);
    if (figures.empty()) figures = error_of(ran.out);
    CHECK(error_of(ran.out) == figures);
    CHECK(ran.out.find("\"by\": \"farm\"") != std::string::npos);
  }
}

TEST_CASE("pieces keep a bound on the error: any workers, any cut, the same bytes and figures") {
  const auto bounded = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> words = {"simplify", bench().mesh(), "-o",      bench().path(name),
                                      "--error",  "0.05%",        "--parts", "8",
                                      "--json"};
    words.insert(words.end(), more.begin(), more.end());
    const Ran ran = bench().meshfarm(words);
    CHECK(ran.code == 0);
    return ran.out;
  };
  const auto figures_of = [](const std::string& out) {
    const std::size_t first = out.find("\"bound\"");
    return out.substr(first, out.find("\"channels\"", first) - first);
  };
  using meshfarm::test::read_text;
  const std::string farm = bounded("bound.ply", {"--finish", "farm", "--workers", "2"});
  CHECK(farm.find("\"by\": \"farm\"") != std::string::npos);
  const std::string expected = read_text(bench().path("bound.ply"));
  CHECK(expected.size() > 1000);
  const std::vector<std::vector<std::string>> others = {
      {"--workers", "1"}, {"--workers", "5"}, {"--workers", "2", "--cut", "farm", "--blocks", "3"}};
  for (std::vector<std::string> more : others) {
    CAPTURE(more.size());
    more.insert(more.end(), {"--finish", "farm"});
    CHECK(figures_of(bounded("other.ply", more)) == figures_of(farm));
    CHECK(read_text(bench().path("other.ply")) == expected);
  }
  bounded("sink.ply", {"--finish", "here"});
  const auto triangles = [&](const char* name) {
    return meshfarm::read_mesh(*meshfarm::open_mesh(bench().path(name))).triangles.size();
  };
  CHECK(100 * triangles("bound.ply") < 103 * triangles("sink.ply"));
  CHECK(triangles("bound.ply") < 15'000);
}

TEST_CASE("killed while a bound is kept by jobs, a run goes on to the same bytes") {
  const std::string stage = bench().planned();
  const auto words = [&](const std::string& output) {
    return std::vector<std::string>{"replay",  stage,       "-o",        output,
                                    "--error", "0.05%",     "--certify", "--finish",
                                    "farm",    "--workers", "2"};
  };
  REQUIRE(bench().meshfarm(words(stage + "-whole.ply")).code == 0);
  const std::string again = bench().planned();
  const auto on = [&](std::vector<std::string> of) {
    of[1] = again;
    return of;
  };
  for (const std::size_t results : {15U, 24U, 31U, 34U}) {
    CAPTURE(results);
    Process run = bench().start(on(words(again + ".ply")));
    REQUIRE(wait_for_results(again, results));
    run.signal(SIGKILL);
    CHECK(run.wait() == -SIGKILL);
  }
  CHECK(bench().meshfarm(on(words(again + ".ply"))).code == 0);
  CHECK(meshfarm::test::read_text(again + ".ply") ==
        meshfarm::test::read_text(stage + "-whole.ply"));
}

TEST_CASE("killed at any stage, a run that cuts and finishes by jobs goes on") {
  const std::string stage = bench().planned();
  for (const std::size_t results : {3U, 10U, 20U, 29U, 36U}) {
    CAPTURE(results);
    Process run = bench().start(
        PiecesBench::with_target({"replay", stage, "-o", stage + ".ply", "--workers", "2"}));
    REQUIRE(wait_for_results(stage, results));
    run.signal(SIGKILL);  // its children end with it
    CHECK(run.wait() == -SIGKILL);
  }
  const Ran ran =
      bench().meshfarm(PiecesBench::with_target({"replay", stage, "-o", stage + ".ply"}));
  CHECK(ran.code == 0);
  bench().check_result(stage + ".ply");
}

TEST_CASE("everything killed while pieces are made, and started again: the same bytes") {
  for (const std::size_t results : {10U, 18U, 24U, 31U}) {
    CAPTURE(results);
    const std::string stage = bench().cut();
    {
      Process ventilator = bench().ventilator(stage);
      Process sink = bench().sink(stage);
      Process one = bench().start({"worker", stage});
      REQUIRE(wait_for_results(stage, results));
    }  // all are killed here
    const Ran ran =
        bench().meshfarm(PiecesBench::with_target({"replay", stage, "-o", stage + ".ply"}));
    CHECK(ran.code == 0);
    bench().check_result(stage + ".ply");
    CHECK(results_in(stage) >= k_all_results);
    const Ran again =
        bench().meshfarm(PiecesBench::with_target({"replay", stage, "-o", stage + "-again.ply"}));
    CHECK(again.code == 0);
    bench().check_result(stage + "-again.ply");
  }
}

TEST_CASE("a damaged piece is made again") {
  const std::string stage = bench().cut();
  REQUIRE(
      bench().meshfarm(PiecesBench::with_target({"replay", stage, "-o", stage + ".ply"})).code ==
      0);
  for (const auto& entry : std::filesystem::directory_iterator(stage + "/results")) {
    std::filesystem::resize_file(entry.path(), std::filesystem::file_size(entry.path()) / 2);
  }
  REQUIRE(
      bench().meshfarm(PiecesBench::with_target({"replay", stage, "-o", stage + "-2.ply"})).code ==
      0);
  bench().check_result(stage + "-2.ply");
}

namespace {

/// A wavy sheet with `balls` balls above it, every fourth one twice as large as the others.
meshfarm::Mesh sheet_and_balls(int balls) {
  using meshfarm::Vec3;
  meshfarm::Mesh mesh = meshfarm::test::grid(120, 120);
  for (Vec3& p : mesh.positions) p.z = 2 * std::sin(p.x * 0.11) * std::cos(p.y * 0.07);
  const meshfarm::Mesh ball = meshfarm::test::icosphere(3);
  for (int i = 0; i < balls; ++i) {
    const Vec3 centre = {12.0 + 24 * (i % 5), 12.0 + 24 * (i / 5 % 5), 9};
    std::vector<Vec3> positions = ball.positions;
    for (Vec3& p : positions) p = centre + p * (i % 4 == 0 ? 6.0 : 3.0);
    meshfarm::append_surface(positions, ball.triangles, mesh);
  }
  for (Vec3& p : mesh.positions) p = meshfarm::rounded(p, meshfarm::PositionType::float32);
  return mesh;
}

}  // namespace

TEST_CASE("small components that span pieces are left out, as by the sink") {
  using namespace meshfarm;
  const std::string input = bench().path("balls.ply");
  write_mesh(input, sheet_and_balls(25), PositionType::float32);
  const auto simplify = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> words = {"simplify", input, "-o", bench().path(name), "--parts", "7"};
    more.insert(more.end(),
                {"--triangles", "12001", "--drop-components", "15", "--composition", "sink"});
    words.insert(words.end(), more.begin(), more.end());
    const Ran ran = bench().meshfarm(words);
    REQUIRE(ran.code == 0);
    CHECK(ran.out.find("18 small components") != std::string::npos);
    const Topology t = measure_topology(read_mesh(*open_mesh(bench().path(name))));
    CHECK(t.triangles == 12'001);
    CHECK(t.components == 1 + 7);
    CHECK(t.euler == 1 + 2 * 7);
    return ran.out;
  };
  simplify("here.ply", {"--finish", "here"});
  for (const std::string workers : {"1", "2", "5"}) {
    const std::string out =
        simplify("farm" + workers + ".ply", {"--finish", "farm", "--workers", workers});
    CHECK(out.find("finish           by jobs, in ") != std::string::npos);
  }
  using meshfarm::test::read_text;
  CHECK(read_text(bench().path("farm1.ply")) == read_text(bench().path("farm2.ply")));
  CHECK(read_text(bench().path("farm1.ply")) == read_text(bench().path("farm5.ply")));
}
