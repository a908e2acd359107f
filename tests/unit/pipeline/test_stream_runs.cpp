// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The stream scheme without its processes: generation, jobs, stitch and finish called in turn.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <doctest/doctest.h>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/pipeline/assemble.hpp>
#include <meshfarm/pipeline/compose_job.hpp>
#include <meshfarm/pipeline/job_table.hpp>
#include <meshfarm/pipeline/run_graph.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>
#include <meshfarm/pipeline/sweep_job.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/rung_input.hpp"
#include "support/memory_source.hpp"
#include "support/meshes.hpp"
#include "support/next_jobs.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

struct MadeByStreams {
  RunSummary summary;
  Mesh mesh;
  std::vector<std::string> kinds;  // of the jobs, in order
};

/// A ring with one rough half: the streams deserve very different numbers of triangles.
Mesh half_rough_torus() {
  Mesh mesh = test::torus(320, 160);  // 102,400 triangles
  for (Vec3& p : mesh.positions) {
    if (p.x > 0) p.z += 0.02 * std::sin(40 * p.x) * std::cos(37 * p.y);
  }
  return mesh;
}

MadeByStreams simplify_streams(const Mesh& mesh, const CutOptions& options, const RunOptions& run,
                               const std::filesystem::path& folder) {
  test::MemorySource source(mesh);
  const Stage stage = Stage::create(folder);
  const Manifest manifest = cut_mesh(source, stage, options);
  const JobSource jobs_of = make_job_source(manifest, run);
  const JobContext context{stage, 1, 7, [](std::uint64_t) { return true; }};
  MadeByStreams made;
  std::vector<AcceptedJob> accepted;
  for (std::vector<Job> jobs = test::next_jobs(jobs_of, accepted); !jobs.empty();
       jobs = test::next_jobs(jobs_of, accepted)) {
    for (const Job& job : jobs) {
      accepted.push_back({key_of(job), do_job(job, context)});
      made.kinds.push_back(job.kind);
    }
  }
  const auto output = folder / "out.ply";
  made.summary = Assembler(stage, manifest, run, {.output = {output}}).complete(accepted);
  made.mesh = read_mesh(*open_mesh(output));
  return made;
}

