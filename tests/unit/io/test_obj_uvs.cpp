// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "picture_files.hpp"
#include "ply_test_files.hpp"
#include "uv_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

constexpr std::string_view k_uv_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
constexpr std::string_view k_uv_places = "vt 0.1 0.2\nvt 1 0\nvt 1 1\nvt -3 1\n";
constexpr Uv k_none{0, 0};

std::string uv_square(std::string_view rest) {
  return std::string(k_uv_square) + std::string(k_uv_places) + std::string(rest);
}

const std::string k_uv_skin = "newmtl skin\nmap_Kd skin.png\n";

std::string small_png() {
  return png_of(gradient(4));
}
std::string small_jpeg() {
  return jpeg_of(gradient(16));
}

}  // namespace

TEST_CASE("triangles of an OBJ have the texture coordinates of their corners") {
  UvModel model("m.obj",
                uv_square("mtllib m.mtl\nusemtl skin\nf 1/1 2/2 3/3\nf 1/1/1 3/3/1 4/4/1\n"));
  model.with("m.mtl", k_uv_skin).with("skin.png", small_png());
  const auto source = model.open();
  CHECK(source->info().uvs);
  CHECK(source->info().pictures.names == Names{"skin.png"});
  CHECK(source->info().pictures.load(0) == small_png());
  REQUIRE(source->info().labels);
  CHECK(source->info().labels->materials ==
        std::vector<Material>{{.name = "skin", .maps = {{MapUse::colour, 0}}}});
  CHECK(source->info().skipped.empty());
  CHECK(source->info().textures.empty());
  CHECK(source->info().channels.empty());
  const UvTriangles read = triangles_of(*source);
  CHECK(read.corners == std::vector<WideTriangle>{{0, 1, 2}, {0, 2, 3}});
  CHECK(read.uvs == std::vector<CornerUvs>{{{{0.1F, 0.2F}, {1, 0}, {1, 1}}},
                                           {{{0.1F, 0.2F}, {1, 1}, {-3, 1}}}});
  CHECK(read.labels == std::vector<Label>{0, 0});
}

TEST_CASE("an OBJ's relative texture indices count from the statements before") {
  UvModel model("m.obj",
                "v 0 0 0\nvt 0 0\nv 1 0 0\nvt 1 0\nv 1 1 0\nvt 1 1\nf -3/-3 -2/-2 -1/-1\n"
                "vt 9 9\nf 1/-1 2/-1 3/1\n");
  const UvTriangles read = triangles_of(*model.open());
  CHECK(read.uvs == std::vector<CornerUvs>{{{{0, 0}, {1, 0}, {1, 1}}}, {{{9, 9}, {9, 9}, {0, 0}}}});
}

TEST_CASE("an OBJ's polygons are cut by their shape, each corner with its texture coordinates") {
  // An arrow that points to the right, with a notch at its last corner:
  //   2
  //     3   1
  //   0
  const std::string arrow =
      "v 0 0 0\nv 4 2 0\nv 0 4 0\nv 1 2 0\nvt 0.5 0\nvt 0.5 0.25\nvt 0.5 0.5\nvt 0.5 0.75\n";
  UvModel model("m.obj", arrow + "f 1/1 2/2 3/3 4/4\nf 1/4 2/3 3/2 4/1\n");
  const auto source = model.open();
  const UvTriangles read = triangles_of(*source);
  const auto plain = open_mesh(model.path(), {});
  CHECK(read.corners == triangles_of(*plain).corners);
  REQUIRE(read.corners.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto vertex = static_cast<float>(read.corners[i][k]);
      CHECK(read.uvs[i][k] == Uv{0.5F, (i < 2 ? vertex : 3 - vertex) / 4});
    }
  }
}

