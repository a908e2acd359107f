// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

constexpr std::string_view k_facet =
    "  facet normal 0 0 1\n    outer loop\n      vertex 0 0 0\n      vertex 1 0 0\n"
    "      vertex 0 1 0\n    endloop\n  endfacet\n";

std::string solid(std::string_view facets) {
  return "solid some name\n" + std::string(facets) + "endsolid some name\n";
}

const std::vector<Vec3> k_points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

}  // namespace

TEST_CASE("an ascii STL is a soup") {
  const ReadFile read = read_bytes(solid(std::string(k_facet) + std::string(k_facet)));
  CHECK(read.info.format == "STL ascii");
  CHECK(read.info.faces == 2);
  CHECK(read.info.vertices == 6);
  CHECK(read.info.skipped == std::vector<std::string>{"facet.normal"});
  CHECK(read.info.positions == PositionType::float32);
  CHECK(read.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}});
  CHECK(std::vector<Vec3>(read.mesh.positions.begin() + 3, read.mesh.positions.end()) == k_points);
}

TEST_CASE("ascii STL in any case of letters, on any lines, with any line ends") {
  for (const auto text :
       {"SOLID\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVertex 0 1 "
        "0\nENDLOOP\nENDFACET\nENDSOLID\n",
        "solid a\nfacet outer loop vertex 0 0 0 vertex 1 0 0 vertex 0 1 0 endloop endfacet "
        "endsolid",
        "\r\nsolid endfacet\r\nfacet normal nan -nan(ind) 1\r\nouter loop\r\nvertex 0 0 0\r\n\r\n"
        "vertex 1 0 0\r\nvertex 0 1e0 0\r\nendloop\r\nendfacet\r\nendsolid\r\n",
        "solid a\nendsolid a\nsolid b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 "
        "0\nvertex 0 1 0\nendloop\nendfacet\nendsolid b\nsolid c\nendsolid\n",
        "solid a\rfacet normal 0 0 1\router loop\rvertex 0 0 0\rvertex 1 0 0\rvertex 0 1 "
        "0\rendloop\rendfacet\rendsolid\r"}) {
    CAPTURE(text);
    const ReadFile read = read_bytes(text);
    CHECK(read.mesh.positions == k_points);
    CHECK(read.mesh.triangles == std::vector<Triangle>{{0, 1, 2}});
  }
  CHECK(read_bytes("solid nothing\nendsolid nothing\n").mesh.positions.empty());
}

TEST_CASE("ascii STL with more digits than a float is read as doubles") {
  const ReadFile read =
      read_bytes(solid(replaced(std::string(k_facet), "1 0 0", "5412345.678 0 0")));
  CHECK(read.info.positions == PositionType::float64);
  CHECK(read.mesh.positions[1] == Vec3{5412345.678, 0, 0});
}

TEST_CASE("a malformed ascii STL is refused with its line") {
  const auto told = [](std::string_view from, std::string_view to) {
    return refusal(solid(replaced(std::string(k_facet), from, to)));
  };
  CHECK(told("vertex 0 1 0", "vertex 0 1") == "m.ply: line 6: the line ends before its last value");
  CHECK(told("vertex 0 1 0", "vertex 0 1 z") == "m.ply: line 6: the coordinate 'z' is no number");
  CHECK(told("      vertex 0 1 0\n", "") ==
        "m.ply: line 6: there is 'endloop' where 'vertex' should be");
  CHECK(told("    endloop", "      vertex 2 2 2\n    endloop") ==
        "m.ply: line 7: there is 'vertex' where 'endloop' should be");
  CHECK(told("outer loop", "outer") == "m.ply: line 4: there is 'vertex' where 'loop' should be");
  CHECK(told("  endfacet\n", "") ==
        "m.ply: line 8: there is 'endsolid' where 'endfacet' should be");
  CHECK(refusal("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n") ==
        "m.ply: line 5: the file ends inside a facet");
  CHECK(refusal(solid(std::string(k_facet) + "colour 1 1 1\n")) ==
        "m.ply: line 9: there is 'colour' where 'facet' should be");
}

TEST_CASE("threads do not change what is read of an ascii STL") {
  std::string facets;
  for (int i = 0; i < 5000; ++i) {
    facets +=
        replaced(std::string(k_facet), "vertex 1 0 0", "vertex " + std::to_string(i) + " 0 0");
  }
  const TempFolder folder;
  write_file(folder / "m", solid(facets));
  const Mesh one = read_mesh(*open_mesh(folder / "m", {.threads = 1}));
  REQUIRE(one.triangles.size() == 5000);
  CHECK(one.positions[3 * 4321 + 1] == Vec3{4321, 0, 0});
  const Mesh many = read_mesh(*open_mesh(folder / "m", {.threads = 5}));
  CHECK(many.positions == one.positions);
  CHECK(many.triangles == one.triangles);
  CHECK(refusal(solid(facets + replaced(std::string(k_facet), "0 1 0", "0 1 y"))) ==
        "m.ply: line 35006: the coordinate 'y' is no number");
}
