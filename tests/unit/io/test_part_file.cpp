// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <limits>

#include <doctest/doctest.h>

#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/damage.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

Manifest sample_manifest() {
  Manifest m;
  m.input = "lucy.ply";
  m.input_format = "PLY binary little endian";
  m.partitioner = "METIS 5.1.0";
  m.positions = PositionType::float64;
  m.box.add({-1, -2, -3});
  m.box.add({1, 2, 3});
  m.input_vertices = std::uint64_t{5} << 32;
  m.input_triangles = std::uint64_t{10} << 32;
  m.near_merges = {1e-7, std::uint64_t{6} << 32};
  m.coincident_vertices = 7;
  m.dropped_degenerate = 8;
  m.coincident_corners = 13;
  m.dropped_not_finite = 12;
  m.dropped_duplicate = 9;
  m.channels = {{{"red", ChannelType::uint8, ChannelRole::colour}}, {"channels", 5, 6}, 7};
  m.labels = LabelMeaning{"material", {{"stone", {0.5, 0.25, 1, 1}}, {"glass", {}}}};
  m.label_corners = std::uint64_t{3} << 32;
  m.skipped = {"vertex.red", "face.flags"};
  m.cut_seconds = 1.5;
  m.boundary_triangles = 11;
  m.boundary = {{{"boundary", 100, 42}, {24, 32, 44}, 0}};
  m.parts = {{{"parts/000000.part", 200, 43}, 12, 20, 3},
             {{"parts/000001.part", 300, 44}, 5, 6, 5}};
  return m;
}

}  // namespace

TEST_CASE("a part comes back, in both kinds of positions") {
  for (const PositionType type : {PositionType::float32, PositionType::float64}) {
    Part part{test::icosphere(1), 5, type};
    for (Vec3& p : part.mesh.positions) p = rounded(p, type);
    const Part back = decode_part(encode_part(part), "part");
    CHECK(back.mesh.positions == part.mesh.positions);
    CHECK(back.mesh.triangles == part.mesh.triangles);
    CHECK(back.boundary_vertices == 5);
    CHECK(back.positions == type);
  }
  const Part empty = decode_part(encode_part({}), "part");
  CHECK(empty.mesh.triangles.empty());
}

TEST_CASE("labels come back with a part") {
  Part part{test::icosphere(1), 5, PositionType::float32};
  for (Vec3& p : part.mesh.positions) p = rounded(p, part.positions);
  for (Label i = 0; i < part.mesh.triangles.size(); ++i) part.mesh.columns.labels.push_back(~i);
  const std::string file = encode_part(part);
  const Part back = decode_part(file, "part");
  CHECK(back.mesh.columns.labels == part.mesh.columns.labels);
  CHECK(back.mesh.triangles == part.mesh.triangles);
  test::check_refuses_damage(file, [](std::string_view bytes) { return decode_part(bytes, "p"); });
}

TEST_CASE("texture coordinates come back with a part, and those that are no numbers are refused") {
  Part part{test::icosphere(1), 5, PositionType::float32};
  for (Vec3& p : part.mesh.positions) p = rounded(p, part.positions);
  for (std::size_t i = 0; i < part.mesh.triangles.size(); ++i) {
    const auto u = static_cast<float>(i);
    part.mesh.columns.uvs.push_back({{{u, 0}, {0, -u}, {0.5F * u, 1}}});
  }
  CHECK(decode_part(encode_part(part), "part").mesh.columns.uvs == part.mesh.columns.uvs);
  part.mesh.columns.uvs[3][1][0] = std::numeric_limits<float>::infinity();
  CHECK_THROWS_AS(decode_part(encode_part(part), "part"), DataError);
}

TEST_CASE("a damaged part is refused") {
  test::check_refuses_damage(encode_part({test::tetrahedron(), 1, PositionType::float32}),
                             [](std::string_view file) { return decode_part(file, "part"); });
}

