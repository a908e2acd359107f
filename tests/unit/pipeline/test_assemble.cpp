// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The pipeline without its processes: cut, jobs, stitch and finish called in turn.
#include <algorithm>
#include <cmath>
#include <utility>

#include <doctest/doctest.h>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/assemble.hpp>
#include <meshfarm/pipeline/job_table.hpp>
#include <meshfarm/pipeline/run_graph.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

#include "support/memory_source.hpp"
#include "support/meshes.hpp"
#include "support/next_jobs.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

struct Made {
  RunSummary summary;
  Mesh mesh;
  std::string bytes;
  std::size_t jobs = 0;
};

Made simplify(Mesh mesh, std::uint32_t parts, const RunOptions& run,
              const std::filesystem::path& folder) {
  test::MemorySource source(std::move(mesh));
  const Stage stage = Stage::create(folder);
  const Manifest manifest = cut_mesh(source, stage, {.parts = parts});
  const JobSource jobs_of = make_job_source(manifest, run);
  const JobContext context{stage, 1, 7, [](std::uint64_t) { return true; }};
  std::vector<AcceptedJob> accepted;
  for (std::vector<Job> jobs = test::next_jobs(jobs_of, accepted); !jobs.empty();
       jobs = test::next_jobs(jobs_of, accepted)) {
    for (const Job& job : jobs) accepted.push_back({key_of(job), do_job(job, context)});
  }
  Made made;
  made.jobs = accepted.size();
  const auto output = folder / "out.ply";
  made.summary = Assembler(stage, manifest, run, {.output = {output}}).complete(accepted);
  made.mesh = read_mesh(*open_mesh(output));
  made.bytes = read_file(output);
  return made;
}

/// A flat sheet with one rough corner: nearly all detail is in few parts.
Mesh sheet_with_a_rough_corner() {
  Mesh mesh = test::grid(120, 120);
  for (Vec3& p : mesh.positions) {
    if (p.x < 25 && p.y < 25) p.z = std::sin(p.x * 1.7) * std::cos(p.y * 2.3);
  }
  return mesh;
}

}  // namespace

TEST_CASE("a closed surface stays closed and gets its count, from any number of parts") {
  const test::TempFolder folder;
  for (const std::uint32_t parts : {1U, 3U, 12U}) {
    CAPTURE(parts);
    const Made made = simplify(test::torus(100, 60), parts, {.triangles = 600},
                               folder.path() / std::to_string(parts));
    CHECK(made.summary.triangles == 600);
    CHECK(made.summary.why_not_exact.empty());
    const Topology t = measure_topology(made.mesh);
    CHECK(t.triangles == 600);
    CHECK(t.components == 1);
    CHECK(t.euler == 0);
    CHECK(t.border_edges == 0);
    CHECK(t.nonmanifold_edges == 0);
    CHECK(t.orientation_conflicts == 0);
    CHECK(t.degenerate + t.zero_area + t.duplicate == 0);
    for (const Vec3& p : made.mesh.positions) {
      const double ring = std::hypot(p.x, p.y) - 1;
      CHECK(std::hypot(ring, p.z) == doctest::Approx(0.4).epsilon(0.06));
    }
  }
}

