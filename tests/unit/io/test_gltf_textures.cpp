// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>

#include "gltf_test_files.hpp"
#include "picture_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

constexpr std::uint32_t k_glb_side = 33;  // vertices
constexpr Texel k_glb_red{255, 0, 0};
constexpr Texel k_glb_green{0, 255, 0};

/// A flat grid from 0 to 1, with its positions as texture coordinates. The test sets the rest.
struct TexturedGrid {
  std::string material = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";
  std::string textures = R"({"source":0})";
  std::string samplers = "{}";
  std::string image;  // the content of the buffer's last view
  std::string images = R"({"bufferView":3,"mimeType":"image/png"})";
  std::string primitive = R"("material":0)";
  std::string attributes = R"("TEXCOORD_0":1)";

  std::string glb() const {
    std::string positions;
    std::string places;
    std::string indices;
    for (std::uint32_t y = 0; y < k_glb_side; ++y) {
      for (std::uint32_t x = 0; x < k_glb_side; ++x) {
        const float u = static_cast<float>(x) / (k_glb_side - 1);
        const float v = static_cast<float>(y) / (k_glb_side - 1);
        positions += raw<float>({u, v, 0});
        places += raw<float>({u, v});
        const std::uint32_t at = y * k_glb_side + x;
        if (x + 1 == k_glb_side || y + 1 == k_glb_side) continue;
        indices += raw<std::uint32_t>({at, at + 1, at + k_glb_side});
        indices += raw<std::uint32_t>({at + k_glb_side, at + 1, at + k_glb_side + 1});
      }
    }
    const std::string binary = positions + places + indices + image;
    const auto number = [](std::size_t value) { return std::to_string(value); };
    const auto view = [&](std::size_t start, std::size_t bytes) {
      return R"({"buffer":0,"byteOffset":)" + number(start) + R"(,"byteLength":)" + number(bytes) +
             "}";
    };
    const std::string count = number(std::size_t{k_glb_side} * k_glb_side);
    const std::string json =
        R"({"asset":{"version":"2.0"},"meshes":[{"primitives":[{"attributes":{"POSITION":0,)" +
        attributes + R"(},"indices":2,)" + primitive + R"(}]}],"materials":[)" + material +
        R"(],"textures":[)" + textures + R"(],"samplers":[)" + samplers + R"(],"images":[)" +
        images + R"(],"accessors":[{"bufferView":0,"componentType":5126,"count":)" + count +
        R"(,"type":"VEC3"},{"bufferView":1,"componentType":5126,"count":)" + count +
        R"(,"type":"VEC2"},{"bufferView":2,"componentType":5125,"count":)" +
        number(indices.size() / 4) + R"(,"type":"SCALAR"}],"bufferViews":[)" +
        view(0, positions.size()) + "," + view(positions.size(), places.size()) + "," +
        view(positions.size() + places.size(), indices.size()) + "," +
        view(binary.size() - image.size(), image.size()) + R"(],"buffers":[{"byteLength":)" +
        number(binary.size()) + "}]}";
    return glb_file(json, binary);
  }
};

using GlbColours = std::vector<std::array<float, 3>>;

GlbColours grid_colours(const TexturedGrid& grid) {
  const TempFolder folder;
  write_file(folder / "m.glb", grid.glb());
  return test::colours_of(folder / "m.glb");
}

/// A vertex by its position, from 0 to 1.
const std::array<float, 3>& at(const GlbColours& colours, double u, double v) {
  const auto index = [](double x) {
    return static_cast<std::size_t>(std::lround(x * (k_glb_side - 1)));
  };
  return colours[index(v) * k_glb_side + index(u)];
}

/// Skips the border, where a vertex's share of the surface lies on one side only.
void check_glb_gradient(const GlbColours& colours, double tolerance) {
  for (std::size_t y = 1; y + 1 < k_glb_side; ++y) {
    for (std::size_t x = 1; x + 1 < k_glb_side; ++x) {
      const auto& [red, green, blue] = colours[y * k_glb_side + x];
      CHECK(std::abs(red - 255.0 * static_cast<double>(x) / (k_glb_side - 1)) <= tolerance);
      CHECK(std::abs(green - 255.0 * static_cast<double>(y) / (k_glb_side - 1)) <= tolerance);
      CHECK(std::abs(blue - 100.0) <= tolerance);
    }
  }
}

