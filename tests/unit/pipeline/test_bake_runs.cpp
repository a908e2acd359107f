// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Runs that make a new texture, without their processes: cut, jobs and finish called in turn.
#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/io/material_colours.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/pipeline/assemble.hpp>
#include <meshfarm/pipeline/bake_job.hpp>
#include <meshfarm/pipeline/job_table.hpp>
#include <meshfarm/pipeline/run_graph.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

#include "support/meshes.hpp"
#include "support/next_jobs.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

constexpr std::uint32_t k_size = 60;
const RunOptions k_run = {.triangles = 400, .textures = TextureMode::bake, .texture_size = 256};

/// A picture of one colour.
std::string plain_picture(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  std::vector<std::uint8_t> texels;
  for (int i = 0; i < 64 * 64; ++i) texels.insert(texels.end(), {red, green, blue});
  return encoded_picture(64, std::move(texels), PictureCoding::png);
}

/// A wavy sheet of two materials, the left half and the right one, with a picture each. A third
/// picture is a map of normals.
void write_sheet(const std::filesystem::path& path, const std::vector<std::string>& files) {
  Mesh mesh = test::grid(k_size, k_size);
  for (Vec3& p : mesh.positions) p.z = std::sin(p.x * 0.3) * std::cos(p.y * 0.2);
  for (Vec3& p : mesh.positions) p = rounded(p, PositionType::float32);
  for (const Triangle& t : mesh.triangles) {
    CornerUvs& uvs = mesh.columns.uvs.emplace_back();
    double x = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.positions[t[k]];
      uvs[k] = {static_cast<float>(p.x) / k_size, static_cast<float>(p.y) / k_size};
      x += p.x / 3;
    }
    mesh.columns.labels.push_back(x < k_size / 2.0 ? 0 : 1);
  }
  LabelMeaning labels{"material", {{.name = "left"}, {.name = "right"}}};
  labels.materials[0].maps = {{MapUse::colour, 0}, {MapUse::normal, 2}};
  labels.materials[1].maps = {{MapUse::colour, 1}};
  const PictureFiles pictures{{"left.png", "right.png", "bumps.png"},
                              [&](std::size_t i) { return files[i]; }};
  write_mesh(path, mesh, PositionType::float32, {}, {}, labels, pictures);
}

class BakeBench {
 public:
  explicit BakeBench(const std::string& right = plain_picture(0, 0, 255))
      : stage_(Stage::create(folder_.path() / "stage")) {
    const auto input = folder_.path() / "in.obj";
    write_sheet(input, {plain_picture(255, 0, 0), right, plain_picture(1, 2, 3)});
    const auto source = open_mesh(input, {.textures = Textures::keep});
    manifest_ = cut_mesh(*source, stage_, {.parts = 4});
  }

  /// Does all jobs; `sink` does those of the sink.
  void run(Assembler& sink) {
    const JobSource jobs_of = make_job_source(manifest_, k_run);
    for (std::vector<Job> jobs = test::next_jobs(jobs_of, accepted_); !jobs.empty();
         jobs = test::next_jobs(jobs_of, accepted_)) {
      const std::vector<AcceptedJob> before = accepted_;
      for (const Job& job : jobs) {
        ++kinds_[job.kind];
        if (job.kind == k_bake_kind) bake_memory_ = job.memory;
        JobOutput output =
            job.by_sink ? sink.do_job(job, context(), before) : do_job(job, context());
        check_output(job.kind, output);
        accepted_.push_back({key_of(job), std::move(output)});
      }
    }
  }
  Assembler sink(const std::string& output) {
    return Assembler(stage_, manifest_, k_run, {.output = {folder_.path() / output}});
  }
  JobContext context() const {
    return {stage_, 1, 7, [](std::uint64_t) { return true; }};
  }
  const Stage& stage() const { return stage_; }
  const std::vector<AcceptedJob>& accepted() const { return accepted_; }
  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }
  std::map<std::string, int>& kinds() { return kinds_; }
  std::uint64_t bake_memory() const { return bake_memory_; }
  std::uint64_t memory_told() const { return memory_wanted(manifest_, k_run); }

 private:
  test::TempFolder folder_;
  Stage stage_;
  Manifest manifest_;
  std::vector<AcceptedJob> accepted_;
  std::map<std::string, int> kinds_;
  std::uint64_t bake_memory_ = 0;
};

