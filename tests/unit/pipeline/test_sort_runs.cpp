// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Slabs sorted by the farm: they become the streams, samples and boundary that the cut makes by
// itself.
#include <algorithm>
#include <fstream>
#include <numeric>
#include <random>

#include <doctest/doctest.h>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/io/slab_file.hpp>
#include <meshfarm/pipeline/assemble.hpp>
#include <meshfarm/pipeline/job_table.hpp>
#include <meshfarm/pipeline/run_graph.hpp>
#include <meshfarm/pipeline/sort_job.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

#include "support/memory_source.hpp"
#include "support/meshes.hpp"
#include "support/next_jobs.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

/// A torus as a soup in no order, with some triangles of no area. There is something to weld and
/// to drop both inside slabs and on the boundaries between them.
Mesh shuffled_soup() {
  const Mesh torus = test::torus(120, 60);
  std::vector<Triangle> triangles = torus.triangles;
  for (std::uint32_t i = 0; i < 2000; ++i) triangles.push_back({3 * i, 3 * i, 3 * i + 1});
  std::shuffle(triangles.begin(), triangles.end(), std::mt19937(3));
  Mesh soup;
  for (const Triangle& t : triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t v : t) soup.positions.push_back(torus.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

/// Two tori that touch at many points, also where slabs meet.
Mesh touching() {
  Mesh mesh = test::torus(100, 40);
  for (Vec3& p : mesh.positions) p.x = std::round(8 * p.x) / 8;
  return test::touching_twice(mesh, mesh.positions[0]);
}

struct Staged {
  Stage stage;
  Manifest manifest;
};

Staged generate(const Mesh& mesh, CutOptions options, SortAt sort,
                const std::filesystem::path& folder) {
  test::MemorySource source(mesh);
  Stage stage = Stage::create(folder);
  options.sort = sort;
  Manifest manifest = cut_mesh(source, stage, options);
  // As a run finds it.
  return {stage, decode_manifest(stage.read(ManifestName{}), "manifest")};
}

JobContext context_of(const Stage& stage) {
  return {stage, 1, 7, [](std::uint64_t) { return true; }};
}

/// Only the jobs of slabs, or all.
enum class Which { of_slabs, all };

std::vector<AcceptedJob> do_jobs(const JobSource& source, const Stage& stage, Which which,
                                 std::vector<std::string>* kinds = nullptr) {
  std::vector<AcceptedJob> accepted;
  const auto next = [&] {
    std::vector<Job> jobs = test::next_jobs(source, accepted);
    std::erase_if(jobs, [&](const Job& job) {
      return which == Which::of_slabs && job.kind != k_sort_kind && job.kind != k_sample_kind;
    });
    return jobs;
  };
  for (std::vector<Job> jobs = next(); !jobs.empty(); jobs = next()) {
    for (const Job& job : jobs) {
      accepted.push_back({key_of(job), do_job(job, context_of(stage))});
      if (kinds != nullptr) kinds->push_back(job.kind);
    }
  }
  return accepted;
}

bool same_content(const FileRef& a, const FileRef& b) {
  return a.size == b.size && a.hash == b.hash;
}

void check_same(const std::vector<PartEntry>& a, const std::vector<PartEntry>& b) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CAPTURE(i);
    CHECK(same_content(a[i].file, b[i].file));
    CHECK(a[i].vertices == b[i].vertices);
    CHECK(a[i].triangles == b[i].triangles);
    CHECK(a[i].boundary_vertices == b[i].boundary_vertices);
  }
}

const CutOptions k_swept{.scheme = Scheme::stream, .parts = 5, .window_triangles = 1'000};

}  // namespace

