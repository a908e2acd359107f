// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Runs that cut their input themselves end like runs on a stage that was cut before.
#include <algorithm>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <utility>

#include <doctest/doctest.h>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/io/ply_writer.hpp>
#include <meshfarm/pipeline/assemble.hpp>
#include <meshfarm/pipeline/cut_job.hpp>
#include <meshfarm/pipeline/job_table.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/pipeline/run_graph.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

#include "support/meshes.hpp"
#include "support/next_jobs.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

constexpr std::uint32_t k_parts = 12;  // two jobs join the boundary

/// A torus where some triangles have vertices of their own, and some have no area.
Mesh partly_torn() {
  Mesh mesh = test::torus(100, 50);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 7) {
    for (std::uint32_t& v : mesh.triangles[i]) {
      mesh.positions.push_back(mesh.positions[v]);
      v = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    }
  }
  for (std::uint32_t i = 0; i < 500; ++i) mesh.triangles.push_back({3 * i, 3 * i, 3 * i + 1});
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(3));
  return mesh;
}

struct StagedRun {
  Stage stage;
  Manifest manifest;
};

StagedRun cut_here(const std::filesystem::path& file, const std::filesystem::path& folder) {
  Stage stage = Stage::create(folder);
  const auto source = open_mesh(file);
  Manifest manifest = cut_mesh(*source, stage, {.parts = k_parts});
  return {stage, std::move(manifest)};
}

StagedRun plan_for_farm(const std::filesystem::path& file, const std::filesystem::path& folder,
                        std::uint32_t blocks) {
  const Stage stage = Stage::create(folder);
  const auto source = open_mesh(file);
  Manifest manifest;
  manifest.positions = source->info().positions;
  manifest.input_vertices = source->info().vertices;
  manifest.input_triangles = source->info().faces;
  manifest.cutting = plan_cutting(file, {k_parts, blocks});
  REQUIRE(manifest.cutting.has_value());
  stage.publish(ManifestName{}, encode_manifest(manifest));
  return {stage, decode_manifest(stage.read(ManifestName{}), "manifest")};
}

std::vector<AcceptedJob> do_all(const JobSource& source, const Stage& stage,
                                std::vector<Job>* done = nullptr) {
  const JobContext context{stage, 1, 7, [](std::uint64_t) { return true; }};
  std::vector<AcceptedJob> accepted;
  const auto next = [&] { return test::next_jobs(source, accepted); };
  for (std::vector<Job> jobs = next(); !jobs.empty(); jobs = next()) {
    std::reverse(jobs.begin(), jobs.end());  // not in the order in which they were asked for
    for (const Job& job : jobs) {
      accepted.push_back({key_of(job), do_job(job, context)});
      check_output(job.kind, accepted.back().output);
      if (done != nullptr) done->push_back(job);
    }
  }
  return accepted;
}

std::vector<Job> jobs_of_workers(const StagedRun& staged, const RunOptions& run) {
  const JobSource source = make_job_source(staged.manifest, run);
  const JobContext context{staged.stage, 1, 7, [](std::uint64_t) { return true; }};
  std::vector<AcceptedJob> accepted;
  std::vector<Job> done;
  for (bool any = true; std::exchange(any, false);) {
    for (const Job& job : test::next_jobs(source, accepted)) {
      if (job.by_sink) continue;
      any = true;
      accepted.push_back({key_of(job), do_job(job, context)});
      done.push_back(job);
    }
  }
  return done;
}

struct RunEnd {
  std::string bytes;
  RunSummary summary;
};

RunEnd end_of(const StagedRun& staged, const RunOptions& run, const std::filesystem::path& output) {
  const auto accepted = do_all(make_job_source(staged.manifest, run), staged.stage);
  RunEnd end;
  end.summary =
      Assembler(staged.stage, staged.manifest, run, {.output = {output}}).complete(accepted);
  end.bytes = read_file(output);
  return end;
}

}  // namespace

