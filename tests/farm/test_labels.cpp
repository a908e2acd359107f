// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Triangle labels and materials, from input to output of real runs.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/io/mesh_source.hpp>

#include "support/meshes.hpp"
#include "support/process.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;
using test::Ran;
using test::read_text;

namespace {

const LabelMeaning k_materials{
    "material",
    {{"stone", {0.5F, 0.25F, 1, 1}}, {"glass", {0, 1, 0, 0.5F}}, {"steel", {1, 1, 1, 1}}}};

/// Three slices of a sphere.
Label slice_at(Vec3 p) {
  return p.z > 0.4 ? 2 : (p.z > -0.2 ? 1 : 0);
}

/// The material lines of the input are jagged, by about the size of its triangles.
constexpr double k_jags = 0.03;

double distance_to_line(double z) {
  return std::min(std::abs(z - 0.4), std::abs(z + 0.2));
}

Vec3 centre_of(const Mesh& mesh, const Triangle& t) {
  return (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) * (1.0 / 3);
}

/// The edges between two materials.
std::vector<std::pair<Vec3, Vec3>> lines_of(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::set<Label>> edges;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      edges[std::minmax(t[k], t[(k + 1) % 3])].insert(mesh.columns.labels[i]);
    }
  }
  std::vector<std::pair<Vec3, Vec3>> lines;
  for (const auto& [edge, labels] : edges) {
    if (labels.size() > 1)
      lines.emplace_back(mesh.positions[edge.first], mesh.positions[edge.second]);
  }
  return lines;
}

class Bench {
 public:
  Bench() {
    for (const char* each : {"1", "3"}) std::filesystem::create_directories(path(each));
    Mesh mesh = test::icosphere(6);
    for (Vec3& p : mesh.positions) p = rounded(p, PositionType::float32);
    for (const Triangle& t : mesh.triangles)
      mesh.columns.labels.push_back(slice_at(centre_of(mesh, t)));
    write_mesh(path("in.obj"), mesh, PositionType::float32, {}, {}, k_materials);
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  Ran operator()(const std::vector<std::string>& words) {
    return test::run_meshfarm(words, folder_.path() / ("log" + std::to_string(++logs_)));
  }
  Ran simplify(const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"simplify", path("in.obj"), "-o",      path(output),
                                      "--ratio",  "0.02",         "--parts", "6"};
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

std::vector<Material> materials_of(const std::string& path) {
  const auto labels = open_mesh(path)->info().labels;
  REQUIRE(labels.has_value());
  return labels->materials;
}

/// Materials are numbered in the order of their first use in the file.
void check_slices(const std::string& path, const std::vector<Material>& materials) {
  const auto source = open_mesh(path);
  REQUIRE(source->info().labels.has_value());
  const Mesh mesh = read_mesh(*source);
  CHECK(mesh.triangles.size() == 1638);
  REQUIRE(mesh.columns.labels.size() == mesh.triangles.size());
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vec3 centre = centre_of(mesh, mesh.triangles[i]);
    if (distance_to_line(centre.z) < k_jags) continue;
    REQUIRE(mesh.columns.labels[i] < materials.size());
    wrong += materials[mesh.columns.labels[i]].name != k_materials.materials[slice_at(centre)].name
                 ? 1
                 : 0;
  }
  CHECK(wrong == 0);
  double length_of_lines = 0;
  for (const auto& [a, b] : lines_of(mesh)) {
    CHECK(distance_to_line((a.z + b.z) / 2) < k_jags);
    length_of_lines += length(b - a);
  }
  const double circles = 2 * 3.14159265 * (std::sqrt(1 - 0.16) + std::sqrt(1 - 0.04));
  // Jags of single triangles that remain make the lines longer.
  CHECK(length_of_lines == doctest::Approx(circles).epsilon(0.15));
}

}  // namespace

TEST_CASE("a finish in pieces keeps materials and their lines, which cross the pieces") {
  Bench bench;
  for (const std::string workers : {"1", "3"}) {
    const Ran ran = bench.simplify(
        workers + "/o.obj", {"--finish", "farm", "--composition", "sink", "--workers", workers});
    REQUIRE(ran.code == 0);
    CHECK(has(ran.out, "finish           by jobs, in 7 pieces"));
    check_slices(bench.path(workers + "/o.obj"), materials_of(bench.path(workers + "/o.obj")));
  }
  CHECK(read_text(bench.path("1/o.obj")) == read_text(bench.path("3/o.obj")));
}