TEST_CASE("the farm sorts slabs to the bytes that the cut makes by itself") {
  struct Case {
    const char* name;
    Mesh mesh;
    CutOptions options;
  };
  CutOptions apart = k_swept;
  apart.weld = Weld::off;
  CutOptions some_long = k_swept;
  some_long.window_triangles = 2'830;
  const Mesh soup = shuffled_soup();
  const std::vector<Case> cases = {
      {"in order", test::torus(300, 60), k_swept},
      {"soup", soup, k_swept},
      {"soup, not welded", soup, apart},
      {"some long", soup, some_long},
      {"touching", touching(), k_swept},
      {"touching, not welded", touching(), apart},
      {"samples smaller than their streams",
       test::grid(700, 300),
       {.scheme = Scheme::stream, .parts = 2, .window_triangles = 100'000}},
      {"tetrahedron", test::tetrahedron(), k_swept},
      {"nothing", {}, k_swept}};
  for (const Case& each : cases) {
    CAPTURE(each.name);
    const test::TempFolder folder;
    const Staged here = generate(each.mesh, each.options, SortAt::here, folder / "here");
    const Staged farm = generate(each.mesh, each.options, SortAt::farm, folder / "farm");
    REQUIRE(farm.manifest.sorting.has_value());
    const RunOptions run{.ratio = 0.5};
    const JobSource source = make_job_source(farm.manifest, run);
    const RunState state =
        state_of_run(farm.manifest, run, do_jobs(source, farm.stage, Which::of_slabs));
    CHECK_FALSE(state.manifest.sorting.has_value());
    check_same(state.manifest.parts, here.manifest.parts);
    check_same(state.manifest.samples, here.manifest.samples);
    CHECK(same_content(state.manifest.boundary[0].file, here.manifest.boundary[0].file));
    CHECK(state.manifest.boundary_triangles == here.manifest.boundary_triangles);
    CHECK(state.manifest.coincident_vertices == here.manifest.coincident_vertices);
    CHECK(state.manifest.dropped_degenerate == here.manifest.dropped_degenerate);
    CHECK(state.manifest.coincident_corners == here.manifest.coincident_corners);
    CHECK(state.manifest.dropped_duplicate == here.manifest.dropped_duplicate);
  }
}

TEST_CASE("a run that sorts first ends as one that finds streams, and estimates what it needs") {
  const Mesh mesh = shuffled_soup();
  const test::TempFolder folder;
  const Staged here = generate(mesh, k_swept, SortAt::here, folder / "here");
  const Staged farm = generate(mesh, k_swept, SortAt::farm, folder / "farm");
  CHECK(farm.manifest.triangles() > here.manifest.triangles());  // some are of no area
  const RunOptions run{.ratio = 0.1};
  CHECK(run_key(farm.manifest, run) != run_key(farm.manifest, {.ratio = 0.1000001}));
  std::vector<std::string> results;
  std::vector<std::vector<std::string>> kinds(2);
  for (const Staged* staged : {&here, &farm}) {
    const auto output = folder / "out.ply";
    const JobSource source = make_job_source(staged->manifest, run);
    const auto accepted = do_jobs(source, staged->stage, Which::all, &kinds[results.size()]);
    const RunSummary summary =
        Assembler(staged->stage, staged->manifest, run, {.output = {output}}).complete(accepted);
    CHECK(summary.target == std::llround(0.1 * 14'400));
    CHECK(summary.dropped_degenerate == 2000);
    CHECK(state_of_run(staged->manifest, run, accepted).chosen->rungs.size() == 5);
    results.push_back(read_file(output));
  }
  CHECK(results[0] == results[1]);
  const auto count = [&](std::string_view kind) {
    return std::count(kinds[1].begin(), kinds[1].end(), kind);
  };
  CHECK(count(k_sort_kind) == 5);
  CHECK(count(k_sample_kind) == 5);
  CHECK(count(k_sort_kind) + count(k_sample_kind) ==
        static_cast<std::ptrdiff_t>(kinds[1].size() - kinds[0].size()));

  // Climbing a whole stream takes more memory than sorting it, so the first jobs do not tell.
  const Staged whole =
      generate(mesh, {.scheme = Scheme::stream, .parts = 1}, SortAt::farm, folder / "whole");
  CHECK(memory_wanted(whole.manifest, run) >
        test::next_jobs(make_job_source(whole.manifest, run), {})[0].memory);
}

TEST_CASE("a sort job that makes no sense is refused, and so is what it cannot have made") {
  const test::TempFolder folder;
  const Staged farm = generate(test::torus(60, 30), k_swept, SortAt::farm, folder.path());
  const JobContext context = context_of(farm.stage);
  const std::string bytes = encode_parameters(SortParameters{{{{1, 2, 0}, -1}, Weld::off}, 5});
  CHECK(decode_sort_parameters(bytes).number == 5);
  CHECK(decode_sort_parameters(bytes).sorting.order.sign == -1);
  CHECK_THROWS_AS(decode_sort_parameters(bytes + "x"), DataError);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    CHECK_THROWS_AS(decode_sort_parameters(bytes.substr(0, size)), DataError);
  }
  for (const std::string_view kind : {k_sort_kind, k_sample_kind}) {
    CHECK_THROWS_AS(do_job({std::string(kind), {}, bytes, 0, 0}, context), DataError);
    CHECK_THROWS_AS(
        do_job({std::string(kind), {farm.manifest.boundary[0].file}, bytes, 0, 0}, context),
        BadInputError);
  }
  const std::string summary = encode_summary(SortSummary{9, 8, 7, 6, 5, 4});
  CHECK(decode_sort_summary(summary, "s").dropped_degenerate == 5);
  CHECK_THROWS_AS(decode_sort_summary(summary + "x", "s"), DataError);
  CHECK_THROWS_AS(decode_sort_summary(encode_summary(SortSummary{9, 8, 10, 6, 5, 4}), "s"),
                  DataError);

  std::vector<AcceptedJob> accepted;
  for (const Job& job : test::next_jobs(make_job_source(farm.manifest, {.ratio = 0.5}), {})) {
    accepted.push_back({key_of(job), do_job(job, context)});
  }
  CHECK_NOTHROW(state_of_run(farm.manifest, {.ratio = 0.5}, accepted));
  SortSummary other = decode_sort_summary(accepted[1].output.summary, "s");
  ++other.boundary_vertices;
  accepted[1].output.summary = encode_summary(other);
  CHECK_THROWS_AS(state_of_run(farm.manifest, {.ratio = 0.5}, accepted), DataError);
}

TEST_CASE("a sort job that is given up publishes nothing") {
  const test::TempFolder folder;
  const Staged farm = generate(test::torus(60, 30), k_swept, SortAt::farm, folder.path());
  const Job job = test::next_jobs(make_job_source(farm.manifest, {.ratio = 0.5}), {})[0];
  const JobContext given_up{farm.stage, 1, 7, [](std::uint64_t) { return false; }};
  CHECK_THROWS_AS(do_job(job, given_up), IncompleteError);
  CHECK(std::filesystem::is_empty(folder / "results"));
}
