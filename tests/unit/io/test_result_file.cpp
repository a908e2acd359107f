// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <doctest/doctest.h>

#include <meshfarm/io/result_file.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/damage.hpp"
#include "support/meshes.hpp"
#include "support/seeds.hpp"

using namespace meshfarm;

namespace {

ResultWriter writer_to(std::string& file, PositionType positions, std::uint32_t boundary) {
  return {{positions, false, boundary}, [&file](std::string_view bytes) { file += bytes; }};
}

std::span<const Vec3> first_two(const Mesh& mesh) {
  return std::span(mesh.positions).first(2);
}

/// A ladder of meshes that share their first two vertices.
std::string ladder() {
  std::vector<Mesh> meshes = {test::icosphere(1), test::icosphere(0), test::tetrahedron()};
  std::string file;
  ResultWriter writer = writer_to(file, PositionType::float64, 2);
  for (Mesh& mesh : meshes) {
    std::copy_n(meshes[0].positions.begin(), 2, mesh.positions.begin());
    const std::vector<std::uint32_t> opened = {1, 3};
    writer.add_rung(10 * static_cast<std::int32_t>(writer.rungs().size()), mesh, 2, 0, 0, opened);
  }
  const std::vector<SurfaceSamples> samples = {{2.5, {{1, 2, 3}, {4, 5, 6}}}, {1.5, {}}};
  writer.finish(first_two(meshes[0]), samples);
  return file;
}

}  // namespace

TEST_CASE("each rung of a result comes back") {
  const std::string file = ladder();
  test::check_seed("result", "ladder", file);
  const ResultMesh first = decode_result(file, 0, "r");
  CHECK(first.mesh.positions == test::icosphere(1).positions);
  CHECK(first.mesh.triangles == test::icosphere(1).triangles);
  CHECK(first.boundary_vertices == 2);
  CHECK(first.opened == std::vector<std::uint32_t>{1, 3});
  REQUIRE(first.samples.size() == 2);
  CHECK(first.samples[0].area == 2.5);
  CHECK(first.samples[0].points[1] == Vec3{4, 5, 6});
  CHECK(first.samples[1].points.empty());
  const ResultMesh last = decode_result(file, 2, "r");
  CHECK(last.mesh.triangles == test::tetrahedron().triangles);
  CHECK(last.mesh.positions[0] == first.mesh.positions[0]);
  CHECK(last.mesh.positions[3] == test::tetrahedron().positions[3]);
  CHECK_THROWS_AS(decode_result(file, 3, "r"), DataError);
}

TEST_CASE("a rung is read by its own section and the tail") {
  std::string file;
  ResultWriter writer(
      {PositionType::float32, false, 2}, [&file](std::string_view bytes) { file += bytes; },
      "other bytes");
  const std::vector<Mesh> meshes = {test::grid(300, 250), test::icosphere(3), test::tetrahedron()};
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    writer.add_rung(static_cast<std::int32_t>(i), meshes[i], 0);
  }
  writer.finish(first_two(meshes[0]), {});
  const auto bytes_of = [&](const FileSection& section) {
    const std::string bytes = file.substr(section.offset, section.size);
    CHECK(checksum(bytes) == section.hash);
    return bytes;
  };
  const std::string tail = bytes_of(writer.tail());
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const std::string rung = bytes_of(writer.rungs()[i].section);
    const ResultMesh back = decode_rung(rung, tail, i, "r");
    CHECK(back.mesh.triangles == meshes[i].triangles);
    CHECK(back.mesh.positions == decode_result(file, i, "r").mesh.positions);
    const std::string other = bytes_of(writer.rungs()[(i + 1) % meshes.size()].section);
    CHECK_THROWS_AS(decode_rung(other, tail, i, "r"), DataError);
    CHECK_THROWS_AS(decode_rung(std::string_view(rung).substr(1), tail, i, "r"), DataError);
    CHECK_THROWS_AS(decode_rung(rung, std::string_view(tail).substr(1), i, "r"), DataError);
    CHECK_THROWS_AS(decode_rung(rung, tail, meshes.size(), "r"), DataError);
  }
  CHECK(writer.rungs()[2].section.size + tail.size() < file.size() / 1000);
}