TEST_CASE("materials come back with their lines, the same from any number of workers") {
  Bench bench;
  for (const std::string scheme : {"cut", "stream"}) {
    for (const std::string sort : {"here", "farm"}) {
      if (scheme == "cut" && sort == "farm") continue;
      CAPTURE(scheme);
      CAPTURE(sort);
      std::vector<std::string> words = {"--scheme", scheme};
      if (scheme == "stream") words.insert(words.end(), {"--sort", sort});
      std::vector<std::string> one = words;
      one.insert(one.end(), {"--workers", "1"});
      std::vector<std::string> three = words;
      three.insert(three.end(), {"--workers", "3"});
      const Ran ran = bench.simplify("1/out.obj", one);
      CHECK(ran.code == 0);
      CHECK(has(ran.out, "labels           material: 3 ("));
      check_slices(bench.path("1/out.obj"), materials_of(bench.path("1/out.obj")));
      CHECK(bench.simplify("3/out.obj", three).code == 0);
      for (const std::string name : {"/out.obj", "/out.mtl"}) {
        CHECK(read_text(bench.path("1" + name)) == read_text(bench.path("3" + name)));
      }
    }
  }
}

TEST_CASE("materials within a bound of the error, and as GLB and PLY") {
  Bench bench;
  CHECK(bench({"simplify", bench.path("in.obj"), "-o", bench.path("out.glb"), "--error", "0.5%",
               "--parts", "6"})
            .code == 0);
  const Mesh mesh = read_mesh(*open_mesh(bench.path("out.glb")));
  REQUIRE(mesh.columns.labels.size() == mesh.triangles.size());
  CHECK(std::set<Label>(mesh.columns.labels.begin(), mesh.columns.labels.end()).size() == 3);
  const Ran ran = bench.simplify("out.ply", {});
  CHECK(has(ran.out, "labels           material: numbers"));
  CHECK(has(ran.out, "names and colours of materials"));
  check_slices(bench.path("out.ply"), materials_of(bench.path("in.obj")));
}

TEST_CASE("labels that would leave no choice are dropped, unless they are asked for") {
  Bench bench;
  Mesh mesh = test::icosphere(4);  // 5,120 triangles
  for (Label i = 0; i < mesh.triangles.size(); ++i) mesh.columns.labels.push_back(i / 2);
  write_mesh(bench.path("fine.ply"), mesh, PositionType::float64, {}, {},
             LabelMeaning{"region", {}});
  for (const std::string scheme : {"cut", "stream"}) {
    CAPTURE(scheme);
    const std::string out = bench.path("fine-" + scheme + ".ply");
    std::vector<std::string> words = {
        "simplify", bench.path("fine.ply"), "-o", out, "--ratio", "0.1", "--parts", "3", "--scheme",
        scheme};
    const Ran ran = bench(words);
    CHECK(ran.code == 0);
    CHECK(has(ran.out, "region: its lines hold about "));
    const Mesh free = read_mesh(*open_mesh(out));
    CHECK(free.columns.labels.empty());
    CHECK(free.triangles.size() == 512);
    words.insert(words.end(), {"--stage", bench.path("stage-" + scheme), "--attributes", "region"});
    CHECK(bench(words).code == 0);
    const Mesh held = read_mesh(*open_mesh(out));
    CHECK(held.columns.labels.size() == held.triangles.size());
    CHECK(held.triangles.size() > 2000);
  }
}

TEST_CASE("materials that are not wanted hold nothing back, and it is said") {
  Bench bench;
  const Ran none = bench.simplify("none.ply", {"--attributes", "none"});
  CHECK(none.code == 0);
  CHECK(read_mesh(*open_mesh(bench.path("none.ply"))).columns.labels.empty());
  CHECK(has(none.out, "not kept"));
  const Ran stl = bench.simplify("out.stl", {});
  CHECK(stl.code == 0);
  CHECK(has(stl.out, "material: the output's format has no place for them"));

  CHECK(bench({"cut", bench.path("in.obj"), "--stage", bench.path("stage"), "--parts", "6"}).code ==
        0);
  const Ran replay = bench({"replay", bench.path("stage"), "-o", bench.path("replay.ply"),
                            "--ratio", "0.02", "--attributes", "none"});
  CHECK(replay.code == 0);
  CHECK(has(replay.out, "not kept         material: not asked for"));
  CHECK(read_mesh(*open_mesh(bench.path("replay.ply"))).columns.labels.empty());
}
