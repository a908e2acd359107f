// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Vertex channels (everything beside the position), from input to output of real runs.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/io/mesh_source.hpp>

#include "support/meshes.hpp"
#include "support/process.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;
using test::Ran;
using test::read_text;
namespace fs = std::filesystem;

namespace {

/// A sphere of 81,920 triangles with two colour components, normals and a heat value.
const std::vector<Channel> k_channels = {{"red", ChannelType::uint8, ChannelRole::colour},
                                         {"green", ChannelType::uint8, ChannelRole::colour},
                                         {"nx", ChannelType::float32, ChannelRole::normal},
                                         {"ny", ChannelType::float32, ChannelRole::normal},
                                         {"nz", ChannelType::float32, ChannelRole::normal},
                                         {"heat", ChannelType::float32, ChannelRole::quality}};

std::vector<float> values_at(Vec3 p) {
  const Vec3 normal = p * (1 / std::sqrt(squared_length(p)));
  std::vector<float> values;
  for (const double value :
       {std::round(127.5 + 127.5 * std::sin(3 * p.x)), std::round(127.5 + 127.5 * p.y), normal.x,
        normal.y, normal.z, 1000 * p.z}) {
    values.push_back(static_cast<float>(value));
  }
  return values;
}

struct Read {
  MeshFileInfo info;
  ChannelPoints all;
};

Read read_channels(const std::string& path) {
  const auto source = open_mesh(path);
  Read read{source->info(), {}};
  source->scan_channels([&](const ChannelPoints& batch) {
    read.all.points.insert(read.all.points.end(), batch.points.begin(), batch.points.end());
    read.all.values.insert(read.all.values.end(), batch.values.begin(), batch.values.end());
  });
  return read;
}

class Bench {
 public:
  Bench() {
    Mesh mesh = test::icosphere(6);
    std::vector<float> values;
    for (Vec3& p : mesh.positions) {
      p = rounded(p, PositionType::float32);
      const std::vector<float> here = values_at(p);
      values.insert(values.end(), here.begin(), here.end());
    }
    write_mesh(path("in.ply"), mesh, PositionType::float32, k_channels, values);
    write_mesh(path("plain.ply"), mesh, PositionType::float32);
  }
  Ran operator()(const std::vector<std::string>& words) {
    return test::run_meshfarm(words, folder_.path() / ("log" + std::to_string(++logs_)));
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  Ran simplify(const std::string& input, const std::string& output,
               const std::vector<std::string>& more) {
    std::vector<std::string> words = {"simplify", path(input), "-o",      path(output),
                                      "--ratio",  "0.05",      "--parts", "6"};
    words.insert(words.end(), more.begin(), more.end());
    return (*this)(words);
  }

 private:
  test::TempFolder folder_;
  int logs_ = 0;
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

void check_values(const std::string& path) {
  const Read read = read_channels(path);
  CHECK(read.info.channels == k_channels);
  std::vector<double> worst(k_channels.size(), 0);
  for (std::size_t v = 0; v < read.all.points.size(); ++v) {
    const std::vector<float> expected = values_at(read.all.points[v]);
    double squared = 0;
    for (std::size_t c = 0; c < worst.size(); ++c) {
      const auto value = static_cast<double>(read.all.values[v * worst.size() + c]);
      worst[c] = std::max(worst[c], std::abs(value - static_cast<double>(expected[c])));
      if (c >= 2 && c < 5) squared += value * value;
    }
    REQUIRE(squared == doctest::Approx(1).epsilon(1e-5));
  }
  const std::vector<double> allowed = {6, 3, 0.03, 0.03, 0.03, 20};
  for (std::size_t c = 0; c < worst.size(); ++c) {
    CAPTURE(k_channels[c].name);
    CHECK(worst[c] < allowed[c]);
  }
}

/// The RMS in the summary.
double red_error(const Ran& ran) {
  const std::string before = "channels         red ";
  const std::size_t at = ran.out.find(before);
  REQUIRE(at != std::string::npos);
  return std::stod(ran.out.substr(at + before.size()));
}

}  // namespace

TEST_CASE("a coloured scan comes back coloured, the same from any number of workers") {
  Bench bench;
  for (const std::string scheme : {"cut", "stream"}) {
    CAPTURE(scheme);
    const Ran ran = bench.simplify("in.ply", "1.ply", {"--scheme", scheme, "--workers", "1"});
    CHECK(ran.code == 0);
    CHECK_FALSE(read_channels(bench.path("1.ply")).all.points.empty());
    CHECK(has(ran.out, "channels         red "));
    check_values(bench.path("1.ply"));
    CHECK(bench.simplify("in.ply", "3.ply", {"--scheme", scheme, "--workers", "3"}).code == 0);
    CHECK(read_text(bench.path("1.ply")) == read_text(bench.path("3.ply")));

    // With no attributes, or with weight 0, nothing else in the result depends on the channels.
    CHECK(bench.simplify("plain.ply", "plain-out.ply", {"--scheme", scheme}).code == 0);
    const Ran without =
        bench.simplify("in.ply", "none.ply", {"--scheme", scheme, "--attributes", "none"});
    CHECK(without.code == 0);
    CHECK(has(without.out, "not kept         vertex.red, vertex.green"));
    CHECK(read_text(bench.path("none.ply")) == read_text(bench.path("plain-out.ply")));
    const Ran blind =
        bench.simplify("in.ply", "shape.ply", {"--scheme", scheme, "--weight", "colour=0"});
    CHECK(blind.code == 0);
    CHECK(read_channels(bench.path("shape.ply")).all.points ==
          read_channels(bench.path("none.ply")).all.points);
  }
  CHECK(bench.simplify("in.ply", "1.ply", {"--weight", "colour=-1"}).code == 2);
}

TEST_CASE("a finish in pieces keeps colours and normals as the sink's does") {
  Bench bench;
  const Ran here = bench.simplify("in.ply", "here.ply", {"--finish", "here"});
  REQUIRE(here.code == 0);
  for (const std::string workers : {"1", "2", "5"}) {
    const Ran ran =
        bench.simplify("in.ply", workers + ".ply",
                       {"--finish", "farm", "--composition", "sink", "--workers", workers});
    REQUIRE(ran.code == 0);
    CHECK(has(ran.out, "finish           by jobs, in 7 pieces"));
    CHECK(has(ran.out, " 4,096 triangles"));
    CHECK(red_error(ran) < 1.1 * red_error(here));
    check_values(bench.path(workers + ".ply"));
  }
  CHECK(read_text(bench.path("1.ply")) == read_text(bench.path("2.ply")));
  CHECK(read_text(bench.path("1.ply")) == read_text(bench.path("5.ply")));
}

TEST_CASE("a picture on a flat wall stays") {
  Bench bench;
  Mesh wall = test::grid(240, 160);
  std::vector<float> values;
  for (const Vec3& p : wall.positions) {
    const double x = p.x - 120;
    const double y = p.y - 80;
    values.push_back(x * x + y * y < 50.0 * 50.0 ? 250 : 10);
  }
  write_mesh(bench.path("wall.ply"), wall, PositionType::float32, {k_channels[0]}, values);
  for (const std::string scheme : {"cut", "stream"}) {
    const auto error = [&](const std::string& weight) {
      const Ran ran = bench.simplify("wall.ply", "out.ply",
                                     {"--scheme", scheme, "--weight", "colour=" + weight});
      REQUIRE(ran.code == 0);
      return red_error(ran);
    };
    CHECK(error("0.002") < 0.75 * error("0"));
  }
}

TEST_CASE("no vertex has a value beyond those of the input") {
  Bench bench;
  const Mesh wall = test::grid(240, 160);
  std::vector<float> values;
  for (const Vec3& p : wall.positions) values.push_back(p.x + 0.3 * p.y < 130 ? 0.25F : 1);
  write_mesh(bench.path("step.ply"), wall, PositionType::float32, {k_channels.back()}, values);
  for (const std::string scheme : {"cut", "stream"}) {
    REQUIRE(bench.simplify("step.ply", "out.ply", {"--scheme", scheme}).code == 0);
    for (const float value : read_channels(bench.path("out.ply")).all.values) {
      CHECK(value >= 0.25F);
      CHECK(value <= 1);
    }
  }
}

TEST_CASE("a stage holds the channels: a replay needs no input, and finds damage") {
  Bench bench;
  const std::string stage = bench.path("stage");
  CHECK(bench({"cut", bench.path("in.ply"), "--stage", stage, "--parts", "6"}).code == 0);
  CHECK(bench.simplify("in.ply", "whole.ply", {}).code == 0);
  fs::remove(bench.path("in.ply"));
  const std::vector<std::string> replay = {"replay",  stage, "-o", bench.path("again.ply"),
                                           "--ratio", "0.05"};
  CHECK(bench(replay).code == 0);
  CHECK(read_text(bench.path("again.ply")) == read_text(bench.path("whole.ply")));

  std::string bytes = read_text(stage + "/channels");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  std::ofstream(stage + "/channels", std::ios::binary) << bytes;
  const Ran damaged = bench(replay);
  CHECK(damaged.code == 1);
  CHECK(has(damaged.err, "channels"));
  CHECK(read_text(bench.path("again.ply")) == read_text(bench.path("whole.ply")));
}

TEST_CASE("info and --json name the channels") {
  Bench bench;
  const Ran info = bench({"info", bench.path("in.ply")});
  CHECK(has(info.out, "channels         red, green, nx, ny, nz, heat\n"));
  CHECK(has(bench.simplify("in.ply", "out.ply", {"--json"}).out, "\"name\": \"heat\""));
}

TEST_CASE("chosen channels are kept, by a cut or by a run of its stage, and the others named") {
  Bench bench;
  const std::string stage = bench.path("stage");
  CHECK(bench({"cut", bench.path("in.ply"), "--stage", stage, "--parts", "6"}).code == 0);
  const auto replay = [&](const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"replay", stage, "-o", bench.path(output), "--ratio", "0.05"};
    words.insert(words.end(), more.begin(), more.end());
    return bench(words);
  };
  const Ran ran = bench.simplify("in.ply", "cut.ply", {"--attributes", "heat,normals"});
  CHECK(ran.code == 0);
  CHECK(has(ran.out, "not kept         red, green\n"));
  CHECK(replay("run.ply", {"--attributes", "heat,nx,ny,nz"}).code == 0);
  CHECK(read_text(bench.path("cut.ply")) == read_text(bench.path("run.ply")));
  CHECK(read_channels(bench.path("cut.ply")).info.channels ==
        std::vector<Channel>(k_channels.begin() + 2, k_channels.end()));

