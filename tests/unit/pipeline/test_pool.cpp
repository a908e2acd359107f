// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <filesystem>

#include <doctest/doctest.h>

#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/pool.hpp>
#include <meshfarm/report/trace.hpp>

#include "support/temp_folder.hpp"

using namespace meshfarm;
namespace fs = std::filesystem;

namespace {

/// A cut stage of `triangles` triangles.
Stage stage_of(const fs::path& folder, std::uint64_t triangles) {
  Stage stage = Stage::create(folder);
  Manifest manifest;
  manifest.parts.resize(1);
  manifest.parts[0].triangles = triangles;
  manifest.parts[0].file.name = to_string(PartName{1});
  manifest.boundary.emplace_back().file.name = to_string(BoundaryName{});
  stage.publish(ManifestName{}, encode_manifest(manifest));
  return stage;
}

std::uint32_t begin_run(const Stage& stage, std::uint64_t run) {
  return publish_endpoint(stage, {0, run, "tcp://a", "host", 1, {}}, "u").epoch;
}

void tell(const Stage& stage, std::uint32_t epoch, std::uint64_t run, std::size_t workers,
          std::uint64_t done) {
  TraceHead head;
  head.epoch = epoch;
  head.run = run;
  TraceState state;
  state.jobs_known = 10;
  state.triangles_known = 1000;
  state.triangles_done = done;
  state.workers.resize(workers);
  stage.publish(TraceName{epoch}, to_line(head) + "\n" + to_line(state) + "\n");
}

}  // namespace

TEST_CASE("the run with the fewest workers for its work comes first") {
  CHECK_FALSE(neediest({}));
  std::vector<PoolRun> runs = {{"a", 1, 1, 3, 1000}, {"b", 2, 1, 0, 300}, {"c", 3, 1, 1, 450}};
  CHECK(neediest(runs)->stage == "b");
  runs[1].workers = 1;
  CHECK(neediest(runs)->stage == "a");
  runs[0].workers = 4;
  CHECK(neediest(runs)->stage == "c");
}

TEST_CASE("a pool is the live runs of the stages in a folder, or linked there") {
  const test::TempFolder folder;
  const fs::path pool = folder / "pool";
  fs::create_directory(pool);
  CHECK(runs_of_pool(pool).empty());
  CHECK_THROWS(runs_of_pool(folder / "none"));
  const Stage here = stage_of(pool / "here", 500);
  const Stage far = stage_of(folder / "far", 500);
  fs::create_directory_symlink(folder / "far", pool / "far");
  Stage::create(pool / "being cut");
  CHECK(runs_of_pool(pool).empty());

  const std::uint32_t over = begin_run(here, 7);
  publish_endpoint(here, {0, 7, "", "host", 1, {}}, "u");
  const std::uint32_t new_run = begin_run(here, 8);
  const std::uint32_t old_run = begin_run(far, 9);
  tell(here, over, 7, 1, 0);
  tell(far, old_run, 9, 2, 400);
  const std::vector<PoolRun> runs = runs_of_pool(pool);
  REQUIRE(runs.size() == 2);
  CHECK(runs[0] == PoolRun{pool / "far", 9, old_run, 2, 600});
  CHECK(runs[1] == PoolRun{pool / "here", 8, new_run, 0, 500});  // it has told nothing yet
  tell(far, old_run, 9, 2, 1000);
  CHECK(runs_of_pool(pool).size() == 1);  // nothing is left to give out there
}
