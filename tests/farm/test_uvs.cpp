// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Texture coordinates and pictures, both kept and made anew, from input to output of real runs.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/io/material_colours.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/io/mesh_source.hpp>

#include "support/meshes.hpp"
#include "support/process.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;
using test::Ran;
using test::read_text;

namespace {

constexpr std::uint32_t k_rows = 120;
constexpr std::uint32_t k_columns = 60;
constexpr std::uint32_t k_side = 256;
const double k_turn = 2 * std::acos(-1.0);

/// The angles of a point on the torus, as fractions of a turn.
std::array<double, 2> angles_of(Vec3 p) {
  const double u = std::atan2(p.y, p.x) / k_turn;
  const double v = std::atan2(p.z, std::sqrt(p.x * p.x + p.y * p.y) - 1) / k_turn;
  return {u < 0 ? u + 1 : u, v < 0 ? v + 1 : v};
}

double apart(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, 1 - d);
}

/// The levels of the picture at these angles.
std::array<double, 3> levels_at(double u, double v) {
  return {0.5 + 0.4 * std::sin(k_turn * u), 0.5 + 0.4 * std::cos(k_turn * v),
          0.5 + 0.4 * std::sin(k_turn * (u + v))};
}

std::string picture() {
  std::vector<std::uint8_t> texels;
  for (std::uint32_t y = 0; y < k_side; ++y) {
    for (std::uint32_t x = 0; x < k_side; ++x) {
      for (const double level : levels_at((x + 0.5) / k_side, 1 - (y + 0.5) / k_side)) {
        texels.push_back(static_cast<std::uint8_t>(std::lround(255 * level)));
      }
    }
  }
  return encoded_picture(k_side, std::move(texels), PictureCoding::png);
}

