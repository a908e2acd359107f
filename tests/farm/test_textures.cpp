// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Textures, from input to output of real runs.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <string_view>

#include <doctest/doctest.h>

#include <meshfarm/io/mesh_source.hpp>

#include "support/process.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;
using test::Ran;
namespace fs = std::filesystem;

namespace {

/// One texel: 255, 128, 0.
constexpr std::string_view k_orange(
    "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\0\1\0\0\0\1\x08\2\0\0\0\x90\x77\x53\xde"
    "\0\0\0\x0cIDAT\x78\x9c\x63\xf8\xdf\xc0\0\0\4\1\1\x80\xc5\x2a\x18\x5d"
    "\0\0\0\0IEND\xae\x42\x60\x82",
    69);

class Model {
 public:
  /// A hilly grid, with texture coordinates.
  Model() {
    constexpr int k_side = 60;
    std::ofstream obj(path("m.obj"));
    obj << "mtllib m.mtl\nusemtl skin\n";
    for (int y = 0; y < k_side; ++y) {
      for (int x = 0; x < k_side; ++x) {
        obj << "v " << x << " " << y << " " << 0.1 * ((x * x + 3 * y) % 7) << "\n";
        obj << "vt " << x / 60.0 << " " << y / 60.0 << "\n";
      }
    }
    for (int y = 1; y < k_side; ++y) {
      for (int x = 1; x < k_side; ++x) {
        const int a = (y - 1) * k_side + x;
        for (const auto& [i, k] :
             {std::array{a + 1, a + k_side + 1}, {a + k_side + 1, a + k_side}}) {
          obj << "f " << a << "/" << a << " " << i << "/" << i << " " << k << "/" << k << "\n";
        }
      }
    }
    std::ofstream(path("m.mtl")) << "newmtl skin\nmap_Kd skin.png\n";
    std::ofstream(path("skin.png"), std::ios::binary) << k_orange;
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  Ran run(const std::vector<std::string>& words) {
    return test::run_meshfarm(words, folder_ / ("log" + std::to_string(++logs_)));
  }

 private:
  test::TempFolder folder_;
  int logs_ = 0;
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The greatest error of red, green and blue in a summary.
double errors_of_channels(const std::string& summary) {
  static const std::regex line(R"(channels +red ([^ ,]+), green ([^ ,]+), blue ([^ ,]+) )");
  std::smatch found;
  if (!std::regex_search(summary, found, line)) return HUGE_VAL;
  return std::max({std::stod(found[1]), std::stod(found[2]), std::stod(found[3])});
}

/// Whether all vertices have the colour of that one texel.
bool is_orange(const std::string& path) {
  const auto source = open_mesh(path);
  if (source->info().channels.size() != 3) return false;
  std::uint64_t vertices = 0;
  bool are_all = true;
  source->scan_channels([&](const ChannelPoints& batch) {
    vertices += batch.points.size();
    for (std::size_t i = 0; i < batch.values.size(); i += 3) {
      const std::array<long, 3> levels{std::lround(batch.values[i]),
                                       std::lround(batch.values[i + 1]),
                                       std::lround(batch.values[i + 2])};
      are_all = are_all && levels == std::array<long, 3>{255, 128, 0};
    }
  });
  return are_all && vertices == source->info().vertices && vertices > 0;
}

}  // namespace

TEST_CASE("a textured OBJ comes back coloured, by either scheme and as any format") {
  Model model;
  for (const std::string scheme : {"cut", "stream"}) {
    const std::string output = model.path(scheme + ".glb");
    const Ran ran = model.run({"simplify", model.path("m.obj"), "-o", output, "--ratio", "0.1",
                               "--workers", "1", "--scheme", scheme, "--uv", "colours"});
    CHECK(ran.code == 0);
    CHECK(has(ran.err, "the vertices' colours are of the textures skin.png (1 x 1)"));
    CHECK(errors_of_channels(ran.out) < 1e-6);  // the rounding of floats
    CHECK(is_orange(output));
  }
  const Ran ran =
      model.run({"convert", model.path("m.obj"), model.path("m.ply"), "--uv", "colours"});
  CHECK(ran.code == 0);
  CHECK(has(ran.err, "skin.png (1 x 1)"));
  CHECK(is_orange(model.path("m.ply")));
  const Ran compared = model.run({"compare", model.path("m.obj"), model.path("cut.glb")});
  CHECK(compared.code == 0);
  CAPTURE(compared.out);
  const std::string psnr = "colours A to B   PSNR ";
  const std::size_t at = compared.out.find(psnr);
  // Equal up to the rounding of floats.
  CHECK((has(compared.out, "colours A to B   exact\n") ||
         (at != std::string::npos && std::stod(compared.out.substr(at + psnr.size())) > 120)));
  const Ran info = model.run({"info", model.path("m.obj"), "--no-topology"});
  CHECK(has(info.out, "textures         skin.png (1 x 1)"));
}

TEST_CASE("textures are left out where that is asked for, or there is no place for colours") {
  Model model;
  const std::vector<std::string> words = {
      "simplify", model.path("m.obj"), "-o", model.path("o.ply"), "--ratio",
      "0.1",      "--workers",         "1"};
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--uv", "drop"}, {"--attributes", "none"}}) {
    std::vector<std::string> all = words;
    all.insert(all.end(), more.begin(), more.end());
    const Ran ran = model.run(all);
    CHECK(ran.code == 0);
    CHECK_FALSE(has(ran.err, "skin.png"));
    CHECK(has(ran.out, "texture coordinates (3600)"));
    CHECK(open_mesh(model.path("o.ply"))->info().channels.empty());
  }
  const Ran ran = model.run({"convert", model.path("m.obj"), model.path("m.stl")});
  CHECK(ran.code == 0);
  CHECK_FALSE(has(ran.err, "skin.png"));
  CHECK(model.run({"convert", model.path("m.obj"), model.path("m.ply"), "--uv", "drop"}).code == 0);
  CHECK(open_mesh(model.path("m.ply"))->info().channels.empty());
}

TEST_CASE("a picture that is not there is told, and the mesh is made without it") {
  Model model;
  fs::remove(model.path("skin.png"));
  const Ran ran = model.run({"simplify", model.path("m.obj"), "-o", model.path("o.ply"), "--ratio",
                             "0.1", "--workers", "1", "--uv", "colours"});
  CHECK(ran.code == 0);
  CHECK(has(ran.err, "the texture skin.png: no such file"));
  CHECK(open_mesh(model.path("o.ply"))->info().channels.empty());
  fs::remove(model.path("m.mtl"));
  const Ran without =
      model.run({"convert", model.path("m.obj"), model.path("o.obj"), "--uv", "colours"});
  CHECK(without.code == 0);
  CHECK(has(without.err, "the material library 'm.mtl' is not beside it"));
}

TEST_CASE("a stage that was cut with textures is not one without") {
  Model model;
  CHECK(model.run({"cut", model.path("m.obj"), "--stage", model.path("s")}).code == 0);
  const Ran other =
      model.run({"cut", model.path("m.obj"), "--stage", model.path("s"), "--uv", "drop"});
  CHECK(other.code == 1);
  CHECK(has(other.err, "other options"));
}

TEST_CASE("texture coordinates without a picture go where their charts cannot be kept") {
  Model model;
  constexpr int k_side = 40;
  std::ofstream ply(model.path("m.ply"));
  ply << "ply\nformat ascii 1.0\nelement vertex " << k_side * k_side
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
      << (k_side - 1) * (k_side - 1)
      << "\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
         "property uchar material_index\nend_header\n";
  for (int i = 0; i < k_side * k_side; ++i) {
    ply << i % k_side << " " << i / k_side << " " << 0.1 * (i * i % 11) << "\n";
  }
  // Each square is a chart of its own.
  for (int y = 1; y < k_side; ++y) {
    for (int x = 1; x < k_side; ++x) {
      const int a = y * k_side + x;
      ply << "4 " << a - k_side - 1 << " " << a - k_side << " " << a << " " << a - 1
          << " 8 0 0 0.5 0 0.5 0.5 0 0.5 " << x * 3 / k_side << "\n";
    }
  }
  ply.close();
  for (const std::string uv : {"auto", "bake"}) {
    const Ran ran = model.run({"simplify", model.path("m.ply"), "-o", model.path(uv + ".ply"),
                               "--ratio", "0.1", "--workers", "1", "--uv", uv});
    CHECK(ran.code == 0);
    CHECK(has(ran.err, "it has no pictures to make a new one of"));
    CHECK(has(ran.out, "textures         not kept"));
    CHECK(has(ran.out, "labels           material_index: numbers"));
  }
}