TEST_CASE("what a result holds beside its mesh is a section of its file") {
  const Mesh mesh = test::tetrahedron();
  for (const std::string beside : {"", "other bytes"}) {
    std::string file;
    ResultWriter writer(
        {PositionType::float32, false, 2}, [&file](std::string_view bytes) { file += bytes; },
        beside);
    writer.add_rung(0, mesh, 4);
    writer.finish(first_two(mesh), {});
    CHECK(decode_result(file, 0, "r").mesh.triangles == mesh.triangles);
    CHECK(file.substr(writer.beside().offset, writer.beside().size) == beside);
  }
}

TEST_CASE("labels come back with each rung") {
  Mesh mesh = test::grid(300, 250);
  for (Label i = 0; i < mesh.triangles.size(); ++i) mesh.columns.labels.push_back(i / 3);
  Mesh less = mesh;
  less.triangles.resize(1000);
  less.columns.labels.resize(1000);
  std::string file;
  ResultWriter writer({PositionType::float32, false, 2, {true}},
                      [&file](std::string_view bytes) { file += bytes; });
  writer.add_rung(3, mesh, 100);
  writer.add_rung(4, less, 100);
  writer.finish(first_two(mesh), {});
  CHECK(decode_result(file, 0, "r").mesh.columns.labels == mesh.columns.labels);
  CHECK(decode_result(file, 1, "r").mesh.columns.labels == less.columns.labels);
  CHECK(decode_result(file, 1, "r").mesh.triangles == less.triangles);
  less.columns.labels.clear();
  CHECK_THROWS_AS(writer.add_rung(5, less, 100), Error);
}