/// A torus wrapped in the whole picture: one chart, whose sides meet in two rings. Or with
/// `patches` patches per ring, each a chart: then the picture is repeated beyond its sides.
Mesh textured_torus(std::uint32_t patches = 0) {
  Mesh mesh = test::torus(k_rows, k_columns);
  for (Vec3& p : mesh.positions) p = rounded(p, PositionType::float32);
  for (std::uint32_t i = 0; i < k_rows; ++i) {
    for (std::uint32_t j = 0; j < k_columns; ++j) {
      const std::uint32_t turns = i * patches / k_rows + 2 * (j * patches / k_columns);
      const auto at = [turns](std::uint32_t row, std::uint32_t column) {
        return Uv{static_cast<float>(row) / k_rows + static_cast<float>(turns),
                  static_cast<float>(column) / k_columns};
      };
      mesh.columns.uvs.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.columns.uvs.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  mesh.columns.labels.assign(mesh.triangles.size(), 0);
  return mesh;
}

class Bench {
 public:
  explicit Bench(std::uint32_t patches = 0) {
    for (const char* each : {"1", "3"}) std::filesystem::create_directories(path(each));
    Material material{.name = "skin"};
    material.maps = {{MapUse::colour, 0}};
    const PictureFiles pictures{{"skin.png"}, [](std::size_t) { return picture(); }};
    write_mesh(path("in.obj"), textured_torus(patches), PositionType::float32, {}, {},
               LabelMeaning{"material", {material}}, pictures);
  }
  /// Replaces the torus as input.
  void write(const Mesh& mesh, const LabelMeaning& materials, const PictureFiles& pictures) const {
    write_mesh(path("in.obj"), mesh, PositionType::float32, {}, {}, materials, pictures);
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  Ran operator()(const std::vector<std::string>& words) {
    return test::run_meshfarm(words, folder_.path() / ("log" + std::to_string(++logs_)));
  }
  Ran simplify(const std::string& output, const std::vector<std::string>& more) {
    std::vector<std::string> words = {"simplify",   path("in.obj"), "-o",
                                      path(output), "--parts",      "5"};
    words.insert(words.end(), more.begin(), more.end());
    return (*this)(words);
  }
  /// The bytes of all files of a result.
  std::string bytes_of(const std::string& output) const {
    std::string all;
    std::vector<std::filesystem::path> files;
    const auto folder = std::filesystem::path(path(output)).parent_path();
    for (const auto& each : std::filesystem::directory_iterator(folder)) {
      if (each.is_regular_file()) files.push_back(each.path());
    }
    std::sort(files.begin(), files.end());
    for (const auto& file : files) all += file.filename().string() + "\n" + read_text(file);
    return all;
  }

 private:
  test::TempFolder folder_;
  int logs_ = 0;
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

struct Read {
  MeshFileInfo info;
  Mesh mesh;
};

Read read_textured(const std::string& path) {
  const auto source = open_mesh(path, {.textures = Textures::keep});
  Read read{source->info(), read_mesh(*source)};
  REQUIRE(read.info.uvs);
  REQUIRE(read.mesh.columns.uvs.size() == read.mesh.triangles.size());
  REQUIRE(read.info.pictures.names.size() == 1);
  return read;
}

/// Texture coordinates match the positions, and the seams are where they were.
void check_kept(const std::string& path, double most = 0.02) {
  const auto [info, mesh] = read_textured(path);
  CHECK(info.pictures.load(0) == picture());
  double worst = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const CornerUvs& uvs = mesh.columns.uvs[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [u, v] = angles_of(mesh.positions[mesh.triangles[i][k]]);
      worst = std::max({worst, apart(u, static_cast<double>(uvs[k][0])),
                        apart(v, static_cast<double>(uvs[k][1]))});
      // No triangle spans the picture from one side to the other.
      CHECK(std::abs(uvs[k][0] - uvs[(k + 1) % 3][0]) < 0.5F);
      CHECK(std::abs(uvs[k][1] - uvs[(k + 1) % 3][1]) < 0.5F);
    }
  }
  CHECK(worst < most);
}

/// PSNR over the corners and centres of all triangles.
double psnr_of(const Read& read) {
  const MaterialColours colours(*read.info.labels, read.info.pictures, {.name = "result"});
  double sum = 0;
  std::size_t values = 0;
  const auto add = [&](Label label, Uv uv, Vec3 p) {
    const auto [u, v] = angles_of(p);
    const std::array<double, 3> wanted = levels_at(u, v);
    const std::array<float, 3> seen = colours.at(label, uv, 1);
    for (std::size_t c = 0; c < 3; ++c) {
      const double miss = srgb_level(static_cast<double>(seen[c])) - wanted[c];
      sum += miss * miss;
      ++values;
    }
  };
  for (std::size_t i = 0; i < read.mesh.triangles.size(); ++i) {
    Vec3 centre{};
    Uv middle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Uv uv = read.mesh.columns.uvs[i][k];
      const Vec3 p = read.mesh.positions[read.mesh.triangles[i][k]];
      add(read.mesh.columns.labels[i], uv, p);
      centre = centre + p * (1.0 / 3);
      for (std::size_t axis = 0; axis < 2; ++axis) middle[axis] += uv[axis] / 3;
    }
    add(read.mesh.columns.labels[i], middle, centre);
  }
  return -10 * std::log10(sum / static_cast<double>(values));
}

}  // namespace

TEST_CASE("textures are kept, the same from any number of workers") {
  Bench bench;
  for (const std::string scheme : {"cut", "stream"}) {
    for (const std::string workers : {"1", "3"}) {
      const Ran ran = bench.simplify(workers + "/kept.obj",
                                     {"--ratio", "0.1", "--scheme", scheme, "--workers", workers});
      REQUIRE(ran.code == 0);
      CHECK(has(ran.out, "textures         kept: 1 picture"));
      CHECK(has(ran.out, "1,440"));
    }
    CHECK(bench.bytes_of("1/kept.obj") == bench.bytes_of("3/kept.obj"));
    check_kept(bench.path("1/kept.obj"));
    CHECK(psnr_of(read_textured(bench.path("1/kept.obj"))) > 28);
  }
}

TEST_CASE("a finish in pieces keeps textures, whose charts cross the pieces") {
  Bench bench;
  for (const std::string workers : {"1", "3"}) {
    const Ran ran = bench.simplify(
        workers + "/pieces.obj",
        {"--ratio", "0.3", "--finish", "farm", "--composition", "sink", "--workers", workers});
    REQUIRE(ran.code == 0);
    CHECK(has(ran.out, "finish           by jobs, in 6 pieces"));
    CHECK(has(ran.out, "textures         kept: 1 picture"));
    CHECK(has(ran.out, " 4,320 triangles"));
  }
  CHECK(bench.bytes_of("1/pieces.obj") == bench.bytes_of("3/pieces.obj"));
  check_kept(bench.path("1/pieces.obj"));
  CHECK(psnr_of(read_textured(bench.path("1/pieces.obj"))) > 28);
  const Ran baked = bench.simplify("b.obj", {"--ratio", "0.3", "--finish", "farm", "--uv", "bake"});
  CHECK(baked.code == 0);
  CHECK(has(baked.out, "by the sink: a new texture is laid out on the whole result"));
}

TEST_CASE("textures are kept by all formats that have a place for them") {
  Bench bench;
  REQUIRE(bench({"cut", bench.path("in.obj"), "--stage", bench.path("s")}).code == 0);
  for (const std::string name : {"kept.glb", "kept.gltf", "kept.ply"}) {
    const Ran ran = bench({"replay", bench.path("s"), "-o", bench.path(name), "--ratio", "0.1"});
    REQUIRE(ran.code == 0);
    check_kept(bench.path(name));
  }
  const Ran off = bench({"replay", bench.path("s"), "-o", bench.path("o.off"), "--ratio", "0.1"});
  CHECK(off.code == 0);
  CHECK(has(off.out, "textures         not kept"));
}

TEST_CASE("a new texture is baked where charts would not let the number of triangles be met") {
  Bench bench;
  for (const std::string scheme : {"cut", "stream"}) {
    for (const std::string workers : {"1", "3"}) {
      const Ran ran = bench.simplify(
          workers + "/baked.obj",
          {"--ratio", "0.03", "--scheme", scheme, "--uv", "bake", "--workers", workers});
      REQUIRE(ran.code == 0);
      CHECK(has(ran.out, "textures         a new picture of 256 x 256"));
    }
    CHECK(bench.bytes_of("1/baked.obj") == bench.bytes_of("3/baked.obj"));
    const Read read = read_textured(bench.path("1/baked.obj"));
    CHECK(read.mesh.triangles.size() == 432);
    CHECK(psnr_of(read) > 28);
  }
  const Ran sized =
      bench.simplify("o.glb", {"--triangles", "400", "--uv", "bake", "--texture-size", "512"});
  CHECK(sized.code == 0);
  CHECK(has(sized.out, "a new picture of 512 x 512"));
  CHECK(psnr_of(read_textured(bench.path("o.glb"))) > 28);
}

namespace {

double number_after(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  REQUIRE(at != std::string::npos);
  return std::stod(text.substr(at + words.size()));
}

}  // namespace

TEST_CASE("what becomes of textures is told before the work") {
  Bench bench(10);
  const Ran automatic = bench.simplify("a.obj", {"--triangles", "100"});
  CHECK(automatic.code == 0);
  CAPTURE(automatic.err);
  CHECK(
      has(automatic.err, "a new texture is made: keeping the charts of its textures needs about"));
  CHECK(read_textured(bench.path("a.obj")).mesh.triangles.size() == 100);
  const Ran kept = bench.simplify("k.obj", {"--triangles", "100", "--uv", "keep"});
  CHECK(kept.code == 0);
  CHECK(has(kept.err, "100 are asked for; --uv bake meets the requested number"));
  const auto left = static_cast<double>(read_textured(bench.path("k.obj")).mesh.triangles.size());
  CAPTURE(left);
  const double told = number_after(kept.err, "the charts of its textures needs about ");
  CHECK(told == doctest::Approx(left).epsilon(0.1));
  const Ran none = bench.simplify("n.obj", {"--triangles", "400", "--uv", "drop"});
  CHECK(none.code == 0);
  CHECK_FALSE(open_mesh(bench.path("n.obj"), {.textures = Textures::keep})->info().uvs);
  const Ran no_place = bench.simplify("o.stl", {"--triangles", "400", "--uv", "keep"});
  CHECK(no_place.code == 2);
  CHECK(has(no_place.err, "has no place for textures"));
  const Ran size = bench.simplify("o.obj", {"--triangles", "400", "--texture-size", "20000"});
  CHECK(size.code == 2);
  CHECK(has(size.err, "--texture-size: from 64 to 16384 pixels"));
}

namespace {

constexpr std::uint32_t k_width = 60;

/// A rough roof over a square, with its ridge along x = k_width / 2. The picture is projected from
/// above, in two charts that meet at y = k_width / 2.
Mesh textured_roof() {
  Mesh mesh = test::grid(k_width, k_width);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    Vec3& p = mesh.positions[v];
    const auto noise = static_cast<double>(static_cast<std::uint32_t>(v) * 2654435769U >> 24);
    p = rounded({p.x, p.y, 0.0003 * noise - std::abs(p.x - k_width / 2.0)}, PositionType::float32);
  }
  for (const Triangle& t : mesh.triangles) {
    const double y = mesh.positions[t[0]].y + mesh.positions[t[1]].y + mesh.positions[t[2]].y;
    const float chart = y > 3 * k_width / 2.0 ? 1 : 0;
    CornerUvs uvs{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.positions[t[k]];
      uvs[k] = {static_cast<float>(p.x) / k_width + chart, static_cast<float>(p.y) / k_width};
    }
    mesh.columns.uvs.push_back(uvs);
  }
  mesh.columns.labels.assign(mesh.triangles.size(), 0);
  return mesh;
}

void write_roof(const Bench& bench) {
  bench.write(textured_roof(), {"material", {{.name = "tiles", .maps = {{MapUse::colour, 0}}}}},
              {{"tiles.png"}, [](std::size_t) { return picture(); }});
}

/// Texture coordinates match the positions, in the chart of the triangle.
void check_roof(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    double y = 0;
    for (const std::uint32_t v : mesh.triangles[i]) y += mesh.positions[v].y;
    const double chart = y > 3 * k_width / 2.0 ? 1 : 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.positions[mesh.triangles[i][k]];
      const Uv uv = mesh.columns.uvs[i][k];
      CHECK(std::abs(static_cast<double>(uv[0]) - p.x / k_width - chart) < 0.002);
      CHECK(std::abs(static_cast<double>(uv[1]) - p.y / k_width) < 0.002);
    }
  }
}

}  // namespace