TEST_CASE("crossings are counted where the result is small beside the input") {
  const test::TempFolder folder;
  const auto crossings = [&](std::uint64_t triangles) {
    return simplify(test::icosphere(6), 2, {.triangles = triangles},
                    folder.path() / std::to_string(triangles))
        .summary.result.value();
  };
  const SurfaceFigures few = crossings(9'000);
  CHECK(few.crossing_triangles == 0U);
  CHECK(few.crossings_skipped.empty());
  const SurfaceFigures many = crossings(20'000);
  CHECK_FALSE(many.crossing_triangles);
  CHECK(many.crossings_skipped.find("64th") != std::string::npos);
}

TEST_CASE("where crossings are avoided, triangles that face away from the input are mended") {
  const test::TempFolder folder;
  // A wall of two wavy sheets, thinner than so few triangles can follow.
  Mesh wall = test::grid(100, 100);
  const Mesh sheet = wall;
  const auto count = static_cast<std::uint32_t>(sheet.positions.size());
  for (const Vec3& p : sheet.positions) {
    wall.positions.push_back(
        {p.x + 0.5, p.y + 0.5, 0.3 + 0.28 * std::sin(p.x * 2.9) * std::cos(p.y * 3.1)});
  }
  for (Triangle& t : wall.triangles) std::swap(t[1], t[2]);
  for (const auto& [a, b, c] : sheet.triangles) {
    wall.triangles.push_back({a + count, b + count, c + count});
  }
  const auto made = [&](CrossingMode crossings, const char* name) {
    return simplify(wall, 3, {.triangles = 500, .lines = {.crossings = crossings}},
                    folder.path() / name);
  };
  CHECK_FALSE(made(CrossingMode::allow, "allow").summary.facing);
  const Made avoid = made(CrossingMode::avoid, "avoid");
  CHECK(avoid.summary.triangles == 500);
  REQUIRE(avoid.summary.facing);
  const FacingMended facing = *avoid.summary.facing;
  CHECK(facing.found > 10);
  CHECK(2 * facing.mended > facing.found);
  const DistanceMeter to_input(wall, 1);
  std::uint64_t away = 0;
  for (const auto& [a, b, c] : avoid.mesh.triangles) {
    const Vec3 p = avoid.mesh.positions[a], q = avoid.mesh.positions[b];
    const Vec3 r = avoid.mesh.positions[c];
    const auto& [i, j, k] = wall.triangles[to_input.nearest_triangle((p + q + r) * (1.0 / 3))];
    const Vec3 there =
        cross(wall.positions[j] - wall.positions[i], wall.positions[k] - wall.positions[i]);
    if (dot(cross(q - p, r - p), there) < 0) ++away;
  }
  CHECK(away <= facing.found - facing.mended + 3);
  CHECK(render(avoid.summary, Format::text).find(" of them mended") != std::string::npos);
}

TEST_CASE("an odd count of a closed surface is one fewer, and the summary says why") {
  const test::TempFolder folder;
  const Made made = simplify(test::torus(60, 40), 4, {.triangles = 501}, folder.path());
  CHECK(made.summary.triangles == 500);
  CHECK_FALSE(made.summary.why_not_exact.empty());
}

TEST_CASE("a surface that cannot go so far says so") {
  const test::TempFolder folder;
  const Made made = simplify(test::icosphere(2), 2, {.triangles = 1}, folder.path() / "auto");
  CHECK(made.summary.triangles == 4);  // the last piece stays
  CHECK_FALSE(made.summary.topology_simplified);
  CHECK(made.summary.why_not_exact.find("the last piece") != std::string::npos);
  CHECK(warning_of(made.summary).find("1 triangles were asked for, 4 are left") !=
        std::string::npos);
  const Made kept =
      simplify(test::icosphere(2), 2, {.triangles = 1, .lines = {.topology = TopologyMode::keep}},
               folder.path() / "keep");
  CHECK(kept.summary.triangles == 4);
  const Made more = simplify(test::icosphere(1), 2, {.triangles = 500}, folder.path() / "more");
  CHECK(more.summary.triangles == 80);
  CHECK(more.summary.why_not_exact == "the input has no more");
  CHECK(warning_of(more.summary).empty());
  // Each part by itself: together they may end a little below what was asked for.
  const Made uniform =
      simplify(test::icosphere(3), 1, {.triangles = 501, .allocation = Allocation::uniform},
               folder.path() / "uniform");
  CHECK(uniform.summary.triangles == 500);
  CHECK(uniform.summary.why_not_exact.find("the input has no more") == std::string::npos);
  // A torus has at least fourteen triangles: no piece is as small as a piece can be.
  const Made torus =
      simplify(test::torus(12, 8), 1, {.triangles = 4, .lines = {.topology = TopologyMode::keep}},
               folder.path() / "torus");
  CHECK(torus.summary.triangles >= 14);
  CHECK(torus.summary.why_not_exact.find("changing the topology") != std::string::npos);
  CHECK_FALSE(warning_of(torus.summary).empty());
}

TEST_CASE("pieces go where the count cannot be met with them, unless they are to be kept") {
  Mesh mesh;
  for (int i = 0; i < 100; ++i) {
    Mesh sphere = test::icosphere(1);
    for (Vec3& p : sphere.positions) {
      p = p * (1 + 0.01 * i) + Vec3{i % 10 * 5.0, i / 10 * 5.0, 0};
    }
    test::append(mesh, sphere);
  }
  const test::TempFolder folder;
  // Two triangles are enough for each.
  const Made opened = simplify(mesh, 4, {.triangles = 200}, folder.path() / "opened");
  CHECK(opened.summary.triangles == 200);
  CHECK(measure_topology(opened.mesh).components == 100);
  CHECK(render(opened.summary, Format::text).find("opened into sheets") != std::string::npos);
  RunOptions run{.triangles = 60};
  const Made simplified = simplify(mesh, 4, run, folder.path() / "auto");
  CHECK(simplified.summary.triangles == 60);
  CHECK(simplified.summary.topology_simplified);
  CHECK(measure_topology(simplified.mesh).components < 100);
  REQUIRE(simplified.summary.topology);
  const auto& [before, after, gone] = *simplified.summary.topology;
  CHECK(before.components == 100);
  CHECK(before.euler == 200);
  CHECK(after.components == measure_topology(simplified.mesh).components);
  // A pinched piece becomes two, so more pieces may be gone than are missing.
  CHECK(gone.components >= 100 - after.components);
  CHECK(gone.components < 100);
  CHECK(gone.area > 0.2 * gone.area_of_all);
  CHECK(gone.area < 0.5 * gone.area_of_all);  // the smaller ones
  const std::string text = render(simplified.summary, Format::text);
  CHECK(text.find(" of 100 pieces removed") != std::string::npos);
  run.lines.topology = TopologyMode::keep;
  const Made kept = simplify(mesh, 4, run, folder.path() / "keep");
  CHECK(kept.summary.triangles == 400);
  CHECK_FALSE(kept.summary.topology_simplified);
  CHECK(measure_topology(kept.mesh).components == 100);
  CHECK(kept.summary.why_not_exact.find("topology") != std::string::npos);
  // No piece is removed where that is not needed.
  const Made enough = simplify(mesh, 4, {.triangles = 2000}, folder.path() / "enough");
  CHECK(enough.summary.triangles == 2000);
  CHECK(enough.summary.topology->before.components == 100);
  CHECK(render(enough.summary, Format::text).find("pieces removed") == std::string::npos);
  CHECK_FALSE(enough.summary.topology_simplified);
  CHECK(measure_topology(enough.mesh).components == 100);
}

TEST_CASE("triangles that face another way are turned, and counted") {
  Mesh mesh = test::torus(60, 40);
  for (std::size_t i = 0; i < mesh.triangles.size(); i += 40) {
    std::swap(mesh.triangles[i][1], mesh.triangles[i][2]);
  }
  const test::TempFolder folder;
  const Made made = simplify(mesh, 1, {.triangles = 400}, folder.path());
  CHECK(made.summary.turned == 120);
  CHECK(measure_topology(made.mesh).orientation_conflicts == 0);
  CHECK(render(made.summary, Format::text).find("120 triangles that faced") != std::string::npos);
  CHECK(render(made.summary, Format::json).find("\"turned\": 120") != std::string::npos);
}

TEST_CASE("one threshold gives the rough corner what the flat rest does not need") {
  const test::TempFolder folder;
  const auto rough = [](const Mesh& mesh) {
    return std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
      return mesh.positions[t[0]].x < 26 && mesh.positions[t[0]].y < 26;
    });
  };
  const Made made =
      simplify(sheet_with_a_rough_corner(), 16, {.ratio = 0.03}, folder.path() / "threshold");
  CHECK(made.summary.triangles == 864);
  CHECK(made.jobs > 16);  // the rough parts were asked for again
  CHECK(rough(made.mesh) > 550);
  const Made uniform =
      simplify(sheet_with_a_rough_corner(), 16,
               {.ratio = 0.03, .allocation = Allocation::uniform, .finish = Finish::boundary},
               folder.path() / "uniform");
  CHECK(rough(uniform.mesh) < 400);
}