double rms(const Mesh& a, const Mesh& b) {
  return std::max(measure_distance(a, b, {.samples = 50'000}).rms,
                  measure_distance(b, a, {.samples = 50'000}).rms);
}

const CutOptions k_swept_streams{.scheme = Scheme::stream, .parts = 3, .window_triangles = 16'000};

}  // namespace

TEST_CASE("swept streams, climbed streams and the uncut mesh end as good, closed, and exact") {
  const Mesh mesh = half_rough_torus();
  const RunOptions run{.triangles = 3000};
  const test::TempFolder folder;
  const MadeByStreams uncut =
      simplify_streams(mesh, {.scheme = Scheme::stream, .parts = 1}, run, folder / "uncut");
  const MadeByStreams climbed =
      simplify_streams(mesh, {.scheme = Scheme::stream, .parts = 3}, run, folder / "climbed");
  const MadeByStreams swept = simplify_streams(mesh, k_swept_streams, run, folder / "swept");
  CHECK(climbed.kinds == std::vector<std::string>(3, "simplify"));
  CHECK(std::count(swept.kinds.begin(), swept.kinds.end(), k_sweep_kind) == 3);
  for (const MadeByStreams* made : {&uncut, &climbed, &swept}) {
    CHECK(made->mesh.triangles.size() == 3000);
    const Topology t = measure_topology(made->mesh);
    CHECK(t.euler == 0);
    CHECK(t.border_edges + t.nonmanifold_edges + t.degenerate + t.duplicate == 0);
    // With few triangles between seams the finish cannot mend all. On large meshes it is 1 %.
    CHECK(rms(mesh, made->mesh) < 1.15 * rms(mesh, uncut.mesh));
  }
  CHECK(swept.summary.stitched > 4500);
  CHECK(swept.summary.error.input_samples > 66'000);
  CHECK(swept.summary.error.greater().rms ==
        doctest::Approx(uncut.summary.error.greater().rms).epsilon(0.05));
}

TEST_CASE("a bound is proven of streams as of parts") {
  const Mesh mesh = test::torus(80, 60);
  const RunOptions run{.error = {0.01, false}, .certify = true};
  const CutOptions streams{.scheme = Scheme::stream, .parts = 3, .window_triangles = 1000};
  const test::TempFolder folder;
  const MadeByStreams made = simplify_streams(mesh, streams, run, folder / "certified");
  CHECK(std::count(made.kinds.begin(), made.kinds.end(), k_sweep_kind) == 0);
  CHECK(made.summary.certified_error == 0.01);
  const DistanceBounds there = bound_distance(mesh, made.mesh, {.gap = 1e-5});
  const DistanceBounds back = bound_distance(made.mesh, mesh, {.gap = 1e-5});
  CHECK(std::max(there.lower, back.lower) <= 0.01);
  CHECK(std::max(there.upper, back.upper) <= 0.01 + 1.1e-5);
  CHECK(made.mesh.triangles.size() < mesh.triangles.size() / 5);
}

TEST_CASE("composed as a tree, the result is as good, closed, and exact") {
  const Mesh mesh = half_rough_torus();
  for (const CutOptions& nine :
       {CutOptions{.scheme = Scheme::stream, .parts = 9, .window_triangles = 16'000},
        CutOptions{.scheme = Scheme::cut, .parts = 9}}) {
    CAPTURE(nine.scheme);
    const test::TempFolder folder;
    RunOptions run{.triangles = 3000, .composition = Composition::sink};
    const MadeByStreams by_sink = simplify_streams(mesh, nine, run, folder / "sink");
    run.composition = Composition::automatic;  // too small to be worth it
    CHECK(simplify_streams(mesh, nine, run, folder / "auto").kinds == by_sink.kinds);
    run.composition = Composition::tree;
    const MadeByStreams by_tree = simplify_streams(mesh, nine, run, folder / "tree");
    // 9 -> 3 -> 1
    CHECK(std::count(by_sink.kinds.begin(), by_sink.kinds.end(), k_compose_kind) == 0);
    CHECK(std::count(by_tree.kinds.begin(), by_tree.kinds.end(), k_compose_kind) >= 3);
    CHECK(by_tree.mesh.triangles.size() == 3000);
    const Topology t = measure_topology(by_tree.mesh);
    CHECK(t.euler == 0);
    CHECK(t.components == 1);
    CHECK(t.border_edges + t.nonmanifold_edges + t.degenerate + t.duplicate == 0);
    CHECK(by_tree.summary.stitched < by_sink.summary.stitched);
    CHECK(by_tree.summary.stitched >= 3000);
    CHECK(rms(mesh, by_tree.mesh) < 1.1 * rms(mesh, by_sink.mesh));
    CHECK(by_tree.summary.error.input_samples > 66'000);
    CHECK(by_tree.summary.error.greater().rms ==
          doctest::Approx(by_sink.summary.error.greater().rms).epsilon(0.1));
  }
}

TEST_CASE("no more streams are composed than a window holds") {
  const Mesh mesh = half_rough_torus();
  const test::TempFolder folder;
  const MadeByStreams made =
      simplify_streams(mesh, {.scheme = Scheme::stream, .parts = 4, .window_triangles = 16'000},
                       {.ratio = 0.8, .composition = Composition::tree}, folder.path());
  CHECK(std::count(made.kinds.begin(), made.kinds.end(), k_compose_kind) == 0);
  CHECK(made.mesh.triangles.size() == 81'920);
}

TEST_CASE("hardly anything and nearly everything can be kept") {
  const test::TempFolder folder;
  const Mesh mesh = half_rough_torus();
  const MadeByStreams most =
      simplify_streams(mesh, k_swept_streams, {.ratio = 0.9}, folder / "most");
  CHECK(most.mesh.triangles.size() == 92'160);
  const MadeByStreams all = simplify_streams(mesh, k_swept_streams, {.ratio = 1}, folder / "all");
  CHECK(all.mesh.triangles.size() == 102'400);
  const MadeByStreams few =
      simplify_streams(mesh, k_swept_streams, {.triangles = 100}, folder / "few");
  CHECK(few.mesh.triangles.size() == 100);
  CHECK(measure_topology(few.mesh).euler == 0);
}

TEST_CASE("a flat stream is not swept away when detail elsewhere sets the level") {
  Mesh mesh = test::grid(400, 60);
  for (Vec3& p : mesh.positions) {
    if (p.x > 300) p.z = std::sin(p.x * 1.7) * std::cos(p.y * 2.3);
  }
  const test::TempFolder folder;
  const MadeByStreams made =
      simplify_streams(mesh, {.scheme = Scheme::stream, .parts = 4, .window_triangles = 5000},
                       {.triangles = 4000}, folder.path());
  CHECK(made.mesh.triangles.size() == 4000);
  CHECK(measure_topology(made.mesh).euler == 1);
  CHECK(rms(mesh, made.mesh) < 0.4);
}

TEST_CASE("the paper's way: the same ratio everywhere, and no level is looked for") {
  const test::TempFolder folder;
  const MadeByStreams made = simplify_streams(
      half_rough_torus(), k_swept_streams,
      {.ratio = 0.05, .allocation = Allocation::uniform, .finish = Finish::boundary},
      folder.path());
  CHECK(made.kinds == std::vector<std::string>(3, std::string(k_sweep_kind)));
  CHECK(measure_topology(made.mesh).euler == 0);
  CHECK(made.mesh.triangles.size() < 8'000);
}

TEST_CASE("a bound on the error is kept") {
  const Mesh mesh = half_rough_torus();
  const test::TempFolder folder;
  const RunOptions run{.error = {0.004, false}};
  const MadeByStreams made = simplify_streams(mesh, k_swept_streams, run, folder.path());
  CHECK(made.summary.error.greater().max <= 0.004);
  CHECK(measure_distance(mesh, made.mesh, {.samples = 50'000}).max < 0.0045);
  CHECK(made.mesh.triangles.size() < mesh.triangles.size() / 4);
  CHECK(measure_topology(made.mesh).euler == 0);
}

TEST_CASE(
    "a stream that is longer than the memory of its job is read bit by bit, to the same end") {
  const test::TempFolder folder;
  test::MemorySource source(half_rough_torus());
  const Stage stage = Stage::create(folder.path());
  const Manifest manifest = cut_mesh(source, stage, k_swept_streams);
  const JobContext context{stage, 1, 7, [](std::uint64_t) { return true; }};
  SweepParameters parameters;
  parameters.max_cost = 1e-9;
  parameters.window_triangles = 16'000;
  Job job{std::string(k_sweep_kind), {manifest.parts[0].file}, encode_parameters(parameters), 1, 0};
  const JobOutput bit_by_bit = do_job(job, context);
  job.memory = manifest.parts[0].file.size;
  CHECK(do_job(job, context).file == bit_by_bit.file);

  std::fstream file(stage.path(StreamName{0}), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(manifest.parts[0].file.size / 2));
  file.put('\x55');
  file.close();
  job.memory = 0;
  CHECK_THROWS_WITH_AS(do_job(job, context), "streams/000000.stream: block 1: damaged (checksum)",
                       DataError);
}

TEST_CASE("a compose job that makes no sense is refused, one whose side file is damaged fails") {
  const test::TempFolder folder;
  test::MemorySource source(half_rough_torus());
  const Stage stage = Stage::create(folder.path());
  const Manifest manifest = cut_mesh(source, stage, {.scheme = Scheme::stream, .parts = 3});
  const JobContext context{stage, 1, 7, [](std::uint64_t) { return true; }};
  ComposeParameters parameters{.all_parts = 3, .inputs = {{}, {}}, .boundary = manifest.boundary};
  const std::string bytes = encode_parameters(parameters);
  CHECK(decode_compose_parameters(bytes).inputs.size() == 2);
  CHECK_THROWS_AS(decode_compose_parameters(bytes + "x"), DataError);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    CHECK_THROWS_AS(decode_compose_parameters(bytes.substr(0, size)), DataError);
  }
  parameters.inputs.resize(4);
  CHECK_THROWS_AS(decode_compose_parameters(encode_parameters(parameters)), DataError);
  CHECK_THROWS_AS(do_job({std::string(k_compose_kind), {}, bytes, 0, 0}, context), DataError);

  Job job{std::string(k_compose_kind), {}, bytes, 0, 0};
  for (std::size_t i = 0; i < 2; ++i) {
    SimplifyParameters climb{.allocation = Allocation::uniform, .start_triangles = 9'000};
    const JobOutput made =
        do_job({std::string(k_simplify_kind), {manifest.parts[i].file}, encode_parameters(climb)},
               context);
    const ResultSummary summary = decode_summary(made.summary, "s");
    add_rung_input({.file = made.file, .place = place_of(summary, 0)}, false, job);
  }
  CHECK(job.sections.size() == 4);
  CHECK(input_bytes(job) < job.inputs[0].size + job.inputs[1].size);
  Job without = job;
  without.sections.pop_back();
  CHECK_THROWS_WITH_AS(do_job(without, context), "a compose job without its sections", DataError);
  CHECK_NOTHROW(do_job(job, context));
  std::fstream file(stage.path(BoundaryName{}), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(manifest.boundary[0].file.size / 2));
  file.put('\x55');
  file.close();
  CHECK_THROWS_AS(do_job(job, context), DataError);
}

TEST_CASE("a sweep job that makes no sense is refused") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  const JobContext context{stage, 1, 7, [](std::uint64_t) { return true; }};
  CHECK_THROWS_AS(do_job({std::string(k_sweep_kind), {}, "", 0, 0}, context), DataError);
  CHECK_THROWS_AS(decode_sweep_parameters(""), DataError);
  std::string bytes = encode_parameters(SweepParameters{});
  CHECK_NOTHROW(decode_sweep_parameters(bytes));
  CHECK_THROWS_AS(decode_sweep_parameters(bytes + "x"), DataError);
  bytes[0] = 9;
  CHECK_THROWS_AS(decode_sweep_parameters(bytes), DataError);
}