TEST_CASE("textures are kept within a bound of the error") {
  Bench bench;
  const Ran ran = bench.simplify("o.obj", {"--error", "0.5%", "--uv", "keep"});
  REQUIRE(ran.code == 0);
  check_kept(bench.path("o.obj"), 0.04);
  CHECK(read_textured(bench.path("o.obj")).mesh.triangles.size() < 3600);
  const Ran compared = bench({"compare", bench.path("in.obj"), bench.path("o.obj"), "--json"});
  REQUIRE(compared.code == 0);
  for (const std::string direction : {"\"a_to_b\"", "\"b_to_a\""}) {
    const std::string rest = compared.out.substr(compared.out.find(direction));
    CHECK(number_after(rest, "\"max\": ") < 0.0052);
  }
}

TEST_CASE("a run of a textured stage makes no texture that the output has no place for") {
  Bench bench;
  const std::string stage = bench.path("stage");
  REQUIRE(bench({"cut", bench.path("in.obj"), "--stage", stage}).code == 0);
  const Ran ran = bench({"replay", stage, "-o", bench.path("o.stl"), "--ratio", "0.03", "--uv",
                         "bake", "--workers", "1"});
  REQUIRE(ran.code == 0);
  CHECK_FALSE(has(ran.out, "a new picture"));
  CHECK(open_mesh(bench.path("o.stl"))->info().faces == 432);
}