TEST_CASE("a part that does not fit together is refused, though its checksum is right") {
  Part part{test::tetrahedron(), 5, PositionType::float32};
  CHECK_THROWS_AS(decode_part(encode_part(part), "part"), DataError);  // 5 boundary vertices of 4
  part.boundary_vertices = 0;
  part.mesh.triangles[2][1] = 4;
  CHECK_THROWS_AS(decode_part(encode_part(part), "part"), DataError);
  part.mesh.triangles[2][1] = 3;
  part.mesh.positions[0].y = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(decode_part(encode_part(part), "part"), DataError);
}

TEST_CASE("a summary comes back, and one that contradicts itself is refused") {
  ResultSummary summary{{{-1, 100, 50, 40}, {3, 60, 30, 20}}, 4, 5};
  const ResultSummary back = decode_summary(encode_summary(summary), "s");
  CHECK(back.rungs.size() == 2);
  CHECK(back.rungs[1].level == 3);
  CHECK(back.rungs[1].free_triangles == 20);
  CHECK(back.dropped_duplicate == 5);
  summary.rungs[1].level = -1;
  CHECK_THROWS_AS(decode_summary(encode_summary(summary), "s"), DataError);
  summary.rungs[1] = {3, 60, 51, 20};
  CHECK_THROWS_AS(decode_summary(encode_summary(summary), "s"), DataError);
  summary.rungs.clear();
  CHECK_THROWS_AS(decode_summary(encode_summary(summary), "s"), DataError);
}

TEST_CASE("boundary triangles come back, damaged ones are refused") {
  const std::vector<BoundaryTriangle> triangles = {{{{1, 0}, {1, 1}, {0, 0xffffffff}}},
                                                   {{{0, 1}, {2, 3}, {4, 5}}}};
  CHECK(decode_boundary(encode_boundary(6, triangles).file, "b") == triangles);
  CHECK(decode_boundary(encode_boundary(1, {}).file, "b").empty());
  TriangleColumns columns;
  columns.labels = {9};
  CHECK(decode_boundary(encode_boundary(6, triangles).file, "b", columns) == triangles);
  CHECK(columns.empty());
  const std::vector<Label> labels = {7, 0xffffffff};
  const std::vector<CornerUvs> uvs = {{{{0, 1}, {2, 3}, {4, 5}}}, {{{0, 0}, {-1, 0}, {0.5, 7}}}};
  for (const TriangleColumnsView& given :
       {TriangleColumnsView{labels, {}}, TriangleColumnsView{{}, uvs},
        TriangleColumnsView{labels, uvs}}) {
    CHECK(decode_boundary(encode_boundary(6, triangles, given).file, "b", columns) == triangles);
    CHECK(columns.labels == std::vector<Label>(given.labels.begin(), given.labels.end()));
    CHECK(columns.uvs == std::vector<CornerUvs>(given.uvs.begin(), given.uvs.end()));
  }
  test::check_refuses_damage(encode_boundary(6, triangles).file, [](std::string_view file) {
    return decode_boundary(file, "boundary");
  });
}