TEST_CASE("the paper's way reaches about its count without touching the inside again") {
  const test::TempFolder folder;
  const Made made = simplify(
      test::torus(100, 60), 6,
      {.ratio = 0.1, .allocation = Allocation::uniform, .finish = Finish::boundary}, folder.path());
  CHECK(made.summary.triangles >= 1200);
  CHECK(made.summary.triangles < 1500);
  const Topology t = measure_topology(made.mesh);
  CHECK(t.euler == 0);
  CHECK(t.border_edges == 0);
}

namespace {

/// Boxes in a row, each face a fine grid: a box needs at least 12 triangles.
Mesh boxes(int count) {
  constexpr std::uint32_t k_fine = 12;
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const double size = 1 + 0.05 * i;
    const Vec3 at{3.0 * i, 0, 0};
    for (int axis = 0; axis < 3; ++axis) {
      for (const bool is_far : {false, true}) {
        Mesh face = test::grid(k_fine, k_fine);
        for (Vec3& p : face.positions) {
          double c[3];
          c[axis] = is_far ? 1 : 0;
          c[(axis + 1) % 3] = p.x / k_fine;
          c[(axis + 2) % 3] = p.y / k_fine;
          p = Vec3{c[0], c[1], c[2]} * size + at;
        }
        if (!is_far) {
          for (Triangle& t : face.triangles) std::swap(t[1], t[2]);
        }
        test::append(mesh, face);
      }
    }
  }
  return mesh;
}

}  // namespace