TEST_CASE("textures are kept by a finish of the seams alone") {
  Bench bench;
  for (const std::string workers : {"1", "3"}) {
    const Ran ran = bench.simplify(
        workers + "/o.obj", {"--ratio", "0.15", "--finish", "boundary", "--allocation", "uniform",
                             "--uv", "keep", "--workers", workers});
    REQUIRE(ran.code == 0);
  }
  CHECK(bench.bytes_of("1/o.obj") == bench.bytes_of("3/o.obj"));
  check_kept(bench.path("1/o.obj"));
  const std::size_t triangles = read_textured(bench.path("1/o.obj")).mesh.triangles.size();
  CHECK(triangles > 1700);
  CHECK(triangles < 3000);
}

TEST_CASE("a textured border that is preserved keeps its vertices and their texture coordinates") {
  Bench bench;
  write_roof(bench);
  for (const std::string scheme : {"cut", "stream"}) {
    CAPTURE(scheme);
    const Ran ran = bench.simplify(
        "o.obj", {"--ratio", "0.1", "--preserve-border", "--uv", "keep", "--scheme", scheme});
    REQUIRE(ran.code == 0);
    const Mesh mesh = read_textured(bench.path("o.obj")).mesh;
    CHECK(mesh.triangles.size() == k_width * k_width / 5);
    check_roof(mesh);
    const auto on_border = [](Vec3 p) {
      return p.x == 0 || p.y == 0 || p.x == k_width || p.y == k_width;
    };
    CHECK(std::count_if(mesh.positions.begin(), mesh.positions.end(), on_border) == 4 * k_width);
  }
}

