// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "divide/cell_map.hpp"
#include "divide/share_out.hpp"
#include "support/memory_source.hpp"
#include "support/meshes.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

std::unique_ptr<ShareMap> map_of(bool cells, const Box& box, std::uint32_t wanted) {
  if (cells) return std::make_unique<CellMap>(box, CellMapOptions{.parts = wanted, .threads = 1});
  return std::make_unique<SlabMap>(box, SweepOrder{}, wanted, AtOnePoint::merge);
}

struct SharedOut {
  std::uint32_t count = 0;
  SharedMesh mesh;
};

SharedOut share_out_by(bool cells, const Mesh& mesh, std::uint32_t wanted,
                       const std::filesystem::path& folder, const ScanProgress& tell = {}) {
  test::MemorySource source(mesh);
  const VertexSurvey found = survey_vertices(source, nullptr, tell);
  std::unique_ptr<ShareMap> map = map_of(cells, found.box, wanted);
  const std::uint32_t count = settle(*map, source, found.vertices, tell);
  return {count, share_out(source, std::move(map),
                           {.folder = folder,
                            .shares = count,
                            .vertices = found.vertices,
                            .positions = found.positions},
                           tell)};
}

}  // namespace

TEST_CASE("a survey tells the box, the vertices and those without a position") {
  Mesh mesh = test::grid(4, 3);
  const std::size_t vertices = mesh.positions.size();
  mesh.positions.push_back(k_no_position);
  test::MemorySource source(mesh);
  const VertexSurvey found = survey_vertices(source, nullptr, {});
  Box box;
  for (std::size_t i = 0; i < vertices; ++i) box.add(mesh.positions[i]);
  CHECK(found.vertices == vertices + 1);
  CHECK(found.not_finite == 1);
  CHECK(found.box.lo == box.lo);
  CHECK(found.box.hi == box.hi);
  CHECK(found.positions == PositionType::float64);
}

TEST_CASE("all vertices are surveyed again where positions turn out to be wider") {
  struct Text : test::MemorySource {
    using MemorySource::MemorySource;
    void scan_vertices(const std::function<void(std::span<const Vec3>)>& take) override {
      MemorySource::scan_vertices(take);
      info_.positions = PositionType::float64;
    }
  };
  Text source(test::tetrahedron(), PositionType::float32);
  OrderProbe probe;
  const VertexSurvey found = survey_vertices(source, &probe, {});
  CHECK(found.positions == PositionType::float64);
  CHECK(found.vertices == 4);
}

TEST_CASE("by cells and by slabs each vertex and triangle goes to one share or between them") {
  const Mesh mesh = test::torus(80, 30);
  for (const bool cells : {true, false}) {
    CAPTURE(cells);
    const test::TempFolder folder;
    const SharedOut made = share_out_by(cells, mesh, 5, folder.path());
    REQUIRE(made.count == 5);
    CHECK(made.mesh.triangles == mesh.triangles.size());
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    for (std::uint32_t i = 0; i < made.count; ++i) {
      const MeshShare share = made.mesh.shares->read(i, Weld::off);
      CHECK(share.positions.size() > mesh.positions.size() / 7);
      vertices += share.positions.size();
      triangles += share.triangles.size();
      for (const SeamTriangle& t : made.mesh.shares->seam(i)) {
        triangles += std::min({t[0].share, t[1].share, t[2].share}) == i ? 1 : 0;
      }
    }
    CHECK(vertices == mesh.positions.size());
    CHECK(triangles == mesh.triangles.size());
  }
}

TEST_CASE("by cells and by slabs a crowd at one point becomes one vertex") {
  const std::uint32_t crowd = 40'000;
  const Mesh mesh = test::with_crowd(test::torus(80, 30), crowd);
  for (const bool cells : {true, false}) {
    CAPTURE(cells);
    const test::TempFolder folder;
    const SharedOut made = share_out_by(cells, mesh, 8, folder.path());
    CHECK(made.mesh.shares->merged() > crowd / 2);
  }
}

TEST_CASE("progress names what is scanned and comes to its end") {
  for (const bool cells : {true, false}) {
    const test::TempFolder folder;
    std::vector<std::string> phases;
    std::uint64_t left = 1;
    share_out_by(cells, test::torus(20, 10), 2, folder.path(),
                 [&](std::string_view phase, std::uint64_t done, std::uint64_t all) {
                   if (phases.empty() || phases.back() != phase) phases.emplace_back(phase);
                   left = all - done;
                 });
    CHECK(left == 0);
    CHECK(phases == std::vector<std::string>{"bounding box", cells ? "cells" : "slabs", "vertices",
                                             "triangles"});
  }
}
