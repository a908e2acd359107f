// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>

#include "compressed.hpp"
#include "picture_files.hpp"
#include "ply_test_files.hpp"
#include "uv_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

constexpr std::string_view k_textures =
    "comment TextureFile one.png\ncomment TextureFile  my two.jpg \n";
constexpr std::string_view k_list = "property list uchar float texcoord\n";

/// The header of a square whose faces have these properties.
std::string header(std::string_view faces, std::string_view properties,
                   std::string_view comments = k_textures) {
  return "ply\nformat ascii 1.0\n" + std::string(comments) + "element vertex 4\n" +
         std::string(k_xyz) + "element face " + std::string(faces) + "\n" +
         std::string(properties) + "end_header\n" + std::string(k_square_text);
}

const std::string k_properties = std::string(k_corners) + std::string(k_list);

/// A mesh with its pictures beside it.
struct Square : UvModel {
  explicit Square(const std::string& bytes) : UvModel("m.ply", bytes) {
    with("one.png", png_of(gradient(4))).with("my two.jpg", jpeg_of(gradient(16)));
  }
};

const std::vector<CornerUvs> k_two{{{{0.5F, 0.25F}, {1, 0}, {0, 1}}}, {{{0, 1}, {1, 0}, {-2, 3}}}};

void check_two(const UvTriangles& read) {
  CHECK(read.corners == std::vector<WideTriangle>{{0, 1, 2}, {2, 1, 3}});
  CHECK(read.uvs == k_two);
}

/// Left half red, right half green.
std::string ply_halves() {
  return png_of(picture_of(64, 64, [](std::uint32_t x, std::uint32_t) {
    return x < 32 ? Texel{255, 0, 0} : Texel{0, 255, 0};
  }));
}

}  // namespace

TEST_CASE("faces of an ascii PLY have texture coordinates and pictures") {
  const std::string faces = "3 0 1 2 6 0.5 0.25 1 0 0 1 0\n3 2 1 3 6 0 1 1 0 -2 3 1\n";
  const Square model(header("2", k_properties + "property int texnumber\n") + faces);
  const auto source = model.open();
  const MeshFileInfo& info = source->info();
  CHECK(info.uvs);
  CHECK(info.pictures.names == Names{"one.png", "my two.jpg"});
  CHECK(info.pictures.load(1) == jpeg_of(gradient(16)));
  REQUIRE(info.labels);
  CHECK(info.labels->materials ==
        std::vector<Material>{{.name = "one", .maps = {{MapUse::colour, 0}}},
                              {.name = "my two", .maps = {{MapUse::colour, 1}}},
                              {.name = "default"}});
  CHECK(info.skipped.empty());
  const UvTriangles read = triangles_of(*source);
  check_two(read);
  CHECK(read.labels == std::vector<Label>{0, 1});
  check_two(triangles_of(*source));
}

TEST_CASE("faces of a binary PLY have texture coordinates, in either order, compressed or not") {
  for (const auto order : {BinaryFile::Order::little, BinaryFile::Order::big}) {
    // A list of doubles before the corners, and a negative number.
    const std::string elements =
        std::string(k_textures) + "element vertex 4\n" + std::string(k_xyz) +
        "element face 2\nproperty list ushort double texcoord\nproperty char texnumber\n" +
        std::string(k_corners);
    BinaryFile file(order, elements);
    file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5F});
    file.put<std::uint16_t>({6}).put<double>({0.5, 0.25, 1, 0, 0, 1}).put<std::int8_t>({-1});
    file.bytes({3}).ints({0, 1, 2});
    file.put<std::uint16_t>({6}).put<double>({0, 1, 1, 0, -2, 3}).put<std::int8_t>({1});
    file.bytes({3}).ints({2, 1, 3});
    for (const std::string& bytes : {file.text(), gzipped(file.text()), zstandard(file.text())}) {
      const Square model(bytes);
      const UvTriangles read = triangles_of(*model.open());
      check_two(read);
      CHECK(read.labels == std::vector<Label>{2, 1});
    }
  }
}

