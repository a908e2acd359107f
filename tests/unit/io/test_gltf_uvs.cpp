// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>

#include "gltf_test_files.hpp"
#include "picture_files.hpp"
#include "uv_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

const std::string k_places = raw<float>({0, 0, 1, 0, 0.25F, 0.75F, 3, -2});
const std::vector<Uv> k_kept{{0, 1}, {1, 1}, {0.25F, 0.25F}, {3, 3}};

/// The square, with texture coordinates and a material.
struct TexturedSquare {
  std::string places = k_places;
  std::string place_type = R"("componentType":5126)";
  std::string attributes = R"("TEXCOORD_0":2)";
  std::string materials =
      R"({"name":"skin","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";
  std::string textures = R"({"source":0,"sampler":0},{"source":1,"sampler":0})";
  std::string sampler = "{}";
  std::string images = R"({"uri":"maps/one.png"},{"uri":"two.png"})";
  std::string more_primitives;
  std::string nodes = R"({"mesh":0})";
  std::string tail;  // the end of the binary chunk

  std::string glb() const {
    const std::string binary = k_square_binary + places + tail;
    const auto number = [](std::size_t value) { return std::to_string(value); };
    return glb_file(
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes +
            R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0,)" + attributes +
            R"(},"indices":1,"material":0})" + more_primitives + "]}],\"materials\":[" + materials +
            "],\"textures\":[" + textures + "],\"samplers\":[" + sampler + "],\"images\":[" +
            images +
            R"(],"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
            R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"},)"
            R"({"bufferView":2,)" +
            place_type +
            R"(,"count":4,"type":"VEC2"}],)"
            R"("bufferViews":[{"buffer":0,"byteLength":48},)"
            R"({"buffer":0,"byteOffset":48,"byteLength":12},)"
            R"({"buffer":0,"byteOffset":60,"byteLength":)" +
            number(places.size()) + R"(},{"buffer":0,"byteOffset":)" + number(60 + places.size()) +
            R"(,"byteLength":)" + number(tail.size()) + R"(}],"buffers":[{"byteLength":)" +
            number(binary.size()) + "}]}",
        binary);
  }
};

/// The square with its pictures beside it.
struct SquareModel : UvModel {
  explicit SquareModel(const TexturedSquare& square) : UvModel("m.glb", square.glb()) {
    with("maps/one.png", png_of(gradient(4))).with("two.png", png_of(gradient(5)));
  }
};

void check_uvs(const UvTriangles& read, const std::vector<Uv>& wanted) {
  REQUIRE(read.uvs.size() == read.corners.size());
  for (std::size_t i = 0; i < read.corners.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) CHECK(read.uvs[i][k] == wanted[read.corners[i][k]]);
  }
}

}  // namespace

TEST_CASE("triangles of a GLB have texture coordinates from the lower side") {
  const SquareModel model(TexturedSquare{});
  const auto source = model.open();
  const MeshFileInfo& info = source->info();
  CHECK(info.uvs);
  CHECK(info.pictures.names == Names{"one.png"});
  CHECK(info.pictures.load(0) == png_of(gradient(4)));
  REQUIRE(info.labels);
  CHECK(info.labels->materials ==
        std::vector<Material>{{.name = "skin", .maps = {{MapUse::colour, 0}}}});
  CHECK(info.skipped == Names{"images (1)", "textures (1)"});
  CHECK(info.textures.empty());
  const UvTriangles read = triangles_of(*source);
  CHECK(read.corners == std::vector<WideTriangle>{{0, 1, 2}, {2, 1, 3}});
  CHECK(read.labels == std::vector<Label>{0, 0});
  check_uvs(read, k_kept);
}

TEST_CASE("a GLB's texture coordinates may be whole numbers, and what is not finite is 0") {
  TexturedSquare square{.places = raw<std::uint16_t>({0, 0, 65535, 0, 13107, 52428, 65535, 65535}),
                        .place_type = R"("componentType":5123,"normalized":true)"};
  check_uvs(triangles_of(*SquareModel(square).open()), {{0, 1}, {1, 1}, {0.2F, 0.2F}, {1, 0}});
  square.places = raw<float>({NAN, 0, 1, INFINITY, 1e30F, 1, 0, 0});
  square.place_type = R"("componentType":5126)";
  check_uvs(triangles_of(*SquareModel(square).open()), {{0, 0}, {0, 0}, {1e30F, 0}, {0, 1}});
}

TEST_CASE("a GLB's texture transform and its ways to wrap are kept") {
  const TexturedSquare square{
      .materials = R"({"name":"skin","pbrMetallicRoughness":{"baseColorTexture":{"index":0,)"
                   R"("extensions":{"KHR_texture_transform":{"offset":[0.5,0.25],)"
                   R"("scale":[2,4]}}}}})",
      .sampler = R"({"wrapS":33071,"wrapT":33648})"};
  const SquareModel model(square);
  const auto source = model.open();
  check_uvs(triangles_of(*source), {{0.5F, 0.75F}, {2.5F, 0.75F}, {1, -2.25F}, {6.5F, 8.75F}});
  const Material& skin = source->info().labels->materials[0];
  CHECK(skin.wrap_u == TextureWrap::clamp);
  CHECK(skin.wrap_v == TextureWrap::mirror);
}