  CHECK(bench.simplify("plain.ply", "plain-out.ply", {}).code == 0);
  CHECK(replay("none.ply", {"--attributes", "none"}).code == 0);
  CHECK(read_text(bench.path("none.ply")) == read_text(bench.path("plain-out.ply")));

  const std::string there = "no channel 'blue'; there are: red, green, nx, ny, nz, heat";
  for (const Ran& wrong : {bench.simplify("in.ply", "x.ply", {"--attributes", "red,blue"}),
                           replay("x.ply", {"--attributes", "blue"})}) {
    CAPTURE(wrong.err);
    CHECK(wrong.code == 2);
    CHECK(has(wrong.err, there));
    CHECK(std::count(wrong.err.begin(), wrong.err.end(), '\n') == 1);
    CHECK_FALSE(fs::exists(bench.path("x.ply")));
  }
}

TEST_CASE("a run of a stage of streams takes colours back as if they had not been there") {
  Bench bench;
  const std::string stage = bench.path("stage");
  const std::vector<std::string> streams = {"--scheme", "stream"};
  CHECK(bench({"cut", bench.path("in.ply"), "--stage", stage, "--parts", "6", "--scheme", "stream"})
            .code == 0);
  CHECK(bench({"replay", stage, "-o", bench.path("none.ply"), "--ratio", "0.05", "--attributes",
               "none"})
            .code == 0);
  CHECK(bench.simplify("plain.ply", "plain-out.ply", streams).code == 0);
  CHECK(read_text(bench.path("none.ply")) == read_text(bench.path("plain-out.ply")));
}

TEST_CASE("normals are blended, recomputed or dropped") {
  Bench bench;
  const std::string stage = bench.path("stage");
  CHECK(bench({"cut", bench.path("in.ply"), "--stage", stage, "--parts", "6"}).code == 0);
  const auto simplify = [&](const std::string& output, const std::string& normals) {
    CAPTURE(normals);
    Ran ran = bench.simplify("in.ply", output, {"--normals", normals});
    CHECK(ran.code == 0);
    CHECK(bench({"replay", stage, "-o", bench.path("again.ply"), "--ratio", "0.05", "--normals",
                 normals})
              .code == 0);
    CHECK(read_text(bench.path("again.ply")) == read_text(bench.path(output)));
    return ran;
  };
  simplify("blend.ply", "blend");
  CHECK(bench.simplify("in.ply", "out.ply", {}).code == 0);
  CHECK(read_text(bench.path("out.ply")) == read_text(bench.path("blend.ply")));

  simplify("recompute.ply", "recompute");
  const Read made = read_channels(bench.path("recompute.ply"));
  const Read blended = read_channels(bench.path("blend.ply"));
  REQUIRE(made.info.channels == k_channels);
  CHECK(made.all.points == blended.all.points);
  std::size_t other = 0;
  for (std::size_t i = 0; i < made.all.values.size(); ++i) {
    const std::size_t c = i % k_channels.size();
    const bool is_normal = c >= 2 && c < 5;
    if (!is_normal) REQUIRE(made.all.values[i] == blended.all.values[i]);
    other += made.all.values[i] != blended.all.values[i] ? 1 : 0;
  }
  CHECK(other > made.all.points.size());
  for (std::size_t v = 0; v < made.all.points.size(); ++v) {
    const std::vector<float> expected = values_at(made.all.points[v]);
    double along = 0;
    for (std::size_t c = 2; c < 5; ++c) {
      along += static_cast<double>(expected[c]) *
               static_cast<double>(made.all.values[v * k_channels.size() + c]);
    }
    REQUIRE(along > 0.99);
  }

  const Ran dropped = simplify("drop.ply", "drop");
  CHECK(has(dropped.out, "not kept         nx, ny, nz: not asked for\n"));
  CHECK(read_channels(bench.path("drop.ply")).info.channels.size() == 3);
  CHECK(read_channels(bench.path("drop.ply")).all.points == blended.all.points);
  CHECK(bench.simplify("in.ply", "x.ply", {"--normals", "some"}).code == 2);
}

TEST_CASE("recomputed normals point to the side that the input's do") {
  Bench bench;
  Mesh sphere = test::icosphere(5);
  for (Triangle& t : sphere.triangles) std::swap(t[0], t[1]);
  std::vector<float> values;
  for (Vec3& p : sphere.positions) {
    p = rounded(p, PositionType::float32);
    for (const double x : {p.x, p.y, p.z}) values.push_back(static_cast<float>(x));
  }
  const std::vector<Channel> normals(k_channels.begin() + 2, k_channels.begin() + 5);
  write_mesh(bench.path("turned.ply"), sphere, PositionType::float32, normals, values);
  CHECK(bench.simplify("turned.ply", "out.ply", {"--normals", "recompute"}).code == 0);
  const Read made = read_channels(bench.path("out.ply"));
  REQUIRE_FALSE(made.all.points.empty());
  for (std::size_t v = 0; v < made.all.points.size(); ++v) {
    const Vec3 normal{static_cast<double>(made.all.values[3 * v]),
                      static_cast<double>(made.all.values[3 * v + 1]),
                      static_cast<double>(made.all.values[3 * v + 2])};
    REQUIRE(dot(normal, made.all.points[v]) > 0.9);
  }
}
