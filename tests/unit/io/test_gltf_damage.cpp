// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// glTF documents with impossible content: one line that names the place.
#include <doctest/doctest.h>

#include "gltf_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

/// The refusal of a square in whose JSON `from` is replaced by `to`.
std::string refused_glb(std::string_view from, std::string_view to) {
  return refusal(glb_file(with(k_square_json, from, to), k_square_binary));
}

constexpr std::string_view k_positions = R"("componentType":5126,"count":4,"type":"VEC3")";
constexpr std::string_view k_indices = R"("componentType":5123,"count":6,"type":"SCALAR")";
constexpr std::string_view k_view = R"({"buffer":0,"byteLength":48})";

}  // namespace

TEST_CASE("JSON that is malformed is refused with the byte") {
  CHECK(refused_glb("{\"asset\"", "{asset\"") == "m.ply: its JSON is malformed at byte 21");
  CHECK(refused_glb("\"scene\":0", "\"scene\":1e999") ==
        "m.ply: its JSON has a number that is out of range");
  const std::string deep(100, '[');
  CHECK(refused_glb("\"scene\":0", "\"extras\":" + deep) ==
        "m.ply: its JSON has more than 64 levels of arrays and objects");
  CHECK(refusal(glb_file("", "")) == "m.ply: its JSON is malformed at byte 20");
  CHECK(refusal(glb_file("[]", "")) == "m.ply: the document is not an object");
}

TEST_CASE("what is no glTF 2.0, or needs an unknown extension, is refused by name") {
  CHECK(refusal(glb_file("{}", "")) == "m.ply: the document has no asset");
  CHECK(refused_glb("\"2.0\"", "\"1.0\"") == "m.ply: asset.version '1.0' is not 2.0");
  CHECK(refused_glb("\"2.0\"", "2") == "m.ply: asset.version is not a string");
  CHECK(refused_glb("\"scene\":0",
                    R"("extensionsRequired":["KHR_materials_unlit","EXT_structural_metadata"])") ==
        "m.ply: extensionsRequired[1] 'EXT_structural_metadata' is needed to read the file, and "
        "not known");
}

TEST_CASE("a file that needs a later version than 2.0 is refused with both versions") {
  const auto needs = [](std::string_view version) {
    return refused_glb("\"version\":\"2.0\"",
                       R"("version":"2.7","minVersion":")" + std::string(version) + "\"");
  };
  CHECK(needs("2.0").empty());
  CHECK(needs("1.0").empty());
  for (const std::string version : {"2.1", "2.10", "3.0"}) {
    CHECK(needs(version) == "m.ply: asset.minVersion '" + version +
                                "' is needed to read the file, and meshfarm reads 2.0");
  }
  for (const std::string version : {"", "2", "2.", "2.0a", "2.0.1", "-2.0", "99999999999.0"}) {
    CHECK(needs(version) == "m.ply: asset.minVersion '" + version + "' is not a version");
  }
}

TEST_CASE("what is absent, of another type or out of range is refused with its place") {
  CHECK(refused_glb("\"mesh\":0", "\"mesh\":-1") ==
        "m.ply: nodes[0].mesh is not a whole number from 0 to 2^53");
  CHECK(refused_glb("\"mesh\":0", "\"mesh\":0.5") ==
        "m.ply: nodes[0].mesh is not a whole number from 0 to 2^53");
  CHECK(refused_glb("\"mesh\":0", "\"mesh\":\"0\"") == "m.ply: nodes[0].mesh is not a number");
  CHECK(refused_glb("\"scene\":0", "\"scene\":1") == "m.ply: scenes has no item 1: there are 1");
  CHECK(refused_glb("\"nodes\":[0]", "\"nodes\":[9]") ==
        "m.ply: scenes[0].nodes[0] is node 9 of 1");
  CHECK(refused_glb("\"POSITION\":0", "\"POSITION\":5") ==
        "m.ply: accessors has no item 5: there are 2");
  CHECK(refused_glb("\"indices\":1", "\"indices\":1,\"mode\":7") ==
        "m.ply: meshes[0].primitives[0].mode is not from 0 to 6");
  CHECK(refused_glb("\"primitives\":[", "\"primitives\":3,\"x\":[") ==
        "m.ply: meshes[0].primitives is not an array");
  CHECK(refused_glb("\"buffers\":[{\"byteLength\":60}]", "\"buffers\":[{}]") ==
        "m.ply: buffers[0] has no byteLength");
}