TEST_CASE("a result written piece by piece is the mesh that it would be in one") {
  const Mesh mesh = test::grid(300, 250);  // 150,000 triangles: more than a block takes
  std::string whole;
  ResultWriter all = writer_to(whole, PositionType::float32, 2);
  all.add_rung(3, mesh, 100);
  all.finish(first_two(mesh), {});
  std::string pieces;
  ResultWriter some = writer_to(pieces, PositionType::float32, 2);
  const std::span<const Vec3> vertices(mesh.positions);
  const std::span<const Triangle> triangles(mesh.triangles);
  some.add(vertices.subspan(2, 70'000), triangles.first(10));
  some.add({}, triangles.subspan(10));  // they use vertices that are still to come
  some.add(vertices.subspan(70'002), {});
  some.end_rung(3, 100);
  some.finish(first_two(mesh), {});
  CHECK(some.rungs()[0].vertices == mesh.positions.size());
  CHECK(some.rungs()[0].triangles == mesh.triangles.size());
  for (const std::string* file : {&whole, &pieces}) {
    const ResultMesh back = decode_result(*file, 0, "r");
    CHECK(back.mesh.positions == mesh.positions);
    CHECK(back.mesh.triangles == mesh.triangles);
    CHECK(back.samples.empty());
  }
}

TEST_CASE("a damaged result is refused") {
  std::string file;
  ResultWriter writer = writer_to(file, PositionType::float32, 2);
  writer.add_rung(0, test::octahedron(), 3);
  writer.add_rung(1, test::tetrahedron(), 0);
  const std::vector<SurfaceSamples> samples = {{2.5, {{1, 2, 3}}}};
  writer.finish(first_two(test::octahedron()), samples);
  test::check_refuses_damage(
      file, [](std::string_view damaged) { return decode_result(damaged, 1, "result"); });
  CHECK_THROWS_AS(decode_result(file + "x", 1, "result"), DataError);
}

TEST_CASE("a result that does not fit together is refused, though its checksum is right") {
  Mesh mesh = test::tetrahedron();
  mesh.triangles[2][1] = 4;
  std::string file;
  ResultWriter writer = writer_to(file, PositionType::float32, 0);
  writer.add_rung(0, mesh, 0);
  writer.finish({}, {});
  CHECK_THROWS_WITH_AS(decode_result(file, 0, "r"),
                       "r: a triangle uses a vertex that is not there at byte 88", DataError);
}

TEST_CASE("opened vertices that are not there, or not in order, are refused") {
  using Numbers = std::vector<std::uint32_t>;
  for (const Numbers& opened : {Numbers{4}, Numbers{2, 1}, Numbers{1, 1}}) {
    std::string file;
    ResultWriter writer = writer_to(file, PositionType::float32, 0);
    writer.add_rung(0, test::tetrahedron(), 0, 0, 0, opened);
    writer.finish({}, {});
    CHECK_THROWS_AS(decode_result(file, 0, "r"), DataError);
  }
}

TEST_CASE("a rung may be empty") {
  std::string file;
  ResultWriter writer = writer_to(file, PositionType::float32, 0);
  writer.add_rung(0, test::tetrahedron(), 4);
  writer.add_rung(1, {}, 0);
  writer.finish({}, {});
  CHECK(decode_result(file, 0, "r").mesh.triangles.size() == 4);
  CHECK(decode_result(file, 1, "r").mesh.triangles.empty());
}

TEST_CASE("a summary comes back; a damaged one is refused") {
  const std::vector<Rung> rungs = {{3, 5, 10, 8, 0.5, {16, 100, 1}, 0},
                                   {4, 3, 6, 2, 0.75, {116, 50, 2}, 12}};
  for (const LadderEnd end : {LadderEnd::floor, LadderEnd::enough, LadderEnd::refusals}) {
    const bool held = end == LadderEnd::refusals;
    const std::string bytes =
        encode_summary({rungs, 7, 9, held, 11, {}, end, {166, 9, 3}, {16, 0, 4}});
    const ResultSummary back = decode_summary(bytes, "s");
    CHECK(back.held_by_topology == held);
    CHECK(back.end == end);
    CHECK(back.dropped_degenerate == 7);
    CHECK(back.dropped_duplicate == 9);
    CHECK(back.turned == 11);
    REQUIRE(back.rungs.size() == 2);
    CHECK(back.rungs[1].level == 4);
    CHECK(back.rungs[1].free_triangles == 2);
    CHECK(back.rungs[0].refused == 0);
    CHECK(back.rungs[1].refused == 12);
    CHECK(place_of(back, 1).rung == FileSection{116, 50, 2});
    CHECK(place_of(back, 1).tail == FileSection{166, 9, 3});
    CHECK(place_of(back, 1).beside == FileSection{16, 0, 4});
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      CHECK_THROWS_AS(decode_summary(std::string_view(bytes).substr(0, i), "s"), DataError);
    }
    CHECK_THROWS_AS(decode_summary(bytes + "x", "s"), DataError);
  }
  std::string impossible = encode_summary({rungs, 7, 9, true});
  impossible[16] = 2;  // `held`, which follows two counts
  CHECK_THROWS_AS(decode_summary(impossible, "s"), DataError);
  impossible[16] = 1;
  impossible[17] = 3;  // why the ladder ends
  CHECK_THROWS_AS(decode_summary(impossible, "s"), DataError);
}

TEST_CASE("each vertex of a result has the appearance that it had") {
  Mesh mesh = test::grid(300, 250);
  mesh.appearances = test::appearances(mesh.positions.size());
  std::string file;
  ResultWriter writer({PositionType::float32, true, 70'000},
                      [&file](std::string_view bytes) { file += bytes; });
  writer.add_rung(0, mesh, 0);
  writer.finish(VertexView(mesh).part(0, 70'000), {});
  const ResultMesh back = decode_result(file, 0, "r");
  CHECK(back.mesh.positions == mesh.positions);
  CHECK(back.mesh.appearances == mesh.appearances);
}
