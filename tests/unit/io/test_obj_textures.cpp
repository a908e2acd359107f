// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>

#include "picture_files.hpp"
#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

constexpr Texel k_obj_red{255, 0, 0};
constexpr Texel k_obj_green{0, 255, 0};
constexpr Texel k_obj_blue{0, 0, 255};
constexpr int k_side = 33;  // vertices along a side of a grid

using Colours = std::vector<std::array<float, 3>>;

bool is(const std::array<float, 3>& colour, const Texel& wanted) {
  return std::abs(colour[0] - wanted[0]) < 0.5F && std::abs(colour[1] - wanted[1]) < 0.5F &&
         std::abs(colour[2] - wanted[2]) < 0.5F;
}

/// Left half red, right half green.
Picture halves() {
  return picture_of(
      64, 64, [](std::uint32_t x, std::uint32_t) { return x < 32 ? k_obj_red : k_obj_green; });
}

/// Upper half red, lower half green.
Picture layers() {
  return picture_of(
      64, 64, [](std::uint32_t, std::uint32_t y) { return y < 32 ? k_obj_red : k_obj_green; });
}

enum class Indices { absolute, relative };

/// A grid from 0 to 1, with its positions as texture coordinates.
std::string grid_obj(Indices indices = Indices::absolute) {
  std::string text = "mtllib m.mtl\nusemtl skin\n";
  for (int y = 0; y < k_side; ++y) {
    for (int x = 0; x < k_side; ++x) {
      const std::string place = std::to_string(static_cast<double>(x) / (k_side - 1)) + " " +
                                std::to_string(static_cast<double>(y) / (k_side - 1));
      text += "v " + place + " 0\nvt " + place + "\n";
    }
    for (int x = 1; y > 0 && x < k_side; ++x) {
      const int from = indices == Indices::relative ? -2 * k_side - 1 : k_side * (y - 1);
      const auto corner = [&](int at) {
        return " " + std::to_string(from + at) + "/" + std::to_string(from + at);
      };
      text += "f" + corner(x) + corner(x + 1) + corner(x + 1 + k_side) + corner(x + k_side) + "\n";
    }
  }
  return text;
}

/// A square of two triangles; the test adds the rest.
constexpr std::string_view k_textured_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
constexpr std::string_view k_textured_places = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";

class Model {
 public:
  explicit Model(const std::string& obj) { write_file(folder_ / "m.obj", obj); }
  Model& with(const std::string& name, const std::string& bytes) {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    write_file(path, bytes);
    return *this;
  }
  Colours colours(unsigned threads = 0) const {
    return colours_of(folder_ / "m.obj", {.threads = threads, .textures = Textures::bake});
  }
  std::unique_ptr<MeshSource> open(Textures textures = Textures::bake) const {
    return open_mesh(folder_ / "m.obj", {.textures = textures});
  }

 private:
  TempFolder folder_;
};

std::string square(std::string_view rest) {
  return std::string(k_textured_square) + std::string(k_textured_places) + std::string(rest);
}

const std::string k_skin = "newmtl skin\nmap_Kd skin.png\n";

}  // namespace

TEST_CASE("an OBJ's texture goes up from the picture's lower side") {
  Model model(grid_obj());
  model.with("m.mtl", k_skin).with("skin.png", png_of(gradient(256)));
  const Colours colours = model.colours();
  for (int y = 1; y + 1 < k_side; ++y) {
    for (int x = 1; x + 1 < k_side; ++x) {
      const auto& [red, green, blue] = colours[static_cast<std::size_t>(y * k_side + x)];
      CHECK(std::abs(red - 255.0 * x / (k_side - 1)) <= 2);
      CHECK(std::abs(green - (255 - 255.0 * y / (k_side - 1))) <= 2);
      CHECK(std::abs(blue - 100.0) <= 1);
    }
  }
}

TEST_CASE("neither threads nor relative indices change an OBJ's colours") {
  Model absolute(grid_obj());
  absolute.with("m.mtl", k_skin).with("skin.png", jpeg_of(gradient(200)));
  Model relative(grid_obj(Indices::relative));
  relative.with("m.mtl", k_skin).with("skin.png", jpeg_of(gradient(200)));
  const Colours one = absolute.colours(1);
  CHECK(one == absolute.colours(3));
  CHECK(one == relative.colours(3));
}

TEST_CASE("a vertex on a seam has the mean of its charts, and nothing from between them") {
  // Two separate triangles in the atlas, red and blue, with green between them.
  const Picture atlas = picture_of(64, 64, [](std::uint32_t x, std::uint32_t) {
    return x < 16 ? k_obj_red : x < 48 ? k_obj_green : k_obj_blue;
  });
  Model model(std::string(k_textured_square) +
              "vt 0 0\nvt 0.25 0\nvt 0 1\nvt 1 0\nvt 0.75 0\nvt 1 1\nmtllib m.mtl\nusemtl skin\n"
              "f 1/1 2/2 3/3\nf 1/4 3/5 4/6\n");
  model.with("m.mtl", k_skin).with("skin.png", png_of(atlas));
  const Colours colours = model.colours();
  CHECK(is(colours[1], k_obj_red));
  CHECK(is(colours[3], k_obj_blue));
  CHECK(colours[0][0] == doctest::Approx(188).epsilon(0.01));
  CHECK(colours[0][1] == 0);
  CHECK(colours[0][2] == doctest::Approx(188).epsilon(0.01));
}