TEST_CASE("past a knee the summary tells of the better count, and else of none") {
  const test::TempFolder folder;
  const Mesh mesh = boxes(30);
  const Made few = simplify(mesh, 4, {.triangles = 330}, folder.path() / "few");
  CHECK(few.summary.triangles == 330);
  REQUIRE(few.summary.better);
  CHECK(few.summary.better->triangles >= 360);
  CHECK(few.summary.better->triangles <= 1.25 * 330);
  CHECK(few.summary.better->error.greater().rms < 1e-3 * few.summary.error.greater().rms);
  const Made asked =
      simplify(mesh, 4, {.triangles = few.summary.better->triangles}, folder.path() / "asked");
  CHECK(asked.summary.error.greater().rms < 1e-3 * few.summary.error.greater().rms);
  CHECK_FALSE(asked.summary.better);
  const Made smooth =
      simplify(test::torus(100, 60), 4, {.triangles = 300}, folder.path() / "torus");
  CHECK_FALSE(smooth.summary.better);
}

TEST_CASE("a bound on the error is kept, with few triangles, and a tighter one needs more") {
  const test::TempFolder folder;
  std::uint64_t before = 12'000;
  for (const double bound : {0.002, 0.02, 0.1}) {
    CAPTURE(bound);
    const Made made = simplify(test::torus(100, 60), 6, {.error = {bound, false}},
                               folder.path() / std::to_string(bound));
    CHECK(made.summary.error.greater().max <= bound);
    CHECK(made.summary.error.greater().max > bound / 3);
    CHECK(measure_topology(made.mesh).euler == 0);
    CHECK(made.summary.triangles * 10 < before * 7);
    before = made.summary.triangles;
  }
}

TEST_CASE("a bound on the error leaves no dense seams") {
  const test::TempFolder folder;
  const Mesh torus = test::torus(200, 120);
  const RunOptions options{.error = {0.02, false}};
  const Made whole = simplify(torus, 1, options, folder.path() / "whole");
  const Made parts = simplify(torus, 6, options, folder.path() / "parts");
  CHECK(parts.summary.stitched > 2 * parts.summary.triangles);
  CHECK(parts.summary.triangles * 10 < whole.summary.triangles * 13);
  CHECK(parts.summary.error.greater().max <= 0.02);
}

