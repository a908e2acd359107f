// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>
#include <support/meshes.hpp>

#include <meshfarm/io/mesh_format.hpp>

#include "gltf_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

using MaterialLabels = std::vector<Label>;

/// A square whose two triangles are separate primitives, with `first` and `second` added to them.
std::string two_primitives(const std::string& first, const std::string& second,
                           const std::string& materials) {
  const std::string primitive = R"({"attributes":{"POSITION":0},"indices":)";
  const std::string index =
      R"({"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"},)"
      R"({"bufferView":1,"byteOffset":6,"componentType":5123,"count":3,"type":"SCALAR"})";
  std::string json = with(k_square_json, primitive + "1}",
                          primitive + "1" + first + "}," + primitive + "2" + second + "}");
  json = with(json, R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"})", index);
  return with(json, "\"scene\":0",
              materials.empty() ? "\"scene\":0" : "\"scene\":0,\"materials\":" + materials);
}

const std::string k_materials =
    R"([{"name":"stone"},{"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,2,0.5]}},)"
    R"({"name":"glass","alphaMode":"BLEND",)"
    R"("pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.5]}},)"
    R"({"pbrMetallicRoughness":{"metallicFactor":0}}])";

nlohmann::json json_of(const std::string& glb) {
  std::uint32_t size = 0;
  std::memcpy(&size, glb.data() + 12, sizeof size);
  return nlohmann::json::parse(glb.substr(20, size));
}

}  // namespace

TEST_CASE("materials that primitives have are labels, in the document's order") {
  const ReadFile read = read_glb(two_primitives(",\"material\":2", ",\"material\":1", k_materials));
  CHECK(read.mesh.columns.labels == MaterialLabels{1, 0});
  REQUIRE(read.info.labels);
  CHECK(
      *read.info.labels ==
      LabelMeaning{"material", {{"material 1", {0.5F, 0.25F, 1, 1}}, {"glass", {1, 1, 1, 0.5F}}}});
  CHECK(read.info.skipped == std::vector<std::string>{"materials (1)"});
}

TEST_CASE("primitives without a material have one of their own") {
  const ReadFile read = read_glb(two_primitives("", ",\"material\":0", k_materials));
  CHECK(read.mesh.columns.labels == MaterialLabels{1, 0});
  CHECK(read.info.labels->materials == std::vector<Material>{{"stone"}, {"default"}});
  const ReadFile plain =
      read_glb(two_primitives(",\"material\":3", ",\"material\":0", k_materials));
  CHECK(plain.mesh.columns.labels == MaterialLabels{1, 0});
  CHECK_FALSE(read_glb(two_primitives("", "", k_materials)).info.labels);
  CHECK_FALSE(read_glb(two_primitives(",\"material\":3", "", k_materials)).info.labels);
  CHECK(read_glb(two_primitives("", "", "")).mesh.columns.labels.empty());
}

TEST_CASE("each node that shows a mesh shows its materials") {
  std::string json = two_primitives(",\"material\":2", ",\"material\":0", k_materials);
  json = with(json, R"("nodes":[0])", R"("nodes":[0,1])");
  json = with(json, R"([{"mesh":0}])", R"([{"mesh":0},{"mesh":0,"scale":[-1,1,1]}])");
  const ReadFile read = read_glb(json);
  CHECK(read.mesh.columns.labels == MaterialLabels{1, 0, 1, 0});
  CHECK(read.mesh.triangles.size() == 4);
}

TEST_CASE("malformed materials are refused") {
  const auto refused = [](const std::string& primitive, const std::string& materials) {
    return refusal(glb_file(two_primitives(primitive, "", materials), k_square_binary));
  };
  CHECK(refused(",\"material\":4", k_materials) == "m.ply: materials has no item 4: there are 4");
  CHECK(refused(",\"material\":0", "") == "m.ply: the document has no materials");
  CHECK(refused(",\"material\":\"stone\"", k_materials) ==
        "m.ply: meshes[0].primitives[0].material is not a number");
  CHECK(refused(",\"material\":0", R"([{"name":5}])") ==
        "m.ply: materials[0].name is not a string");
  CHECK(refused(",\"material\":0", R"([{"pbrMetallicRoughness":{"baseColorFactor":[1,1,1]}}])") ==
        "m.ply: materials[0].pbrMetallicRoughness.baseColorFactor is too short");
}