Picture glb_halves() {
  return picture_of(
      64, 64, [](std::uint32_t x, std::uint32_t) { return x < 32 ? k_glb_red : k_glb_green; });
}

bool is_about(const std::array<float, 3>& colour, const Texel& wanted) {
  return std::abs(colour[0] - wanted[0]) < 0.5F && std::abs(colour[1] - wanted[1]) < 0.5F &&
         std::abs(colour[2] - wanted[2]) < 0.5F;
}

}  // namespace

TEST_CASE("vertices have the colours of a GLB's texture, which starts at the top") {
  TexturedGrid grid{.image = png_of(gradient(256))};
  check_glb_gradient(grid_colours(grid), 2);
  grid.image = jpeg_of(gradient(256));
  grid.images = R"({"bufferView":3,"mimeType":"image/jpeg"})";
  check_glb_gradient(grid_colours(grid), 4);
  // About as many texels as vertices: slightly fewer.
  grid.image = png_of(gradient(32));
  check_glb_gradient(grid_colours(grid), 6);
}

TEST_CASE("a texture in a file beside the GLB, or in its text, is the same") {
  const TempFolder folder;
  TexturedGrid grid{.images = R"({"uri":"maps/my%20atlas.png"})"};
  std::filesystem::create_directory(folder / "maps");
  write_file(folder / "maps/my atlas.png", png_of(gradient(256)));
  write_file(folder / "m.glb", grid.glb());
  check_glb_gradient(test::colours_of(folder / "m.glb"), 2);
  const auto source = open_mesh(folder / "m.glb", {.textures = Textures::name});
  CHECK(source->info().textures == std::vector<std::string>{"'maps/my%20atlas.png' (256 x 256)"});
  CHECK(source->info().channels.empty());
  // One white texel.
  grid.images = R"({"uri":"data:image/png;base64,)"
                R"(iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGP4)"
                R"(//8/AAX+Av4N70a4AAAAAElFTkSuQmCC"})";
  CHECK(is_about(grid_colours(grid)[0], {255, 255, 255}));
}

TEST_CASE("a GLB without textures, or read without them, has no colours of them") {
  const TempFolder folder;
  TexturedGrid grid{.image = png_of(gradient(256))};
  write_file(folder / "m.glb", grid.glb());
  CHECK(open_mesh(folder / "m.glb")->info().channels.empty());
  const auto none = open_mesh(folder / "m.glb", {.channels = false, .textures = Textures::bake});
  CHECK(none->info().channels.empty());
  grid.material = R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0,0,1]}})";
  write_file(folder / "m.glb", grid.glb());
  const auto plain = open_mesh(folder / "m.glb", {.textures = Textures::bake});
  CHECK(plain->info().channels.empty());
  CHECK(plain->info().textures.empty());
}

TEST_CASE("the factor of the base colour, linear, multiplies the texture") {
  TexturedGrid grid{.image = png_of(glb_halves())};
  grid.material = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0},)"
                  R"("baseColorFactor":[0.21586050011389926,1,1,0.5]}})";
  const GlbColours colours = grid_colours(grid);
  CHECK(is_about(at(colours, 0.25, 0.5), {128, 0, 0}));
  CHECK(is_about(at(colours, 0.75, 0.5), k_glb_green));
}

TEST_CASE("textures are wrapped and transformed") {
  TexturedGrid grid{.image = png_of(glb_halves())};
  const auto with_transform = [](const std::string& transform) {
    return R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"extensions":)"
           R"({"KHR_texture_transform":{)" +
           transform + "}}}}}";
  };
  grid.material = with_transform(R"("scale":[2,1])");
  GlbColours colours = grid_colours(grid);
  CHECK(is_about(at(colours, 0.125, 0.5), k_glb_red));
  CHECK(is_about(at(colours, 0.375, 0.5), k_glb_green));
  CHECK(is_about(at(colours, 0.625, 0.5), k_glb_red));
  grid.textures = R"({"source":0,"sampler":0})";
  grid.samplers = R"({"wrapS":33648,"wrapT":33071})";
  colours = grid_colours(grid);
  CHECK(is_about(at(colours, 0.625, 0.5), k_glb_green));
  CHECK(is_about(at(colours, 0.875, 0.5), k_glb_red));
  grid.samplers = R"({"wrapS":33071})";
  colours = grid_colours(grid);
  CHECK(is_about(at(colours, 0.875, 0.5), k_glb_green));
  // A quarter turn: the left side becomes the lower one, v' = 1 - u, and u' = v.
  grid.material = with_transform(R"("offset":[0,1],"rotation":1.5707963267948966)");
  colours = grid_colours(grid);
  CHECK(is_about(at(colours, 0.5, 0.25), k_glb_red));
  CHECK(is_about(at(colours, 0.5, 0.75), k_glb_green));
}

