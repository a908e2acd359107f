// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <numeric>
#include <random>

#include <doctest/doctest.h>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/divide/slab.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/slab_file.hpp>
#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

#include "divide/slab_map.hpp"
#include "support/joined.hpp"
#include "support/memory_source.hpp"
#include "support/meshes.hpp"
#include "support/temp_folder.hpp"
#include "triangle_corners.hpp"

using namespace meshfarm;

namespace {

using test::Corners;
using test::corners_of;
using test::triangles_of;

struct Generated {
  Manifest manifest;
  std::vector<Part> streams;  // read whole
  std::vector<std::string> files;
  std::vector<BoundaryTriangle> boundary;
};

Generated generate(Mesh mesh, CutOptions options, const std::filesystem::path& folder) {
  options.scheme = Scheme::stream;
  test::MemorySource source(std::move(mesh));
  const Stage stage = Stage::create(folder);
  Generated made{cut_mesh(source, stage, options), {}, {}, {}};
  for (const PartEntry& entry : made.manifest.parts) {
    made.files.push_back(stage.read(entry.file));
    StreamReader reader(fill_from(made.files.back(), "stream"), "stream");
    made.streams.push_back(read_stream(reader));
  }
  made.boundary = read_boundary(stage, made.manifest.boundary);
  return made;
}

std::vector<Corners> stream_triangles(const Generated& made) {
  std::vector<Corners> all;
  for (const Part& part : made.streams) {
    const auto some = triangles_of(part.mesh);
    all.insert(all.end(), some.begin(), some.end());
  }
  const auto at = [&](BoundaryCorner corner) {
    const Part& part = made.streams.at(corner.part);
    REQUIRE(corner.local < part.boundary_vertices);
    return part.mesh.positions[corner.local];
  };
  for (const auto& [a, b, c] : made.boundary) all.push_back(corners_of(at(a), at(b), at(c)));
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

TEST_CASE("columns go with their triangles, whatever their order, sorted here or by the farm") {
  Mesh mesh = test::torus(90, 40);
  const auto label_of = [](const Vec3& a, const Vec3& b, const Vec3& c) {
    return static_cast<Label>(std::lround(20 + 5 * (a.x + b.x + c.x)));
  };
  const auto uv_of = [](const Vec3& p) {
    return Uv{static_cast<float>(p.x), static_cast<float>(p.y)};
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    mesh.columns.labels.push_back(
        label_of(mesh.positions[a], mesh.positions[b], mesh.positions[c]));
    mesh.columns.uvs.push_back(
        {uv_of(mesh.positions[a]), uv_of(mesh.positions[b]), uv_of(mesh.positions[c])});
  }
  Mesh turned = mesh;
  std::reverse(turned.triangles.begin(), turned.triangles.end());
  std::reverse(turned.columns.labels.begin(), turned.columns.labels.end());
  std::reverse(turned.columns.uvs.begin(), turned.columns.uvs.end());
  const test::TempFolder folder;
  const Generated made = generate(mesh, {.parts = 5}, folder / "made");
  const Generated other = generate(turned, {.parts = 5}, folder / "other");
  CHECK(made.files == other.files);
  const Stage stage = Stage::open(folder / "made");
  TriangleColumns columns;
  const auto boundary = read_boundary(stage, made.manifest.boundary, columns);
  REQUIRE(columns.labels.size() == boundary.size());
  const auto at = [&](const BoundaryCorner& corner) {
    return made.streams[corner.part].mesh.positions[corner.local];
  };
  for (std::size_t i = 0; i < boundary.size(); ++i) {
    const auto& [a, b, c] = boundary[i];
    CHECK(columns.labels[i] == label_of(at(a), at(b), at(c)));
    CHECK(columns.uvs[i] == CornerUvs{uv_of(at(a)), uv_of(at(b)), uv_of(at(c))});
  }
  for (const Part& part : made.streams) {
    REQUIRE(part.mesh.columns.labels.size() == part.mesh.triangles.size());
    for (std::size_t i = 0; i < part.mesh.triangles.size(); ++i) {
      const auto& [a, b, c] = part.mesh.triangles[i];
      const std::vector<Vec3>& p = part.mesh.positions;
      CHECK(part.mesh.columns.labels[i] == label_of(p[a], p[b], p[c]));
      CHECK(part.mesh.columns.uvs[i] == CornerUvs{uv_of(p[a]), uv_of(p[b]), uv_of(p[c])});
    }
  }
  test::MemorySource source(mesh);
  const Stage unsorted = Stage::create(folder / "slabs");
  const Manifest slabs =
      cut_mesh(source, unsorted, {.scheme = Scheme::stream, .parts = 5, .sort = SortAt::farm});
  for (std::size_t i = 0; i < slabs.parts.size(); ++i) {
    MeshShare slab = decode_slab(unsorted.read(slabs.parts[i].file), "slab");
    CHECK(encode_stream(sort_slab(std::move(slab), *slabs.sorting).stream) == made.files[i]);
  }
}

TEST_CASE("streams and boundary together are the input") {
  const Mesh mesh = test::torus(90, 40);
  const test::TempFolder folder;
  const Generated made = generate(mesh, {.parts = 5}, folder.path());
  CHECK(made.manifest.scheme == Scheme::stream);
  CHECK(made.streams.size() == 5);
  CHECK(made.manifest.triangles() == mesh.triangles.size());
  CHECK(made.manifest.boundary_triangles > 0);
  CHECK(stream_triangles(made) == triangles_of(mesh));
}

TEST_CASE(
    "triangles with a position that is not finite go and are counted, all else is as without") {
  const Mesh mesh = test::torus(90, 40);
  const test::TempFolder folder;
  const Generated clean = generate(mesh, {.parts = 5}, folder / "clean");
  const Generated made =
      generate(test::with_lost_vertices(mesh, 7), {.parts = 5}, folder / "spoilt");
  CHECK(made.manifest.dropped_not_finite == 7);
  CHECK(made.manifest.input_triangles == mesh.triangles.size() + 7);
  CHECK(made.files == clean.files);
  CHECK(made.boundary == clean.boundary);

  Mesh lost = mesh;
  for (Vec3& p : lost.positions) p = k_no_position;
  CHECK(generate(lost, {.parts = 4}, folder / "lost").manifest.triangles() == 0);
}

TEST_CASE("streams are slabs along the longest axis, of about equal size") {
  Mesh mesh = test::torus(200, 60);
  for (Vec3& p : mesh.positions) p.y *= 3;
  const test::TempFolder folder;
  const Generated made = generate(mesh, {.parts = 6}, folder.path());
  REQUIRE(made.streams.size() == 6);
  double highest = -HUGE_VAL;
  const auto vertices = static_cast<double>(mesh.positions.size());
  const auto triangles = static_cast<double>(mesh.triangles.size());
  for (const Part& part : made.streams) {
    Box box;
    for (const Vec3& p : part.mesh.positions) box.add(p);
    CHECK(box.lo.y > highest);
    highest = box.hi.y;
    CHECK(part.mesh.positions.size() > 0.9 / 6 * vertices);
    CHECK(part.mesh.positions.size() < 1.1 / 6 * vertices);
    CHECK(part.mesh.triangles.size() > 0.85 / 6 * triangles);
    CHECK(part.mesh.triangles.size() < 1.1 / 6 * triangles);
  }
}

TEST_CASE("slabs come out even with vertices far out, in many sizes, or in one plane") {
  const auto check_even = [](const Mesh& mesh, const std::filesystem::path& folder) {
    const Generated made = generate(mesh, {.parts = 28, .threads = 1}, folder / "1");
    REQUIRE(made.streams.size() == 28);
    std::uint64_t most = 0;
    for (const PartEntry& entry : made.manifest.parts) most = std::max(most, entry.vertices);
    CHECK(static_cast<double>(most) * 28 <= 1.15 * static_cast<double>(mesh.positions.size()));
    CHECK(stream_triangles(made) == triangles_of(mesh));
    for (const unsigned threads : {2U, 5U}) {
      const Generated other =
          generate(test::shuffled(mesh, threads), {.parts = 28, .threads = threads},
                   folder / std::to_string(threads));
      CHECK(made.files == other.files);
      CHECK(made.boundary == other.boundary);
    }
  };
  const test::TempFolder folder;
  const Mesh sheet = test::grid(300, 30);
  for (const double far : {1e2, 1e4, 1e8, 1e30}) {
    CAPTURE(far);
    check_even(test::with_outlier(sheet, far), folder / std::to_string(far));
  }
  Mesh dense = sheet;  // ten thousand times closer on the right
  for (Vec3& p : dense.positions) p.x = 300 * std::pow(1e-4, p.x / 300);
  check_even(dense, folder / "dense");
  Mesh wall = test::with_outlier(sheet, 1);  // all but one at one coordinate
  for (std::size_t v = 0; v + 1 < wall.positions.size(); ++v) {
    Vec3& p = wall.positions[v];
    p = {0, 1e-3 * p.x, 1e-3 * p.y};
  }
  wall.positions.back().x = 300;  // comes last: the sweep goes the same way in any order
  check_even(wall, folder / "wall");
}

TEST_CASE("slabs come out even with many vertices at one point, welded or not") {
  constexpr std::uint32_t k_many = 20'000;
  const Mesh sheet = test::grid(300, 30);
  const Mesh mesh = test::with_crowd(sheet, k_many);
  const test::TempFolder folder;
  for (const Weld weld : {Weld::exact, Weld::off}) {
    const std::filesystem::path here = folder / (weld == Weld::exact ? "welded" : "apart");
    const Generated made = generate(mesh, {.parts = 28, .weld = weld, .threads = 1}, here / "1");
    REQUIRE(made.streams.size() == 28);
    std::uint64_t most = 0;
    std::uint64_t all = 0;
    for (const PartEntry& entry : made.manifest.parts) {
      most = std::max(most, entry.vertices);
      all += entry.vertices;
    }
    CHECK(all == sheet.positions.size() + (weld == Weld::off ? k_many : 0));
    CHECK(static_cast<double>(most) * 28 <= 1.15 * static_cast<double>(all));
    CHECK(made.manifest.coincident_vertices == (weld == Weld::off ? 0 : k_many));
    for (const unsigned threads : {2U, 5U}) {
      const Mesh other = weld == Weld::exact ? test::shuffled(mesh, threads) : mesh;
      const Generated again = generate(other, {.parts = 28, .weld = weld, .threads = threads},
                                       here / std::to_string(threads));
      CHECK(made.files == again.files);
      CHECK(made.boundary == again.boundary);
    }
  }
}

TEST_CASE("a stream's vertices come in order, and triangles by their smallest vertex") {
  const test::TempFolder folder;
  const Generated made =
      generate(test::shuffled(test::torus(80, 30), 3), {.parts = 1}, folder.path());
  StreamReader reader(fill_from(made.files[0], "stream"), "stream");
  StreamBlock block;
  double last = -HUGE_VAL;
  std::uint32_t smallest = 0;
  while (reader.next(block)) {
    for (const Vec3& p : block.positions) {
      REQUIRE(p.x >= last);
      last = p.x;
    }
    for (const auto& t : block.triangles) {
      const std::uint32_t least = std::min({t[0].vertex(), t[1].vertex(), t[2].vertex()});
      REQUIRE(least >= smallest);
      smallest = least;
    }
  }
}

TEST_CASE("the order of the input and the number of threads do not matter") {
  const Mesh mesh = test::torus(70, 30);
  const test::TempFolder folder;
  const Generated first = generate(mesh, {.parts = 4, .threads = 1}, folder / "a");
  const Generated second =
      generate(test::shuffled(mesh, 1), {.parts = 4, .threads = 3}, folder / "b");
  const Generated third =
      generate(test::shuffled(mesh, 2), {.parts = 4, .threads = 2}, folder / "c");
  CHECK(first.files == second.files);
  CHECK(first.files == third.files);
  CHECK(first.boundary == second.boundary);
}

TEST_CASE("coincident vertices are welded, degenerate and duplicate triangles dropped") {
  Mesh mesh = test::torus(60, 24);
  // Every triangle gets corners of its own: only welding makes it a surface again.
  Mesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t v : t) soup.positions.push_back(mesh.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  soup.triangles.push_back({0, 0, 1});
  const test::TempFolder folder;
  const Generated made = generate(soup, {.parts = 3}, folder / "welded");
  CHECK(made.manifest.coincident_vertices == soup.positions.size() - mesh.positions.size());
  CHECK(made.manifest.dropped_degenerate == 1);
  CHECK(stream_triangles(made) == triangles_of(mesh));
  std::uint64_t vertices = 0;
  for (const PartEntry& entry : made.manifest.parts) vertices += entry.vertices;
  CHECK(vertices == mesh.positions.size());

  const Generated apart = generate(soup, {.parts = 3, .weld = Weld::off}, folder / "apart");
  CHECK(apart.manifest.coincident_vertices == 0);
  CHECK(apart.manifest.boundary_triangles < made.manifest.boundary_triangles * 2);
}

TEST_CASE(
    "slabs that are not sorted keep the order of the input, and the boundary knows its vertices") {
  const Mesh mesh = test::torus(60, 24);
  const test::TempFolder folder;
  const Generated sorted = generate(mesh, {.parts = 3}, folder / "sorted");
  test::MemorySource source(mesh);
  const Stage stage = Stage::create(folder / "slabs");
  const Manifest slabs =
      cut_mesh(source, stage, {.scheme = Scheme::stream, .parts = 3, .sort = SortAt::farm});
  REQUIRE(slabs.sorting.has_value());
  CHECK(slabs.samples.empty());
  CHECK(slabs.triangles() == mesh.triangles.size());
  CHECK(read_boundary(stage, slabs.boundary) == sorted.boundary);
  std::uint64_t vertices = 0;
  for (std::size_t s = 0; s < 3; ++s) {
    const PartEntry& entry = slabs.parts[s];
    CHECK(entry.boundary_vertices == sorted.manifest.parts[s].boundary_vertices);
    const MeshShare slab = decode_slab(stage.read(entry.file), "slab");
    CHECK(slab.positions.size() == entry.vertices);
    CHECK(slab.triangles.size() == entry.triangles);
    CHECK(slab.boundary.size() == entry.boundary_vertices);  // none is welded
    auto at = mesh.positions.begin();
    for (const Vec3& p : slab.positions) {
      at = std::find(at, mesh.positions.end(), p);
      REQUIRE(at != mesh.positions.end());
    }
    vertices += entry.vertices;
  }
  CHECK(vertices == mesh.positions.size());
}

TEST_CASE("surfaces that touch are not welded together") {
  const Mesh octahedron = test::octahedron();
  const Mesh mesh = test::touching_twice(octahedron, octahedron.positions[0]);
  const test::TempFolder folder;
  const Generated made = generate(mesh, {.parts = 1}, folder / "touching");
  CHECK(made.manifest.coincident_vertices == 1);
  CHECK(made.manifest.parts[0].vertices == 12);
}

TEST_CASE("how many triangles have two corners at one place does not depend on the seams") {
  const test::TempFolder folder;
  for (const std::uint32_t streams : {1U, 2U, 5U}) {
    const Generated made = generate(test::torus_with_neck(40, 20), {.parts = streams},
                                    folder / std::to_string(streams));
    CHECK(made.manifest.coincident_corners == 40);
  }
}

TEST_CASE("where surfaces touch the order of the input does not matter either") {
  const Mesh octahedron = test::octahedron();
  const Triangle& t = octahedron.triangles[0];
  const Vec3 middle = (octahedron.positions[t[0]] + octahedron.positions[t[1]]) * 0.5;
  for (const Vec3 point : {octahedron.positions[0], middle}) {
    Mesh mesh = test::touching_twice(octahedron, point);
    test::append(mesh, test::torus(12, 8));
    const test::TempFolder folder;
    const Generated first = generate(mesh, {.parts = 1}, folder / "first");
    for (unsigned seed = 1; seed < 20; ++seed) {
      CAPTURE(seed);
      const Generated other =
          generate(test::shuffled(mesh, seed), {.parts = 1}, folder / std::to_string(seed));
      CHECK(first.files == other.files);
    }
  }
}

TEST_CASE("where surfaces touch at seams it is decided as if there were none") {
  const Mesh tips = test::touching_row(40, false);
  const Mesh edges = test::touching_row(40, true);
  const Mesh necks = test::torus_with_necks(60, 5);
  for (const Mesh& mesh : {tips, edges, necks}) {
    const Topology whole = measure_topology(mesh);
    CAPTURE(whole.components);
    const test::TempFolder folder;
    for (const std::uint32_t streams : {1U, 4U, 16U}) {
      std::string files;
      for (unsigned seed = 0; seed < 5; ++seed) {
        CAPTURE(streams);
        CAPTURE(seed);
        const Generated made =
            generate(seed == 0 ? mesh : test::shuffled(mesh, seed), {.parts = streams},
                     folder / std::to_string(8 * streams + seed));
        const Topology got = measure_topology(test::joined(made.streams, made.boundary));
        CHECK(got.used_vertices == whole.used_vertices);
        CHECK(got.triangles == whole.triangles);
        CHECK(got.components == whole.components);
        CHECK(got.euler == whole.euler);
        CHECK(got.nonmanifold_edges == 0);
        CHECK(made.manifest.coincident_vertices == test::count_coincident(mesh));
        CHECK(made.manifest.coincident_corners == test::count_flat(mesh));
        std::string all;
        for (const std::string& file : made.files) all += file;
        if (seed == 0) files = all;
        CHECK(all == files);
      }
    }
  }
}

TEST_CASE("slabs tell what stays apart at their seams to whoever sorts them") {
  for (const Mesh& mesh : {test::touching_row(40, true), test::torus_with_necks(60, 5)}) {
    const test::TempFolder folder;
    const Generated here = generate(mesh, {.parts = 16}, folder / "here");
    test::MemorySource source(test::shuffled(mesh, 1));
    const Stage stage = Stage::create(folder / "slabs");
    const Manifest slabs =
        cut_mesh(source, stage, {.scheme = Scheme::stream, .parts = 16, .sort = SortAt::farm});
    bool some_stay_apart = false;
    for (std::size_t s = 0; s < slabs.parts.size(); ++s) {
      MeshShare slab = decode_slab(stage.read(slabs.parts[s].file), "slab");
      some_stay_apart = some_stay_apart || !slab.apart.empty();
      const SortedSlab sorted = sort_slab(std::move(slab), *slabs.sorting);
      CHECK(encode_stream(sorted.stream) == here.files[s]);
      CHECK(sorted.boundary_vertices == slabs.parts[s].boundary_vertices);
    }
    CHECK(some_stay_apart);
    CHECK(read_boundary(stage, slabs.boundary) == here.boundary);
  }
}

TEST_CASE("long streams get a sample: a piece of them with its edge locked") {
  const Mesh mesh = test::grid(700, 300);
  const test::TempFolder folder;
  const Generated made = generate(mesh, {.parts = 2, .window_triangles = 100'000}, folder.path());
  const Stage stage = Stage::open(folder.path());
  REQUIRE(made.manifest.samples.size() == 2);
  for (std::size_t s = 0; s < 2; ++s) {
    const PartEntry& entry = made.manifest.samples[s];
    CHECK(entry.triangles == doctest::Approx(60'000).epsilon(0.1));
    const Part part = decode_part(stage.read(entry.file), "sample");
    CHECK(part.mesh.triangles.size() == entry.triangles);
    std::vector<Corners> whole = triangles_of(made.streams[s].mesh);
    const std::vector<Corners> some = triangles_of(part.mesh);
    CHECK(std::includes(whole.begin(), whole.end(), some.begin(), some.end()));
    Box box;
    for (const Vec3& p : part.mesh.positions) box.add(p);
    for (std::uint32_t v = 0; v < part.mesh.positions.size(); ++v) {
      const Vec3 p = part.mesh.positions[v];
      const bool inner = p.y > box.lo.y && p.y < box.hi.y && p.x > box.lo.x && p.x < box.hi.x;
      if (inner) REQUIRE(v >= part.boundary_vertices);
      // The seam with the other stream is locked, as are the sides.
      if (p.y == box.lo.y && p.y > 0) REQUIRE(v < part.boundary_vertices);
    }
  }
  CHECK(generate(mesh, {.parts = 2}, folder / "short").manifest.samples[0].file.name.empty());
}

TEST_CASE("there are more streams than asked for if one would not fit into the memory") {
  const test::TempFolder folder;
  const Generated made = generate(
      test::torus(300, 100), {.parts = 2, .memory_bytes = std::uint64_t{1} << 20}, folder.path());
  CHECK(made.streams.size() >= 8);
  CHECK(made.manifest.triangles() == 60'000);
}

TEST_CASE("meshes of almost nothing, and of one layer") {
  const test::TempFolder folder;
  CHECK(generate({}, {}, folder / "none").streams.empty());
  CHECK(generate(test::tetrahedron(), {.parts = 9}, folder / "four").manifest.triangles() == 4);
  Mesh wall = test::grid(30, 30);
  for (Vec3& p : wall.positions) p.x = p.y = 0;
  CHECK(generate(wall, {.parts = 4}, folder / "point").streams.size() == 1);
  CHECK(default_parts(Scheme::stream, 0) == 1);
  CHECK(default_parts(Scheme::stream, 28'065'032) == 24);
  CHECK(default_parts(Scheme::stream, 134'184'962) == 112);
}

TEST_CASE("a stop publishes no manifest") {
  const test::TempFolder folder;
  const std::atomic<bool> stop = true;
  test::MemorySource source(test::torus(30, 20));
  const Stage stage = Stage::create(folder.path());
  CHECK_THROWS_AS(cut_mesh(source, stage, {.scheme = Scheme::stream, .stop = &stop}),
                  IncompleteError);
  CHECK_FALSE(stage.has_manifest());
}

TEST_CASE("of axes that are equally long the one is swept along which the file is in order") {
  const auto order_of = [](const std::vector<Vec3>& positions) {
    OrderProbe probe;
    probe.look_at(positions);
    Box box;
    for (const Vec3& p : positions) box.add(p);
    return probe.choose(box);
  };
  std::vector<Vec3> rows;  // y falls from row to row
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 10; ++x) rows.push_back({1.0 * x, -1.0 * y, 0});
  }
  CHECK(order_of(rows).axes[0] == 1);
  CHECK(order_of(rows).sign == -1);
  std::reverse(rows.begin(), rows.end());
  CHECK(order_of(rows).axes[0] == 1);
  CHECK(order_of(rows).sign == 1);
  rows.push_back({20, 0, 0});  // the longest axis wins, in order or not
  CHECK(order_of(rows).axes[0] == 0);
  std::mt19937 random(5);
  std::shuffle(rows.begin(), rows.end(), random);
  CHECK(order_of(rows).axes[0] == 0);
}
