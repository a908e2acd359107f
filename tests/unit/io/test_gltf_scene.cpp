// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>

#include <doctest/doctest.h>

#include "gltf_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

/// A square whose scene has these nodes; node 0 is the root.
ReadFile read_nodes(std::string_view nodes) {
  return read_glb(
      with(k_square_json, "\"nodes\":[{\"mesh\":0}]", "\"nodes\":[" + std::string(nodes) + "]"));
}

/// The position of the square's second corner, which is 1 0 0.
Vec3 second(std::string_view nodes) {
  return read_nodes(nodes).mesh.positions.at(1);
}

}  // namespace

TEST_CASE("a node's transform moves its mesh, as doubles") {
  CHECK(second(R"({"mesh":0,"translation":[412345.678,1,-2]})") == Vec3{412346.678, 1, -2});
  CHECK(second(R"({"mesh":0,"scale":[3,1,1]})") == Vec3{3, 0, 0});
  CHECK(second(R"({"mesh":0,"matrix":[0,1,0,0, -1,0,0,0, 0,0,1,0, 5,6,7,1]})") == Vec3{5, 7, 7});
  // A quarter turn about z of a mesh that is stretched before it and moved after it.
  const Vec3 p = second(R"({"mesh":0,"rotation":[0,0,0.7071067811865476,0.7071067811865476],)"
                        R"("scale":[2,1,1],"translation":[10,0,0]})");
  CHECK(std::abs(p.x - 10) < 1e-12);
  CHECK(std::abs(p.y - 2) < 1e-12);
  CHECK(read_nodes(R"({"mesh":0,"translation":[1,0,0]})").info.positions == PositionType::float64);
  check_square(read_nodes(R"({"mesh":0,"translation":[0,0,0],"scale":[1,1,1]})"));
}

TEST_CASE("a rotation that is not of length 1 turns only") {
  for (const char* rotation :
       {"0,0,0.7,0.7", "0,0,3,3", "0,0,1e300,1e300", "0,0,-1e-200,-1e-200"}) {
    CAPTURE(rotation);
    const Vec3 p = second(R"({"mesh":0,"rotation":[)" + std::string(rotation) + "]}");
    CHECK(length(p - Vec3{0, 1, 0}) < 1e-12);
  }
  check_square(read_nodes(R"({"mesh":0,"rotation":[0,0,0,2]})"));
}

TEST_CASE("a mesh with a skin is not moved by its nodes") {
  const ReadFile read =
      read_nodes(R"({"children":[1],"scale":[10,10,10]},)"
                 R"({"mesh":0,"skin":0,"translation":[1,2,3],"children":[2]},{"mesh":0})");
  REQUIRE(read.mesh.positions.size() == 8);
  CHECK(read.mesh.positions[3] == Vec3{1, 1, 0.5});
  CHECK(read.mesh.positions[7] == Vec3{20, 30, 35});
}

TEST_CASE("what GPU instancing would show in many places comes once, and is named") {
  const std::string extension = R"("extensions":{"EXT_mesh_gpu_instancing":{"attributes":{}}})";
  const ReadFile read = read_nodes(R"({"mesh":0,"children":[1,2],)" + extension +
                                   R"(},{"mesh":0,)" + extension + R"(},{)" + extension + "}");
  CHECK(read.mesh.positions.size() == 8);
  CHECK(read.info.skipped == std::vector<std::string>{"EXT_mesh_gpu_instancing (2)"});
  CHECK(refusal(glb_file(with(k_square_json, "\"scene\":0",
                              R"("extensionsRequired":["EXT_mesh_gpu_instancing"],"scene":0)"),
                         k_square_binary)) ==
        "m.ply: extensionsRequired[0] 'EXT_mesh_gpu_instancing' is needed to read the file, and "
        "not known");
}

TEST_CASE("a node's transform comes before its parent's") {
  CHECK(second(R"({"children":[1],"scale":[10,10,10]},{"mesh":0,"translation":[1,2,3]})") ==
        Vec3{20, 20, 30});
}