TEST_CASE("a run that cuts by blocks makes the bytes of one whose input was cut") {
  const test::TempFolder folder;
  const auto file = folder.path() / "mesh.ply";
  write_ply(file, partly_torn(), PositionType::float32);
  const StagedRun here = cut_here(file, folder.path() / "here");
  RunOptions uniform{.ratio = 0.2};
  uniform.allocation = Allocation::uniform;
  const RunOptions bounded{.error = {0.004, true}};
  RunOptions certified = bounded;
  certified.certify = true;
  int number = 0;
  for (const RunOptions& run :
       {RunOptions{.ratio = 0.05}, RunOptions{.triangles = 900}, uniform, bounded, certified}) {
    CAPTURE(++number);
    const RunEnd expected = end_of(here, run, folder.path() / "here.ply");
    CHECK(expected.summary.triangles < 9'000);
    for (const std::uint32_t blocks : {1U, 3U, 17U}) {
      CAPTURE(blocks);
      const StagedRun farm = plan_for_farm(
          file, folder.path() / ("farm" + std::to_string(blocks) + "-" + std::to_string(number)),
          blocks);
      const RunEnd made = end_of(farm, run, folder.path() / "farm.ply");
      CHECK(made.bytes == expected.bytes);
      CHECK(made.summary.target == expected.summary.target);
      CHECK(made.summary.dropped_degenerate == expected.summary.dropped_degenerate);
      CHECK(made.summary.error.to_input.max == expected.summary.error.to_input.max);
      const Manifest& m = made.summary.manifest;
      CHECK(m.triangles() == here.manifest.triangles());
      CHECK(m.coincident_vertices == here.manifest.coincident_vertices);
      CHECK(m.coincident_corners == here.manifest.coincident_corners);
      CHECK(m.dropped_duplicate == here.manifest.dropped_duplicate);
      CHECK(m.boundary_triangles == here.manifest.boundary_triangles);
      CHECK(read_boundary(farm.stage, m.boundary) ==
            read_boundary(here.stage, here.manifest.boundary));
      CHECK(m.box.hi == here.manifest.box.hi);
    }
  }
}

TEST_CASE("what the jobs of a cut take is told before, and their messages are short") {
  const test::TempFolder folder;
  const auto file = folder.path() / "mesh.ply";
  write_ply(file, test::torus(120, 60), PositionType::float32);
  const StagedRun farm = plan_for_farm(file, folder.path() / "farm", 64);
  const RunOptions run{.ratio = 0.1};
  CHECK(farm.manifest.triangles() == 14'400);
  CHECK(run_key(farm.manifest, run) != run_key(farm.manifest, {.ratio = 0.1000001}));
  CHECK(memory_wanted(farm.manifest, run) > std::uint64_t{16} << 20);
  std::vector<Job> jobs;
  do_all(make_job_source(farm.manifest, run), farm.stage, &jobs);
  std::size_t surveys = 0;
  for (const Job& job : jobs) {
    if (job.kind == k_survey_kind) ++surveys;
    CHECK(job.memory <= memory_wanted(farm.manifest, run));
    if (!job.by_sink) CHECK(job.parameters.size() < 48 * 1024);
  }
  CHECK(surveys == 64);
}

TEST_CASE("jobs that read the same block or part tell so") {
  const test::TempFolder folder;
  const auto file = folder.path() / "mesh.ply";
  write_ply(file, test::torus(120, 60), PositionType::float32);
  const StagedRun farm = plan_for_farm(file, folder.path() / "farm", 5);
  RunOptions run{.ratio = 0.1};
  run.finish_place = FinishPlace::farm;
  run.composition = Composition::sink;
  std::map<std::string, std::set<std::uint64_t>> extents;
  std::map<std::string, std::size_t> jobs;
  for (const Job& job : jobs_of_workers(farm, run)) {
    if (job.extent.name == 0) continue;
    extents[job.kind].insert(job.extent.name);
    ++jobs[job.kind];
    CHECK(job.extent.bytes <= job.reads);
    CHECK(job.extent.bytes > 0);
  }
  CHECK(extents[std::string(k_survey_kind)].size() == 5);
  CHECK(extents[std::string(k_count_kind)] == extents[std::string(k_survey_kind)]);
  CHECK(extents[std::string(k_vertices_kind)] == extents[std::string(k_survey_kind)]);
  CHECK(extents[std::string(k_simplify_kind)].size() == k_parts);
  CHECK(extents[std::string(k_measure_kind)] == extents[std::string(k_simplify_kind)]);
  CHECK(jobs[std::string(k_measure_kind)] == k_parts);
}

TEST_CASE("an input that was changed, or is not to be seen, may be another host's to read") {
  const test::TempFolder folder;
  const auto file = folder.path() / "mesh.ply";
  write_ply(file, test::torus(20, 10), PositionType::float32);
  const StagedRun farm = plan_for_farm(file, folder.path() / "farm", 2);
  const JobContext context{farm.stage, 1, 7, [](std::uint64_t) { return true; }};
  const Job job = test::next_jobs(make_job_source(farm.manifest, {.ratio = 0.1}), {}).front();
  CHECK_NOTHROW(do_job(job, context));
  std::ofstream(file, std::ios::app) << "more";
  CHECK_THROWS_AS(do_job(job, context), UnreadDataError);
  std::filesystem::remove(file);
  CHECK_THROWS_AS(do_job(job, context), UnreadIoError);
}