TEST_CASE("a polygon of a PLY has texture coordinates by its corners") {
  const Square model(header("1", k_properties) + "4 0 1 3 2 8 0 0 1 0 1 1 0 1\n");
  const auto source = model.open();
  CHECK(source->info().labels->materials.size() == 2);
  const UvTriangles read = triangles_of(*source);
  REQUIRE(read.corners.size() == 2);
  const std::vector<Uv> wanted{{0, 0}, {1, 0}, {0, 1}, {1, 1}};
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 3; ++k) CHECK(read.uvs[i][k] == wanted[read.corners[i][k]]);
  }
  CHECK(read.labels == std::vector<Label>{0, 0});
}

TEST_CASE("a face of a PLY without texture coordinates, or with odd ones, has (0, 0)") {
  const Square model(header("4", k_properties, "") +
                     "3 0 1 2 0\n3 0 1 2 5 1 1 1 1 1\n3 2 1 3 6 nan 1 1e99 0 inf 3\n"
                     "4 0 1 3 2 6 1 1 1 1 1 1\n");
  const auto source = model.open();
  CHECK(source->info().uvs);
  CHECK_FALSE(source->info().labels);
  const UvTriangles read = triangles_of(*source);
  REQUIRE(read.uvs.size() == 5);
  for (const std::size_t i : {0, 1, 3, 4}) CHECK(read.uvs[i] == CornerUvs{});
  CHECK(read.uvs[2] == CornerUvs{{{0, 1}, {0, 0}, {0, 3}}});
}

TEST_CASE("triangles of a binary PLY are read in runs, whatever stands between them") {
  for (const auto order : {BinaryFile::Order::little, BinaryFile::Order::big}) {
    for (const bool are_dropped : {false, true}) {
      BinaryFile file(order, "element vertex 4\n" + std::string(k_xyz) + "element face 6\n" +
                                 std::string(k_corners) + std::string(k_list));
      file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5F});
      const auto triangle = [&](float first) {
        file.bytes({3}).ints({0, 1, 2}).bytes({6}).floats({first, 0, 1, NAN, 0, 1});
      };
      triangle(2);
      triangle(3);
      file.bytes({3}).ints({2, 1, 3}).bytes({0});
      triangle(4);
      file.bytes({4}).ints({0, 1, 3, 2}).bytes({8}).floats({5, 5, 5, 5, 5, 5, 5, 5});
      triangle(6);
      const Square model(file.text());
      if (are_dropped) {
        CHECK(triangles_of(*open_mesh(model.path())).corners.size() == 7);
        continue;
      }
      const UvTriangles read = triangles_of(*model.open());
      REQUIRE(read.uvs.size() == 7);
      const std::vector<float> firsts{2, 3, 0, 4, 5, 5, 6};
      for (std::size_t i = 0; i < 7; ++i) CHECK(read.uvs[i][0][0] == firsts[i]);
      for (const std::size_t i : {0, 1, 3, 6}) {
        CHECK(read.uvs[i] == CornerUvs{{{firsts[i], 0}, {1, 0}, {0, 1}}});
      }
      CHECK(read.corners[3] == WideTriangle{0, 1, 2});
    }
  }
}

TEST_CASE("vertices of a PLY have texture coordinates if it names a picture") {
  for (const auto& [u, v] :
       {std::pair("s", "t"), std::pair("u", "v"), std::pair("texture_u", "texture_v"),
        std::pair("texture_s", "texture_t")}) {
    const std::string text = std::string("element vertex 4\n") + std::string(k_xyz) +
                             "property float " + u + "\nproperty double " + v +
                             "\nelement face 2\n" + std::string(k_corners) +
                             "end_header\n0 0 0 0.5 0.25\n1 0 0 1 0\n0 1 0 0 1\n1 1 0.5 -2 3\n"
                             "3 0 1 2\n3 2 1 3\n";
    const std::string start = "ply\nformat ascii 1.0\n";
    const Square model(start + std::string(k_textures) + text);
    const auto source = model.open();
    CHECK(source->info().uvs);
    CHECK(source->info().skipped.empty());
    CHECK(source->info().channels.empty());
    check_two(triangles_of(*source));
    const Square without(start + text);
    CHECK_FALSE(without.open()->info().uvs);
    CHECK(without.open()->info().skipped.size() == 2);
  }
}