TEST_CASE("a mesh that two nodes show comes twice, each in its place") {
  const ReadFile read = read_nodes(R"({"mesh":0,"children":[1]},{"mesh":0,"translation":[0,0,9]})");
  REQUIRE(read.mesh.positions.size() == 8);
  CHECK(read.mesh.positions[3] == Vec3{1, 1, 0.5});
  CHECK(read.mesh.positions[7] == Vec3{1, 1, 9.5});
  CHECK(read.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {4, 5, 6}, {6, 5, 7}});
}

TEST_CASE("in a mirror triangles go the other way round") {
  CHECK(read_nodes(R"({"mesh":0,"scale":[1,1,-1]})").mesh.triangles ==
        std::vector<Triangle>{{0, 2, 1}, {2, 3, 1}});
  CHECK(read_nodes(R"({"mesh":0,"scale":[-1,1,-1]})").mesh.triangles == k_square_triangles);
}

TEST_CASE(
    "only the default scene is read; without scenes all nodes are, without nodes all meshes") {
  std::string json = with(k_square_json, "\"nodes\":[{\"mesh\":0}]",
                          R"("nodes":[{"translation":[1,0,0],"mesh":0},{"mesh":0}])");
  const std::string scenes = "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],";
  CHECK(read_glb(with(json, scenes, R"("scene":1,"scenes":[{"nodes":[0]},{"nodes":[1]}],)"))
            .mesh.positions == k_square_vertices);
  CHECK(read_glb(with(json, scenes, R"("scenes":[{"nodes":[1]}],)")).mesh.positions ==
        k_square_vertices);
  CHECK(read_glb(with(json, scenes, "")).mesh.positions.size() == 8);
  json = with(k_square_json, scenes, "");
  check_square(read_glb(with(json, "\"nodes\":[{\"mesh\":0}],", "")));
  CHECK(read_glb(with(k_square_json, "{\"nodes\":[0]}", "{}")).mesh.positions.empty());
}

TEST_CASE("nodes that are no tree are refused") {
  const auto refused = [](std::string_view nodes) {
    return refusal(glb_file(
        with(k_square_json, "\"nodes\":[{\"mesh\":0}]", "\"nodes\":[" + std::string(nodes) + "]"),
        k_square_binary));
  };
  CHECK(refused(R"({"children":[0]})") ==
        "m.ply: nodes[0] is reached twice: the nodes are not a tree");
  CHECK(refused(R"({"children":[1]},{"children":[0]})") ==
        "m.ply: nodes[0] is reached twice: the nodes are not a tree");
  CHECK(refused(R"({"children":[1,1]},{"mesh":0})") ==
        "m.ply: nodes[1] is reached twice: the nodes are not a tree");
  // No further child is looked at or queued.
  CHECK(refused(R"({"children":[1,1,7]},{"mesh":0})") ==
        "m.ply: nodes[1] is reached twice: the nodes are not a tree");
  CHECK(refused(R"({"children":[7]})") == "m.ply: nodes[0].children[0] is node 7 of 1");
  CHECK(refused(R"({"mesh":3})") == "m.ply: meshes has no item 3: there are 1");
  CHECK(refused(R"({"matrix":[1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,2]})") ==
        "m.ply: nodes[0].matrix is not affine: its last row is not 0 0 0 1");
  CHECK(refused(R"({"rotation":[0,0,0,0]})") ==
        "m.ply: nodes[0].rotation is a quaternion without a length");
  CHECK(refused(R"({"scale":[1,2]})") == "m.ply: nodes[0].scale does not have 3 numbers");
}

TEST_CASE("a chain of nodes may be as long as it likes") {
  std::string nodes;
  constexpr int k_nodes = 5'000;
  for (int i = 1; i < k_nodes; ++i) nodes += "{\"children\":[" + std::to_string(i) + "]},";
  check_square(read_nodes(nodes + "{\"mesh\":0}"));
}