TEST_CASE("boundary triangles are shown one by one, and what is no side file is refused") {
  std::vector<BoundaryTriangle> triangles;
  for (std::uint32_t i = 0; i < 10'000; ++i) triangles.push_back({{{0, i}, {1, i}, {2, 7}}});
  const auto scanned = [](const std::string& file) {
    std::vector<BoundaryTriangle> shown;
    TriangleColumns columns;
    scan_boundary(fill_from(file, "b"), "b",
                  [&](const auto& some, const TriangleColumnsView& of_some) {
                    shown.insert(shown.end(), some.begin(), some.end());
                    columns.append(of_some);
                  });
    CHECK(TriangleColumnsView(columns).fits(columns.set(), shown.size()));
    return shown;
  };
  const std::string file = encode_boundary(3, triangles).file;
  CHECK(scanned(file) == triangles);
  CHECK(scanned(encode_boundary(1, {}).file).empty());
  const std::vector<Label> labels(10'000, 3);
  const std::vector<CornerUvs> uvs(10'000);
  CHECK(scanned(encode_boundary(3, triangles, {labels, {}}).file) == triangles);
  CHECK(scanned(encode_boundary(3, triangles, {labels, uvs}).file) == triangles);
  CHECK_THROWS_AS(scanned(file.substr(0, file.size() - 1)), DataError);
  CHECK_THROWS_AS(scanned(encode_part({})), DataError);
  for (const std::size_t place : {16, 23, 24, 31}) {  // sizes and counts
    std::string damaged = file;
    damaged[place] = static_cast<char>(damaged[place] ^ 0x55);
    CHECK_THROWS_AS(scanned(damaged), DataError);
  }
}

TEST_CASE("a manifest comes back whole") {
  const Manifest m = sample_manifest();
  const Manifest back = decode_manifest(encode_manifest(m), "manifest");
  CHECK(encode_manifest(back) == encode_manifest(m));
  CHECK(back.input == "lucy.ply");
  CHECK(back.partitioner == "METIS 5.1.0");
  CHECK(back.near_merges.distance == 1e-7);
  CHECK(back.near_merges.vertices == std::uint64_t{6} << 32);
  CHECK(back.coincident_corners == 13);
  CHECK(back.dropped_not_finite == 12);
  CHECK(back.input_triangles == std::uint64_t{10} << 32);
  CHECK(back.channels.channels == m.channels.channels);
  CHECK(back.channels.file == m.channels.file);
  CHECK(back.channels.points == 7);
  CHECK(back.labels == m.labels);
  CHECK(back.label_corners == m.label_corners);
  CHECK(back.skipped == m.skipped);
  CHECK(back.parts[1].file == m.parts[1].file);
  CHECK(back.box.hi == Vec3{1, 2, 3});
  CHECK(back.triangles() == 20 + 6 + 11);
}

TEST_CASE("a manifest tells of texture coordinates and pictures") {
  Manifest m = sample_manifest();
  m.uvs = true;
  m.uv_floor = 77;
  m.uv_side = 0.25;
  m.pictures = {{"atlas.jpg", {"parts/000000.picture", 5, 6}}};
  m.labels->materials[1].maps = {{MapUse::colour, 0}, {MapUse::normal, 0}};
  m.labels->materials[1].wrap_v = TextureWrap::mirror;
  const Manifest back = decode_manifest(encode_manifest(m), "manifest");
  CHECK(back.uvs);
  CHECK(back.uv_floor == 77);
  CHECK(back.uv_side == 0.25);
  CHECK(back.labels == m.labels);
  REQUIRE(back.pictures.size() == 1);
  CHECK(back.pictures[0].name == "atlas.jpg");
  CHECK(back.pictures[0].file == m.pictures[0].file);
  m.labels->materials[1].maps[1].picture = 1;
  CHECK_THROWS_AS(decode_manifest(encode_manifest(m), "manifest"), DataError);
}

TEST_CASE("a manifest of slabs tells how they are to be sorted, and of nothing else") {
  Manifest m = sample_manifest();
  m.scheme = Scheme::stream;
  m.sorting = Sorting{{{2, 0, 1}, -1}, Weld::off};
  CHECK_THROWS_AS(decode_manifest(encode_manifest(m), "manifest"), DataError);  // these are parts
  for (std::size_t i = 0; i < 2; ++i) m.parts[i].file.name = to_string(SlabName{7});
  const Manifest back = decode_manifest(encode_manifest(m), "manifest");
  REQUIRE(back.sorting.has_value());
  CHECK(back.sorting->order.axes == std::array<int, 3>{2, 0, 1});
  CHECK(back.sorting->order.sign == -1);
  CHECK(back.sorting->weld == Weld::off);
  CHECK(back.parts[1].file == m.parts[1].file);
  test::check_refuses_damage(
      encode_manifest(m), [](std::string_view file) { return decode_manifest(file, "manifest"); });
  for (const std::array<int, 3> axes : {std::array<int, 3>{0, 1, 1}, {0, 1, 3}}) {
    m.sorting->order.axes = axes;
    CHECK_THROWS_AS(decode_manifest(encode_manifest(m), "manifest"), DataError);
  }
  m.sorting = Sorting{};
  m.samples = m.parts;
  CHECK_THROWS_AS(decode_manifest(encode_manifest(m), "manifest"), DataError);
  m.samples.clear();
  m.sorting.reset();
  CHECK_THROWS_AS(decode_manifest(encode_manifest(m), "manifest"), DataError);  // no streams
  m.sorting = Sorting{};
  m.scheme = Scheme::cut;
  CHECK_THROWS_AS(decode_manifest(encode_manifest(m), "manifest"), DataError);
}

TEST_CASE("a manifest of what a run is to cut has that alone, and no parts") {
  Manifest m = sample_manifest();
  m.cutting = Cutting{"/data/lucy.ply", 190, -7, 28, 5, 9};
  m.boundary = {};
  CHECK_THROWS_AS(decode_manifest(encode_manifest(m), "manifest"), DataError);  // it has parts
  m.parts.clear();
  const Manifest back = decode_manifest(encode_manifest(m), "manifest");
  CHECK(back.cutting == m.cutting);
  CHECK(back.triangles() == m.input_triangles);
  CHECK(back.part_count() == 28);
  test::check_refuses_damage(
      encode_manifest(m), [](std::string_view file) { return decode_manifest(file, "manifest"); });
  for (const std::uint32_t blocks : {0U, k_most_cut_blocks + 1}) {
    m.cutting->vertex_blocks = blocks;
    CHECK_THROWS_AS(decode_manifest(encode_manifest(m), "manifest"), DataError);
  }
  m.cutting->vertex_blocks = 1;
  m.scheme = Scheme::stream;
  CHECK_THROWS_AS(decode_manifest(encode_manifest(m), "manifest"), DataError);
}

TEST_CASE("a result holds bytes beside its mesh, and its summary tells where") {
  const std::string beside(100'000, 'b');
  std::string file;
  ResultWriter writer(
      {PositionType::float32, false, 2}, [&](std::string_view bytes) { file += bytes; }, beside);
  const Mesh mesh = test::tetrahedron();
  writer.add_rung(3, mesh, 4);
  writer.finish(std::span(mesh.positions).first(2), {});
  CHECK(file.substr(writer.beside().offset, writer.beside().size) == beside);
  CHECK(writer.beside().hash == checksum(beside));
  CHECK(decode_result(file, 0, "result").mesh.triangles == mesh.triangles);
  file[writer.beside().offset + 50'000] = 'c';
  CHECK_THROWS_AS(decode_result(file, 0, "result"), DataError);
  ResultSummary summary{writer.rungs()};
  CHECK_FALSE(decode_summary(encode_summary(summary), "s").built.has_value());
  summary.built = BuiltFacts{10, 11, 2, 12, 3, 4, 5, 6};
  const auto back = decode_summary(encode_summary(summary), "s").built;
  REQUIRE(back.has_value());
  CHECK(back->boundary_vertices == 2);
  CHECK(back->shared_triangles == 12);
  CHECK(back->shared_boundary == 3);
  CHECK(back->coincident_corners == 6);
  summary.built->boundary_vertices = 12;
  CHECK_THROWS_AS(decode_summary(encode_summary(summary), "s"), DataError);
}

TEST_CASE("a manifest that is damaged or names a file outside its place is refused") {
  test::check_refuses_damage(encode_manifest(sample_manifest()), [](std::string_view file) {
    return decode_manifest(file, "manifest");
  });
  for (const char* name : {"../part", "/parts/000001.part", "boundary", "results/x"}) {
    Manifest m = sample_manifest();
    m.parts[0].file.name = name;
    CAPTURE(name);
    CHECK_THROWS_AS(decode_manifest(encode_manifest(m), "manifest"), DataError);
  }
}

TEST_CASE("a part's appearances come back, and cost nothing where there are none") {
  Part part{test::icosphere(1), 5, PositionType::float32};
  for (Vec3& p : part.mesh.positions) p = rounded(p, part.positions);
  const std::string plain = encode_part(part);
  part.mesh.appearances = test::appearances(part.mesh.positions.size());
  const std::string file = encode_part(part);
  CHECK(file.size() == plain.size() + sizeof(Appearance) * part.mesh.positions.size());
  const Part back = decode_part(file, "part");
  CHECK(back.mesh.appearances == part.mesh.appearances);
  CHECK(back.mesh.positions == part.mesh.positions);
  CHECK(decode_part(plain, "part").mesh.appearances.empty());
}