TEST_CASE("accessors that do not fit are refused") {
  CHECK(refused_glb(k_positions, R"("componentType":5126,"count":5,"type":"VEC3")") ==
        "m.ply: accessors[0] has 5 elements, but 4 fit into its buffer view");
  CHECK(
      refused_glb(k_positions, R"("componentType":5126,"count":4,"byteOffset":8,"type":"VEC3")") ==
      "m.ply: accessors[0] has 4 elements, but 3 fit into its buffer view");
  CHECK(refused_glb(k_positions,
                    R"("componentType":5126,"count":4,"byteOffset":900,"type":"VEC3")") ==
        "m.ply: accessors[0] has 4 elements, but 0 fit into its buffer view");
  CHECK(
      refused_glb(k_positions, R"("componentType":5126,"count":9007199254740991,"type":"VEC3")") ==
      "m.ply: accessors[0] has 9007199254740991 elements, but 4 fit into its buffer view");
  CHECK(refused_glb(k_view, R"({"buffer":0,"byteLength":48,"byteOffset":9007199254740991})") ==
        "m.ply: bufferViews[0] ends at byte 9007199254741039 of a buffer of 60");
  CHECK(refused_glb(k_view, R"({"buffer":0,"byteLength":48,"byteStride":8})") ==
        "m.ply: bufferViews[0].byteStride is not from 12, the size of what it holds, to 252");
  CHECK(refused_glb(k_view, R"({"buffer":0,"byteLength":48,"byteStride":4294967296})") ==
        "m.ply: bufferViews[0].byteStride is not from 12, the size of what it holds, to 252");
  CHECK(refused_glb(k_positions, R"("componentType":5130,"count":4,"type":"VEC3")") ==
        "m.ply: accessors[0].componentType is not 5120 to 5123, 5125 or 5126");
  CHECK(refused_glb(k_positions, R"("componentType":5126,"count":4,"type":"MAT3")") ==
        "m.ply: accessors[0].type is not SCALAR, VEC2, VEC3 or VEC4");
  CHECK(refused_glb(k_positions, R"("componentType":5126,"count":4,"type":"VEC3","sparse":{})") ==
        "m.ply: accessors[0] is sparse, which meshfarm does not read");
}

TEST_CASE("accessors of a wrong kind are refused where they are used") {
  const std::string primitive = "m.ply: meshes[0].primitives[0]";
  CHECK(refused_glb(k_positions, R"("componentType":5126,"count":4,"type":"VEC2")") ==
        primitive +
            ".attributes.POSITION is not of three floats, or whole numbers of 8 or 16 bits");
  CHECK(refused_glb(k_indices, R"("componentType":5122,"count":6,"type":"SCALAR")") ==
        primitive + ".indices is not of single whole numbers without a sign");
  CHECK(refused_glb(k_indices, R"("componentType":5123,"count":5,"type":"SCALAR")") ==
        primitive + " has 5 corners of triangles, which is no multiple of three");
  CHECK(refused_glb("\"POSITION\":0", "\"POSITION\":0,\"NORMAL\":1") ==
        primitive + ".attributes.NORMAL has 6 elements, POSITION 4");
  CHECK(refused_glb("\"POSITION\":0", "\"POSITION\":0,\"COLOR_0\":1") ==
        primitive + ".attributes.COLOR_0 has 6 elements, POSITION 4");
}

TEST_CASE("an index that no vertex has is refused") {
  std::string bytes = k_square_binary;
  bytes[48 + 2 * 4] = 9;
  CHECK(refusal(glb_file(k_square_json, bytes)) ==
        "m.ply: meshes[0].primitives[0]: index 4: vertex 9 is out of range: there are 4 vertices");
}

TEST_CASE("a square with any byte changed ends in triangles or in a line") {
  const std::string whole = square_glb();
  const TempFolder folder;
  const Quiet quiet;
  for (std::size_t i = 12; i < whole.size(); ++i) {
    for (const char c : {'\0', '"', '9', '\xff'}) {
      std::string bytes = whole;
      bytes[i] = c;
      refusal(bytes, folder);
    }
  }
}