TEST_CASE("faces have the material that was used last, of any library") {
  Model model(
      square("mtllib one.mtl my two.mtl\nmtllib my two.mtl\nusemtl left side\n"
             "f 1/1 2/2 3/3\nv 5 5 5\nv 6 5 5\nv 5 6 5\nusemtl plain\nf 5 6 7\n"
             "v 8 8 8\nv 9 8 8\nv 8 9 8\nusemtl unknown\nf 8/1 9/2 10/3\n"));
  model.with("one.mtl", "newmtl plain\nKd 0 0 1\n")
      .with("my two.mtl", "newmtl left side\nKd 0 0 0\nmap_Kd -s 0.4 1 1 maps\\halves.PNG\n")
      .with("maps/halves.png", png_of(halves()));
  const Colours colours = model.colours();
  REQUIRE(colours.size() == 10);
  CHECK(is(colours[1], k_obj_red));
  CHECK(is(colours[3], {255, 255, 255}));  // in no face
  CHECK(is(colours[5], k_obj_blue));
  CHECK(is(colours[9], {255, 255, 255}));
}

TEST_CASE("a map may be moved and clamped") {
  const std::string obj = square("mtllib m.mtl\nusemtl skin\nf 1/1 2/1 3/1\n");
  const auto first = [&](const std::string& options) {
    Model model(obj);
    model.with("m.mtl", "newmtl skin\nmap_Kd " + options + " skin.png\n")
        .with("skin.png", png_of(halves()));
    return model.colours()[0];
  };
  CHECK(is(first("-o 0.25 0.25"), k_obj_red));
  CHECK(is(first("-o 0.75 0.25"), k_obj_green));
  CHECK(is(first("-o 1.25 0.25"), k_obj_red));
  CHECK(is(first("-clamp on -o 1.25 0.25"), k_obj_green));
}

TEST_CASE("a polygon is coloured within itself") {
  // A chevron, open upwards: a fan from its first corner would cover the notch.
  Model model(
      "v 0 1 0\nv 0.5 0 0\nv 1 1 0\nv 0.5 0.5 0\n"
      "vt 0 1\nvt 0.5 0\nvt 1 1\nvt 0.5 0.5\nmtllib m.mtl\nusemtl skin\n"
      "f 1/1 2/2 3/3 4/4\n");
  const Picture notch = picture_of(256, 256, [](std::uint32_t x, std::uint32_t y) {
    const int up = 255 - static_cast<int>(y);
    const int aside = std::abs(static_cast<int>(x) - 128);
    return up > 128 + aside ? k_obj_green : k_obj_red;
  });
  model.with("m.mtl", k_skin).with("skin.png", png_of(notch));
  for (const auto& colour : model.colours()) CHECK(colour[1] < 60);
}

TEST_CASE("a texture comes before the vertices' own colours") {
  Model model("v 0 0 0 0 0 1\nv 1 0 0 0 0 1\nv 1 1 0 0 0 1\nv 0 1 0 0 0 1\n" +
              std::string(k_textured_places) + "mtllib m.mtl\nusemtl skin\nf 1/3 2/3 3/3\n");
  model.with("m.mtl", k_skin).with("skin.png", png_of(layers()));
  const Colours colours = model.colours();
  CHECK_FALSE(is(colours[0], k_obj_blue));
  CHECK(is(colours[3], k_obj_blue));
}

TEST_CASE("an OBJ without its library or picture is read without colours") {
  const std::string obj = square("mtllib m.mtl\nusemtl skin\nf 1/1 2/2 3/3 4/4\n");
  const auto check_plain = [](const Model& model) {
    const auto source = model.open();
    CHECK(source->info().channels.empty());
    CHECK(source->info().textures.empty());
    CHECK(read_mesh(*source).triangles.size() == 2);
  };
  check_plain(Model(obj));
  Model without(obj);
  check_plain(without.with("m.mtl", k_skin));
  CHECK(without.open(Textures::name)->info().textures ==
        std::vector<std::string>{"skin.png (no such file beside the mesh, or in a folder below)"});
  Model broken(obj);
  check_plain(broken.with("m.mtl", k_skin).with("skin.png", "\x89PNG\r\n\x1a\n broken"));
  Model dropped(obj);
  dropped.with("m.mtl", k_skin).with("skin.png", png_of(halves()));
  CHECK(dropped.open(Textures::drop)->info().channels.empty());
  CHECK(dropped.open(Textures::name)->info().textures ==
        std::vector<std::string>{"skin.png (64 x 64)"});
}

TEST_CASE("malformed faces and coordinates are told by who reads the faces") {
  const auto refusal = [](const std::string& faces) -> std::string {
    Model model(square("mtllib m.mtl\nusemtl skin\nf 1/1 2/2 3/3\n" + faces));
    model.with("m.mtl", k_skin).with("skin.png", png_of(halves()));
    const auto source = model.open();
    try {
      read_mesh(*source);
    } catch (const DataError& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refusal("f 1/1 2/2 9/3\n").find("out of range") != std::string::npos);
  CHECK(refusal("f 1/1 x 3/3\n").find("no whole number") != std::string::npos);
  CHECK(refusal("f 1/99 2/-99 3/0\nvt x y\nvt\n") == "");
}

TEST_CASE("an OBJ's materials are labels only where its textures are not colours") {
  Model model(grid_obj());
  model.with("m.mtl", k_skin).with("skin.png", png_of(gradient(64)));
  CHECK_FALSE(model.open()->info().labels);
  CHECK(read_mesh(*model.open()).columns.labels.empty());
  for (const Textures textures : {Textures::drop, Textures::name}) {
    CHECK(model.open(textures)->info().labels == LabelMeaning{"material", {{.name = "skin"}}});
  }
  const Quiet quiet;
  CHECK(model.with("skin.png", "no picture").open()->info().labels);
}