TEST_CASE("a corner of an OBJ without texture coordinates, or with odd ones, is at (0, 0)") {
  UvModel model("m.obj",
                uv_square("vt nan 1\nvt 1e99 x\nf 1/3 2/5 3/6\nf 1 2 3\nf 1//1 2//1 3/3/1\n"
                          "f 1/3 2/3 3 4/3\n"));
  const UvTriangles read = triangles_of(*model.open());
  REQUIRE(read.uvs.size() == 5);
  CHECK(read.uvs[0] == CornerUvs{{{1, 1}, {0, 1}, {0, 0}}});
  CHECK(read.uvs[1] == CornerUvs{k_none, k_none, k_none});
  CHECK(read.uvs[2] == CornerUvs{{{0, 0}, {0, 0}, {1, 1}}});
  CHECK(read.uvs[3] == CornerUvs{{{1, 1}, {1, 1}, {0, 0}}});
}

TEST_CASE("without texture coordinates in use an OBJ is as if its textures were dropped") {
  for (const char* rest : {"f 1 2 3\n", "f 1//1 2//1 3//1\n", "f 1/ 2/ 3/\n"}) {
    UvModel model("m.obj", uv_square("mtllib m.mtl\nusemtl skin\n" + std::string(rest)));
    model.with("m.mtl", k_uv_skin).with("skin.png", small_png());
    const auto kept = model.open();
    const auto dropped = open_mesh(model.path(), {});
    CHECK_FALSE(kept->info().uvs);
    CHECK(kept->info().pictures.names.empty());
    CHECK(kept->info().labels == dropped->info().labels);
    CHECK(kept->info().skipped == dropped->info().skipped);
    CHECK(triangles_of(*kept).uvs.empty());
  }
  UvModel none("m.obj", std::string(k_uv_square) + "f 1/1 2/2 3/3\n");
  CHECK_FALSE(none.open()->info().uvs);
}

TEST_CASE("a texture index that is out of range is told with its line") {
  const auto told = [](const std::string& face) {
    UvModel model("m.obj", uv_square("f 1/1 2/2 3/3\n" + face));
    return error_of([&] { triangles_of(*model.open()); });
  };
  const std::string why = "m.obj: line 10: ";
  CHECK(told("f 1/1 2/5 3/3\n") == why +
                                       "texture coordinate index 5 is out of range: there are 4 "
                                       "texture coordinates");
  CHECK(told("f 1/1 2/0 3/3\n") == why +
                                       "texture coordinate index 0 is out of range: there are 4 "
                                       "texture coordinates");
  CHECK(told("f 1/1 2/-5 3/3\n") == why +
                                        "texture coordinate index -5 is out of range: there are "
                                        "4 texture coordinates before");
  CHECK(told("f 1/1 2/1-2 3/3\n") ==
        why + "the corner of a face has '1-2' as its texture coordinates");
}

TEST_CASE("an OBJ's maps are kept with their uses, those that lie otherwise are named") {
  UvModel model("m.obj",
                uv_square("mtllib m.mtl\nusemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 3/3 4/4\n"));
  model.with("m.mtl",
             "newmtl a\nKd 0 0 0\nmap_Kd -clamp on tex\\one.jpg\nmap_Bump -clamp on -bm 2 n.png\n"
             "map_Ke -clamp on tex/one.jpg\nmap_Ks s.png\nmap_d d.png\n"
             "newmtl b\nd 0.5\nmap_Kd -s 2 4 -o 0.5 -1 other/one.jpg\nmap_Bump n.png\n"
             "map_Ks s.png\n");
  model.with("tex/one.jpg", small_jpeg()).with("other/one.jpg", small_png());
  model.with("n.png", small_png());
  const auto source = model.open();
  const MeshFileInfo& info = source->info();
  CHECK(info.pictures.names == Names{"one.jpg", "n.png", "one.png"});
  CHECK(info.pictures.load(0) == small_jpeg());
  CHECK(info.pictures.load(2) == small_png());
  REQUIRE(info.labels);
  const Material a{.name = "a",
                   .maps = {{MapUse::colour, 0}, {MapUse::normal, 1}, {MapUse::emission, 0}},
                   .wrap_u = TextureWrap::clamp,
                   .wrap_v = TextureWrap::clamp};
  const Material b{.name = "b", .colour = {1, 1, 1, 0.5F}, .maps = {{MapUse::colour, 2}}};
  CHECK(info.labels->materials == std::vector<Material>{a, b});
  CHECK(info.skipped == Names{"map_Bump (1)", "map_Ks (2)", "map_d (1)"});
  const UvTriangles read = triangles_of(*source);
  CHECK(read.uvs[0] == CornerUvs{{{0.1F, 0.2F}, {1, 0}, {1, 1}}});
  CHECK(read.uvs[1][1] == Uv{2.5F, 3});
  CHECK(read.uvs[1][2] == Uv{-5.5F, 3});
}