TEST_CASE("creases of a textured mesh stay where they are") {
  Bench bench;
  write_roof(bench);
  const Ran ran =
      bench.simplify("o.obj", {"--ratio", "0.05", "--crease-angle", "50", "--uv", "keep"});
  REQUIRE(ran.code == 0);
  const Mesh mesh = read_textured(bench.path("o.obj")).mesh;
  CHECK(mesh.triangles.size() == k_width * k_width / 10);
  check_roof(mesh);
  for (const Triangle& t : mesh.triangles) {
    bool left = false;
    bool right = false;
    for (const std::uint32_t v : t) {
      left = left || mesh.positions[v].x < k_width / 2.0;
      right = right || mesh.positions[v].x > k_width / 2.0;
    }
    CHECK_FALSE((left && right));
  }
}

TEST_CASE("pictures of other things than colours are named where the result has them no more") {
  Bench bench;
  Material material{.name = "skin"};
  material.maps = {{MapUse::colour, 0}, {MapUse::normal, 1}, {MapUse::emission, 1}};
  bench.write(textured_torus(), {"material", {material}},
              {{"skin.png", "more.png"}, [](std::size_t) { return picture(); }});
  const std::string maps = "not kept         pictures of normals, pictures of emission";
  const Ran baked = bench.simplify("o.obj", {"--ratio", "0.1", "--uv", "bake"});
  CHECK(baked.code == 0);
  CHECK(has(baked.out, maps + ": only colours are made anew\n"));
  const Ran kept = bench.simplify("o.glb", {"--ratio", "0.1", "--uv", "keep"});
  CHECK(kept.code == 0);
  CHECK_FALSE(has(kept.out, "not kept"));
  const Ran ply = bench.simplify("o.ply", {"--ratio", "0.1", "--uv", "keep"});
  CHECK(
      has(ply.out, "pictures of normals, pictures of emission: the output's format has no place"));
  const Ran json = bench.simplify("j.obj", {"--ratio", "0.1", "--uv", "bake", "--json"});
  CHECK(has(json.out, "\"pictures of emission\""));
}

TEST_CASE("a textured mesh goes through all formats and comes back as it was") {
  Bench bench(3);
  Mesh mesh = textured_torus(3);
  for (std::size_t i = mesh.triangles.size() / 2; i < mesh.triangles.size(); ++i) {
    mesh.columns.labels[i] = 1;
  }
  const std::array<std::string, 2> pictures = {
      picture(), encoded_picture(2, {9, 8, 7, 6, 5, 4, 3, 2, 1, 0, 1, 2}, PictureCoding::png)};
  bench.write(mesh,
              {"material",
               {{.name = "skin", .maps = {{MapUse::colour, 0}}},
                {.name = "back", .maps = {{MapUse::colour, 1}}}}},
              {{"skin.png", "back.png"}, [&](std::size_t i) { return pictures.at(i); }});
  const std::array<std::string, 4> names = {"in.obj", "a.glb", "b.ply", "c.obj"};
  for (std::size_t step = 1; step < names.size(); ++step) {
    CAPTURE(names[step]);
    std::vector<std::string> words = {"convert", bench.path(names[step - 1]),
                                      bench.path(names[step]), "-q"};
    if (step == 1) words.push_back("--plain");
    REQUIRE(bench(words).code == 0);
    const auto source = open_mesh(bench.path(names[step]), {.textures = Textures::keep});
    const MeshFileInfo& info = source->info();
    const Mesh made = read_mesh(*source);
    REQUIRE(made.triangles.size() == mesh.triangles.size());
    REQUIRE(made.columns.uvs.size() == mesh.triangles.size());
    std::array<std::string, 2> loaded;
    for (std::size_t i = 0; i < 2; ++i) {
      const Label label = made.columns.labels[i * (mesh.triangles.size() - 1)];
      loaded[i] = info.pictures.load(info.labels->materials.at(label).maps.at(0).picture);
    }
    CHECK(loaded == pictures);
    std::size_t moved = 0;
    double worst = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 was = mesh.positions[mesh.triangles[i][k]];
        moved += made.positions[made.triangles[i][k]] == was ? 0 : 1;
        for (std::size_t axis = 0; axis < 2; ++axis) {
          const auto change = static_cast<double>(made.columns.uvs[i][k][axis]) -
                              static_cast<double>(mesh.columns.uvs[i][k][axis]);
          worst = std::max(worst, std::abs(change));
        }
      }
    }
    CHECK(moved == 0);
    CHECK(worst < 1e-7);
  }
}