/// The greatest error of a level at the middle of a triangle: it should be red on the left,
/// `right` on the right.
float worst_level(const std::filesystem::path& path, const std::array<float, 3>& right) {
  const auto source = open_mesh(path, {.textures = Textures::keep});
  const MeshFileInfo info = source->info();
  const Mesh mesh = read_mesh(*source);
  const MaterialColours colours(*info.labels, info.pictures, {.name = "result"});
  float worst = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    Uv middle{};
    double lowest = k_size, highest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = mesh.positions[mesh.triangles[t][k]].x;
      lowest = std::min(lowest, x);
      highest = std::max(highest, x);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        middle[axis] += mesh.columns.uvs[t][k][axis] / 3;
      }
    }
    if (lowest < k_size / 2.0 + 2 && highest > k_size / 2.0 - 2) continue;
    const std::array<float, 3> wanted =
        highest < k_size / 2.0 ? std::array<float, 3>{1, 0, 0} : right;
    const std::array<float, 3> seen = colours.at(mesh.columns.labels[t], middle, 1);
    for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(seen[c] - wanted[c]));
  }
  return worst;
}

}  // namespace

TEST_CASE("a new texture has the colours of all pictures, found by jobs") {
  BakeBench bench;
  Assembler sink = bench.sink("o.glb");
  bench.run(sink);
  CHECK(bench.kinds()["finish"] == 1);
  CHECK(bench.kinds()["tile"] == 2);  // not the map of normals
  CHECK(bench.kinds()["bake"] == 1);
  CHECK(bench.bake_memory() < std::uint64_t{160} << 20);  // the input is small
  CHECK(bench.memory_told() >= bench.bake_memory());      // before any of it is done
  const RunSummary summary = sink.complete(bench.accepted());
  CHECK(summary.triangles == 400);
  CHECK(summary.textures.way == TexturesMade::Way::baked);
  CHECK(summary.textures.size == 256);
  CHECK(worst_level(bench.path("o.glb"), {0, 0, 1}) < 0.02F);
}

TEST_CASE("a sink that did not finish the mesh itself makes the same of what is accepted") {
  BakeBench bench;
  Assembler first = bench.sink("first.ply");
  bench.run(first);
  first.complete(bench.accepted());
  Assembler second = bench.sink("second.ply");
  second.complete(bench.accepted());
  CHECK(read_file(bench.path("first_texture.png")) == read_file(bench.path("second_texture.png")));
  const std::string bytes = read_file(bench.path("second.ply"));
  const std::size_t name = bytes.find("second_texture.png");
  REQUIRE(name != std::string::npos);
  CHECK(std::string(bytes).replace(name, 6, "first") == read_file(bench.path("first.ply")));
}

TEST_CASE("what a damaged picture covers has its material's colour, the rest has its own") {
  std::string cut = plain_picture(0, 0, 255);
  cut.resize(cut.size() - 20);
  for (const std::string& damaged : {cut, std::string("no picture at all")}) {
    BakeBench bench(damaged);
    Assembler sink = bench.sink("o.glb");
    bench.run(sink);
    CHECK(sink.complete(bench.accepted()).triangles == 400);
    CHECK(worst_level(bench.path("o.glb"), {1, 1, 1}) < 0.02F);
  }
}

TEST_CASE("jobs of a new texture refuse what is not theirs") {
  BakeBench bench;
  Assembler sink = bench.sink("o.glb");
  bench.run(sink);
  const JobContext context = bench.context();
  for (const std::string_view kind : {k_tile_kind, k_bake_kind, k_finish_kind}) {
    for (const std::string& parameters : {std::string(), std::string("\1abc"), std::string("\2")}) {
      CHECK_THROWS_AS(do_job({std::string(kind), {}, parameters}, context), DataError);
    }
  }
  CHECK_THROWS_AS(sink.do_job({std::string(k_bake_kind), {}, {}}, context, {}), DataError);
  const std::string two = encode_parameters(TileParameters{{0, 1}});
  CHECK_THROWS_AS(do_job({std::string(k_tile_kind), {}, two}, context), DataError);
  // The last job baked the only chunk.
  const JobOutput& finished = bench.accepted()[bench.accepted().size() - 4].output;
  const FinishSummary summary = decode_finish_summary(finished.summary, "summary");
  const std::string beyond = encode_parameters(BakeParameters{finished.file, summary.scene, 1, {}});
  CHECK_THROWS_AS(do_job({std::string(k_bake_kind), {}, beyond}, context), DataError);
  const JobContext given_up{bench.stage(), 2, 7, [](std::uint64_t) { return false; }};
  const std::string chunk = encode_parameters(BakeParameters{finished.file, summary.scene, 0, {}});
  CHECK_THROWS_AS(do_job({std::string(k_bake_kind), {}, chunk}, given_up), IncompleteError);
  CHECK_THROWS_AS(check_output(k_bake_kind, {{}, "more"}), DataError);
  CHECK_THROWS_AS(check_output(k_tile_kind, {{}, "more"}), DataError);
  CHECK_THROWS_AS(check_output(k_finish_kind, {{}, "more"}), DataError);
}