TEST_CASE("a picture that is missing or is none is left out, its material stays") {
  UvModel model("m.obj",
                uv_square("mtllib m.mtl\nusemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 3/3 4/4\n"));
  model.with("m.mtl", "newmtl a\nmap_Kd gone.png\nnewmtl b\nmap_Kd text.png\nmap_Bump n.png\n");
  model.with("text.png", "no picture").with("n.png", small_png());
  const auto source = model.open();
  CHECK(source->info().uvs);
  CHECK(source->info().pictures.names == Names{"n.png"});
  REQUIRE(source->info().labels);
  CHECK(source->info().labels->materials ==
        std::vector<Material>{{.name = "a"}, {.name = "b", .maps = {{MapUse::normal, 0}}}});
}

TEST_CASE("names of pictures differ, in any case of letters, and say what the pictures are") {
  UvModel model("m.obj",
                uv_square("mtllib m.mtl\nusemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 1/1 2/2 3/3\n"
                          "usemtl c\nf 1/1 2/2 3/3\nusemtl d\nf 1/1 2/2 3/3\n"));
  model.with("m.mtl",
             "newmtl a\nmap_Kd x/Wood.PNG\nnewmtl b\nmap_Kd y/wood.png\n"
             "newmtl c\nmap_Kd z/wood.v2\nnewmtl d\nmap_Kd z/wood.tga\n");
  for (const char* name : {"x/Wood.PNG", "y/wood.png", "z/wood.v2", "z/wood.tga"}) {
    model.with(name, small_png());
  }
  CHECK(model.open()->info().pictures.names ==
        Names{"Wood.PNG", "wood_2.png", "wood.v2.png", "wood_3.png"});
}

TEST_CASE("what an OBJ gives does not depend on threads, nor on where its pieces end") {
  std::string text = "mtllib m.mtl\n";
  std::string relative = text;
  for (int i = 0; i < 40'000; ++i) {
    const std::string vertex = "v " + std::to_string(i % 100) + " " + std::to_string(i / 100) +
                               " 0\nvt " + std::to_string(i) + " " + std::to_string(-i) + "\n";
    text += vertex;
    relative += vertex;
    if (i < 3) continue;
    if (i % 5000 == 3) {
      text += "usemtl m" + std::to_string(i / 5000 % 2) + "\n";
      relative += "usemtl m" + std::to_string(i / 5000 % 2) + "\n";
    }
    const auto corner = [](int at) { return " " + std::to_string(at) + "/" + std::to_string(at); };
    text += "f" + corner(i - 2) + corner(i) + corner(i - 1) + (i % 3 == 0 ? corner(i + 1) : "");
    relative += "f" + corner(-4) + corner(-2) + corner(-3) + (i % 3 == 0 ? corner(-1) : "");
    text += "\n";
    relative += "\n";
  }
  UvModel model("m.obj", text);
  UvModel other("m.obj", relative);
  for (UvModel* each : {&model, &other}) {
    each->with("m.mtl", "newmtl m0\nmap_Kd -s 2 2 a.png\nnewmtl m1\nmap_Kd a.png\n");
    each->with("a.png", small_png());
  }
  const UvTriangles one = triangles_of(*model.open(1));
  CHECK(one.uvs.size() == one.corners.size());
  for (const UvTriangles& read : {triangles_of(*model.open(3)), triangles_of(*other.open(3))}) {
    CHECK(read.corners == one.corners);
    CHECK(read.labels == one.labels);
    CHECK(read.uvs == one.uvs);
  }
  CHECK(one.uvs[0][1] == Uv{4, -4});
}