TEST_CASE("labels that are not wanted are materials that are skipped") {
  const TempFolder folder;
  write_file(folder / "m",
             glb_file(two_primitives(",\"material\":0", "", k_materials), k_square_binary));
  const auto source = open_mesh(folder / "m", {.labels = false});
  CHECK_FALSE(source->info().labels);
  CHECK(source->info().skipped == std::vector<std::string>{"materials (3)"});
  CHECK(read_mesh(*source).columns.labels.empty());
}

TEST_CASE("a GLB has a primitive of each material that triangles have") {
  const TempFolder folder;
  Mesh mesh = tetrahedron();
  mesh.columns.labels = {2, 0, 2, 0};
  const LabelMeaning meaning{"material", {{"stone"}, {"never"}, {"glass", {0.5F, 0.25F, 1, 0.5F}}}};
  for (const char* name : {"m.glb", "m.gltf"}) {
    write_mesh(folder / name, mesh, PositionType::float32, {}, {}, meaning);
    const ReadFile read = read_path(folder / name);
    CHECK(read.mesh.positions == mesh.positions);
    CHECK(read.mesh.triangles == std::vector<Triangle>{{0, 1, 3}, {1, 2, 3}, {0, 2, 1}, {0, 3, 2}});
    CHECK(read.mesh.columns.labels == MaterialLabels{0, 0, 1, 1});
    CHECK(read.info.labels ==
          LabelMeaning{"material", {{"stone"}, {"glass", {0.5F, 0.25F, 1, 0.5F}}}});
    CHECK(read.info.skipped.empty());
  }
  const nlohmann::json json = json_of(read_file(folder / "m.glb"));
  CHECK(json["materials"] ==
        nlohmann::json::parse(R"([{"name":"stone","pbrMetallicRoughness":{"metallicFactor":0}},)"
                              R"({"name":"glass","pbrMetallicRoughness":{"baseColorFactor":)"
                              R"([0.5,0.25,1.0,0.5],"metallicFactor":0},"alphaMode":"BLEND"}])"));
  CHECK(json["meshes"][0]["primitives"] ==
        nlohmann::json::parse(R"([{"attributes":{"POSITION":0},"indices":1,"material":0},)"
                              R"({"attributes":{"POSITION":0},"indices":2,"material":1}])"));
  CHECK(json["accessors"][2]["byteOffset"] == 12);
}

TEST_CASE("a GLB of labels that are numbers has materials named by them") {
  const TempFolder folder;
  Mesh mesh = torus(60, 90);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    mesh.columns.labels.push_back(static_cast<Label>(5 + 10 * (i % 300)));
  }
  write_mesh(folder / "m.glb", mesh, PositionType::float64, {}, {}, LabelMeaning{"region", {}});
  const ReadFile read = read_path(folder / "m.glb");
  REQUIRE(read.info.labels);
  REQUIRE(read.info.labels->materials.size() == 300);
  CHECK(read.info.labels->materials[7].name == "region 75");
  REQUIRE(read.mesh.triangles.size() == mesh.triangles.size());
  std::size_t at = 0;
  for (Label label = 0; label < 300; ++label) {
    for (std::size_t i = label; i < mesh.triangles.size(); i += 300) {
      CHECK(read.mesh.columns.labels[at] == label);
      CHECK(read.mesh.triangles[at++] == mesh.triangles[i]);
    }
  }
}

TEST_CASE("a GLB without triangles has no materials of theirs") {
  const TempFolder folder;
  for (const std::size_t vertices : {0U, 2U}) {
    const auto sink = create_mesh(
        folder / "m.glb",
        {.vertices = vertices, .comment = {}, .labels = LabelMeaning{"material", {{"a"}}}});
    sink->vertices(std::vector<Vec3>(vertices));
    sink->commit();
    CHECK_FALSE(read_path(folder / "m.glb").info.labels);
  }
}