TEST_CASE("a PLY without texture coordinates is as if its textures were dropped") {
  const Square model(header("2", std::string(k_corners) + "property int texnumber\n") +
                     "3 0 1 2 0\n3 2 1 3 1\n");
  const auto kept = model.open();
  const auto dropped = open_mesh(model.path(), {});
  CHECK_FALSE(kept->info().uvs);
  CHECK(kept->info().pictures.names.empty());
  CHECK(kept->info().labels == dropped->info().labels);
  CHECK(triangles_of(*kept).labels == std::vector<Label>{0, 1});
}

TEST_CASE("what an ascii PLY gives does not depend on threads") {
  std::string text = "ply\nformat ascii 1.0\nelement vertex 4\n" + std::string(k_xyz) +
                     "element face 40000\n" + k_properties + "end_header\n" +
                     std::string(k_square_text);
  for (int i = 0; i < 40'000; ++i) {
    const std::string n = std::to_string(i);
    const std::string uv = n + " 0 " + n + " 1 " + n + " 2";
    text += i % 7 == 0   ? "3 0 1 2 0\n"
            : i % 5 == 0 ? "4 0 1 3 2 8 " + uv + " " + n + " 3\n"
                         : "3 0 1 2 6 " + uv + "\n";
  }
  const Square model(text);
  const UvTriangles one = triangles_of(*model.open(1));
  const UvTriangles three = triangles_of(*model.open(3));
  CHECK(one.corners == three.corners);
  CHECK(one.uvs == three.uvs);
  CHECK(one.uvs[1] == CornerUvs{{{1, 0}, {1, 1}, {1, 2}}});
}

TEST_CASE("a PLY's textures become the colours of vertices") {
  // A strip of squares that spans the picture from left to right.
  for (const bool has_colours : {false, true}) {
    std::string text = "ply\nformat ascii 1.0\ncomment TextureFile one.png\nelement vertex 18\n" +
                       std::string(k_xyz) +
                       (has_colours ? "property uchar red\nproperty uchar green\n"
                                      "property uchar blue\n"
                                    : "") +
                       "element face 8\n" + k_properties + "end_header\n";
    for (int i = 0; i < 18; ++i) {
      text += std::to_string(i / 2) + " " + std::to_string(i % 2) + " 0";
      text += has_colours ? " 1 2 3\n" : "\n";
    }
    for (int i = 0; i < 8; ++i) {
      const auto place = [](int x, int y) {
        return " " + std::to_string(x / 8.0) + " " + std::to_string(y);
      };
      const auto vertex = [](int at) { return " " + std::to_string(at); };
      text += "4" + vertex(2 * i) + vertex(2 * i + 2) + vertex(2 * i + 3) + vertex(2 * i + 1);
      // The last square has no texture.
      text += i == 7 ? " 0\n"
                     : " 8" + place(i, 0) + place(i + 1, 0) + place(i + 1, 1) + place(i, 1) + "\n";
    }
    Square model(text);
    model.with("one.png", ply_halves());
    const auto colours = colours_of(model.path());
    REQUIRE(colours.size() == 18);
    CHECK(colours[2] == std::array<float, 3>{255, 0, 0});
    CHECK(colours[13] == std::array<float, 3>{0, 255, 0});
    const float rest = has_colours ? 1 : 255;
    CHECK(colours[17][0] == rest);
    const auto source = open_mesh(model.path(), {.textures = Textures::bake});
    CHECK(source->info().textures == Names{"one.png (64 x 64)"});
    CHECK_FALSE(source->info().uvs);
    CHECK(triangles_of(*source).uvs.empty());
    const auto named = open_mesh(model.path(), {.textures = Textures::name});
    CHECK(named->info().textures == Names{"one.png (64 x 64)"});
    CHECK(named->info().channels.size() == (has_colours ? 3 : 0));
    model.with("one.png", "none");
    CHECK(open_mesh(model.path(), {.textures = Textures::bake})->info().channels.size() ==
          (has_colours ? 3 : 0));
  }
}