TEST_CASE("a GLB's maps are kept with their uses if they lie as its colours do") {
  TexturedSquare square{
      .materials = R"({"name":"skin","pbrMetallicRoughness":{"baseColorTexture":{"index":0},)"
                   R"("metallicRoughnessTexture":{"index":1}},"normalTexture":{"index":1},)"
                   R"("occlusionTexture":{"index":1,"texCoord":1},"emissiveFactor":[1,1,1],)"
                   R"("emissiveTexture":{"index":0}})"};
  const auto source = SquareModel(square).open();
  CHECK(source->info().pictures.names == Names{"one.png", "two.png"});
  CHECK(source->info().labels->materials[0].maps ==
        std::vector<MaterialMap>{{MapUse::colour, 0},
                                 {MapUse::metal_and_roughness, 1},
                                 {MapUse::normal, 1},
                                 {MapUse::emission, 0}});
  CHECK(source->info().skipped == Names{"occlusionTexture (1)"});
  // Without a factor there is no emission; the first set in use is then that of the normals.
  square.materials = R"({"name":"skin","normalTexture":{"index":1,"texCoord":1},)"
                     R"("emissiveTexture":{"index":0}})";
  square.attributes = R"("TEXCOORD_1":2)";
  const auto normals = SquareModel(square).open();
  CHECK(normals->info().labels->materials[0].maps == std::vector<MaterialMap>{{MapUse::normal, 0}});
  CHECK(normals->info().pictures.names == Names{"two.png"});
  check_uvs(triangles_of(*normals), k_kept);
}

TEST_CASE("an embedded image is named by what it is, and outlives the source") {
  const std::string image = jpeg_of(gradient(16));
  TexturedSquare square{.images = R"({"bufferView":3,"name":"my/skin.png"},{"bufferView":3})",
                        .tail = image};
  square.materials = R"({"name":"skin","pbrMetallicRoughness":{"baseColorTexture":{"index":0}},)"
                     R"("normalTexture":{"index":1}})";
  PictureFiles pictures;
  {
    const SquareModel model(square);
    pictures = model.open()->info().pictures;
  }
  CHECK(pictures.names == Names{"skin.jpg", "image_1.jpg"});
  CHECK(pictures.load(0) == image);
  CHECK(pictures.load(1) == image);
}

TEST_CASE("a primitive of a GLB without texture coordinates has (0, 0), none at all are none") {
  TexturedSquare square{.more_primitives = R"(,{"attributes":{"POSITION":0},"indices":1})"};
  const UvTriangles read = triangles_of(*SquareModel(square).open());
  REQUIRE(read.uvs.size() == 4);
  CHECK(read.labels == std::vector<Label>{0, 0, 1, 1});
  CHECK(read.uvs[1] == CornerUvs{k_kept[2], k_kept[1], k_kept[3]});
  CHECK(read.uvs[2] == CornerUvs{});
  square.attributes = R"("_OTHER":2)";
  const SquareModel model(square);
  const auto without = model.open();
  const auto dropped = open_mesh(model.path(), {});
  CHECK_FALSE(without->info().uvs);
  CHECK(without->info().pictures.names.empty());
  CHECK(without->info().labels == dropped->info().labels);
  CHECK(without->info().skipped == dropped->info().skipped);
  CHECK(triangles_of(*without).uvs.empty());
}

TEST_CASE("strips, fans and mirrored meshes of a GLB keep each corner's texture coordinates") {
  TexturedSquare square{.nodes = R"({"mesh":0,"scale":[-1,1,1]})"};
  const UvTriangles mirrored = triangles_of(*SquareModel(square).open());
  CHECK(mirrored.corners == std::vector<WideTriangle>{{0, 2, 1}, {2, 3, 1}});
  check_uvs(mirrored, k_kept);
  for (const char* mode : {"5", "6"}) {
    TexturedSquare other;
    other.attributes += R"(},"mode":)" + std::string(mode) + R"(,"extras":{"a":1)";
    check_uvs(triangles_of(*SquareModel(other).open()), k_kept);
  }
}

TEST_CASE("an image of a GLB that is missing is left out, its material stays") {
  const TexturedSquare square{.images = R"({"uri":"gone.png"},{"uri":"../up.png"})"};
  const auto source = SquareModel(square).open();
  CHECK(source->info().uvs);
  CHECK(source->info().pictures.names.empty());
  CHECK(source->info().labels->materials == std::vector<Material>{{.name = "skin"}});
}

TEST_CASE("texture coordinates that do not fit their vertices are refused") {
  TexturedSquare square;
  square.attributes = R"("TEXCOORD_0":1)";
  const SquareModel model(square);
  CHECK(error_of([&] { model.open(); }).find("not of VEC2") != std::string::npos);
}