TEST_CASE("a bound that is proven holds at every point, with hardly more triangles") {
  constexpr double k_bound = 0.1;
  Mesh sheet = test::grid(45, 30);  // ridges, and slots across them
  for (Vec3& p : sheet.positions) {
    p.z = 0.7 * std::abs(std::fmod(p.x, 6.0) - 3) + 0.1 * std::sin(p.y * 5.1);
  }
  std::erase_if(sheet.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
      const double x = sheet.positions[v].x;
      return std::fmod(x, 15) >= 7 && std::fmod(x, 15) <= 8 && sheet.positions[v].y > 10;
    });
  });
  const test::TempFolder folder;
  RunOptions run{.error = {k_bound, false}};
  const Made sampled = simplify(sheet, 5, run, folder.path() / "sampled");
  run.certify = true;
  const Made proven = simplify(sheet, 5, run, folder.path() / "proven");
  CHECK(sampled.summary.certified_error == 0);
  CHECK(proven.summary.certified_error == k_bound);
  CHECK(proven.mesh.triangles.size() * 10 < sampled.mesh.triangles.size() * 12);
  const auto check = [&](const Mesh& from, const Mesh& to) {
    const DistanceBounds found = bound_distance(from, to, {.gap = k_bound / 500});
    CHECK(found.lower <= k_bound);
    CHECK(found.upper <= k_bound * 1.0021);
  };
  check(sheet, proven.mesh);
  check(proven.mesh, sheet);
}

TEST_CASE("components that are smaller than asked for are left out, and counted") {
  Mesh mesh = test::torus(60, 40);  // 2.8 wide, and dust beside it
  for (int i = 0; i < 10; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : test::tetrahedron().positions) {
      mesh.positions.push_back(p * 0.01 + Vec3{1.5, i * 0.05, 0});
    }
    for (const auto& [a, b, c] : test::tetrahedron().triangles) {
      mesh.triangles.push_back({a + first, b + first, c + first});
    }
  }
  const test::TempFolder folder;
  const Made all = simplify(mesh, 4, {.triangles = 400}, folder.path() / "all");
  CHECK(measure_topology(all.mesh).components == 11);
  const Made some = simplify(mesh, 4, {.triangles = 400, .drop_components = {0.02, true}},
                             folder.path() / "some");
  CHECK(measure_topology(some.mesh).components == 1);
  CHECK(some.summary.dropped_components.components == 10);
  CHECK(some.summary.triangles == 400);
}

TEST_CASE("the same bytes every time") {
  const test::TempFolder folder;
  const Made a = simplify(test::torus(80, 50), 5, {.ratio = 0.05}, folder.path() / "a");
  const Made b = simplify(test::torus(80, 50), 5, {.ratio = 0.05}, folder.path() / "b");
  CHECK(a.bytes == b.bytes);
}

TEST_CASE("a result of another part is refused, and a stop writes nothing") {
  const test::TempFolder folder;
  test::MemorySource source(test::torus(60, 40));
  const Stage stage = Stage::create(folder.path());
  const Manifest manifest = cut_mesh(source, stage, {.parts = 3});
  const RunOptions run{.ratio = 0.5};
  const JobContext context{stage, 1, 7, [](std::uint64_t) { return true; }};
  std::vector<AcceptedJob> accepted;
  for (const Job& job : test::next_jobs(make_job_source(manifest, run), {})) {
    accepted.push_back({key_of(job), do_job(job, context)});
  }
  const auto output = folder.path() / "out.ply";
  const std::atomic<bool> stop = true;
  CHECK_THROWS_AS(
      Assembler(stage, manifest, run, {.output = {output}, .stop = &stop}).complete(accepted),
      IncompleteError);
  accepted[1].output = accepted[2].output;
  if (manifest.parts[1].boundary_vertices != manifest.parts[2].boundary_vertices) {
    CHECK_THROWS_AS(Assembler(stage, manifest, run, {.output = {output}}).complete(accepted),
                    DataError);
  }
  CHECK_FALSE(std::filesystem::exists(output));
}

TEST_CASE("an unknown kind of job, or one without its part, is refused") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  const JobContext context{stage, 1, 7, [](std::uint64_t) { return true; }};
  CHECK_THROWS_AS(do_job({"paint", {}, "", 0}, context), DataError);
  CHECK_THROWS_AS(do_job({"simplify", {}, "", 0}, context), DataError);
}