TEST_CASE("a texture names its set of coordinates") {
  TexturedGrid grid{.image = png_of(glb_halves())};
  grid.attributes = R"("TEXCOORD_3":1)";
  grid.material = R"({"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":3}}})";
  CHECK(is_about(at(grid_colours(grid), 0.25, 0.5), k_glb_red));
}

TEST_CASE("the diffuse texture of specular and glossy materials is one") {
  TexturedGrid grid{.image = png_of(glb_halves())};
  grid.material = R"({"extensions":{"KHR_materials_pbrSpecularGlossiness":)"
                  R"({"diffuseTexture":{"index":0},"diffuseFactor":[1,1,1,1]}}})";
  CHECK(is_about(at(grid_colours(grid), 0.75, 0.5), k_glb_green));
}

TEST_CASE("primitives without a texture have their factor, beside those with one") {
  TexturedGrid grid{.image = png_of(glb_halves())};
  grid.material += R"(,{"pbrMetallicRoughness":{"baseColorFactor":[0,0,1,1]}})";
  grid.primitive = R"("material":0}]},{"primitives":[{"attributes":{"POSITION":0},"indices":2,)"
                   R"("material":1)";
  const GlbColours colours = grid_colours(grid);
  REQUIRE(colours.size() == 2 * k_glb_side * k_glb_side);
  CHECK(is_about(at(colours, 0.25, 0.5), k_glb_red));
  CHECK(is_about(colours.back(), {0, 0, 255}));
}

TEST_CASE("a picture that is missing, broken or too large costs the colours, not the mesh") {
  const TempFolder folder;
  const auto check_plain = [&](const TexturedGrid& grid) {
    write_file(folder / "m.glb", grid.glb());
    const auto source = open_mesh(folder / "m.glb", {.textures = Textures::bake});
    CHECK(source->info().channels.empty());
    CHECK(source->info().textures.empty());
    CHECK(read_mesh(*source).triangles.size() == 2 * (k_glb_side - 1) * (k_glb_side - 1));
  };
  check_plain({.images = R"({"uri":"none.png"})"});
  check_plain({.images = R"({"uri":"../none.png"})"});
  check_plain({.image = "GIF89a"});
  const std::string png = png_of(gradient(256));
  check_plain({.image = png.substr(0, png.size() / 2)});
  std::string bomb = png;
  bomb[16] = bomb[20] = '\x7f';
  check_plain({.image = bomb});
  const auto source = open_mesh(folder / "m.glb", {.textures = Textures::name});
  REQUIRE(source->info().textures.size() == 1);
  CHECK(source->info().textures[0].find("make it smaller") != std::string::npos);
}

TEST_CASE("what is malformed about a texture is a line that names it") {
  const auto refusal = [](const TexturedGrid& grid) -> std::string {
    try {
      grid_colours(grid);
    } catch (const DataError& error) {
      return error.what();
    }
    return "";
  };
  TexturedGrid grid{.image = png_of(glb_halves())};
  grid.samplers = R"({"wrapS":1})";
  grid.textures = R"({"source":0,"sampler":0})";
  CHECK(refusal(grid).find("samplers[0].wrapS is no way to wrap") != std::string::npos);
  grid.textures = R"({"source":4})";
  CHECK(refusal(grid).find("images") != std::string::npos);
  grid = {.image = png_of(glb_halves()), .attributes = R"("TEXCOORD_0":0)"};
  CHECK(refusal(grid).find("its texture coordinates are not of VEC2") != std::string::npos);
}

TEST_CASE("a GLB's materials are labels only where its textures are not colours") {
  const TempFolder folder;
  write_file(folder / "m.glb", TexturedGrid{.image = png_of(gradient(64))}.glb());
  const auto labels_with = [&](Textures textures) {
    return open_mesh(folder / "m.glb", {.textures = textures})->info().labels;
  };
  CHECK_FALSE(labels_with(Textures::bake));
  CHECK(labels_with(Textures::drop) == LabelMeaning{"material", {{.name = "material 0"}}});
  CHECK(labels_with(Textures::name));
}
