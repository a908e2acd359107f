// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// What `meshfarm compare` reports about two files.
#include <algorithm>
#include <cmath>
#include <functional>

#include <doctest/doctest.h>

#include <meshfarm/io/mesh_format.hpp>

#include "support/meshes.hpp"
#include "support/process.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;
using test::Ran;

namespace {

const std::vector<Channel> k_channels = {{"red", ChannelType::uint8, ChannelRole::colour},
                                         {"green", ChannelType::uint8, ChannelRole::colour},
                                         {"blue", ChannelType::uint8, ChannelRole::colour},
                                         {"nx", ChannelType::float32, ChannelRole::normal},
                                         {"ny", ChannelType::float32, ChannelRole::normal},
                                         {"nz", ChannelType::float32, ChannelRole::normal},
                                         {"heat", ChannelType::float32, ChannelRole::quality}};

/// A vertex's colour grows linearly, by 4 levels per unit.
std::vector<float> values_at(Vec3 p) {
  const auto level = static_cast<float>(100 + 4 * p.x);
  return {level, level, static_cast<float>(4 * p.y), 0, 0, 1, static_cast<float>(p.x / 3)};
}

class Bench {
 public:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  /// A sheet of 24 x 24 units with values, in squares of this width.
  void write(const std::string& name, std::uint32_t width,
             const std::function<std::vector<float>(Vec3)>& value) const {
    Mesh mesh = test::grid(24 / width, 24 / width);
    std::vector<float> values;
    for (Vec3& p : mesh.positions) {
      p = p * width;
      const std::vector<float> here = value(p);
      values.insert(values.end(), here.begin(), here.end());
    }
    write_mesh(path(name), mesh, PositionType::float32, k_channels, values);
  }
  Ran compare(const std::string& a, const std::string& b,
              const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"compare", path(a), path(b), "--samples", "20000"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  Ran run(const std::vector<std::string>& words) {
    return test::run_meshfarm(words, folder_.path() / ("log" + std::to_string(++logs_)));
  }

 private:
  test::TempFolder folder_;
  int logs_ = 0;
};

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

double number_after(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  REQUIRE(at != std::string::npos);
  return std::stod(text.substr(at + words.size()));
}

}  // namespace

TEST_CASE("compare finds no difference between a linear picture on few triangles and on many") {
  Bench bench;
  bench.write("fine.ply", 1, values_at);
  bench.write("coarse.ply", 8, values_at);
  const Ran ran = bench.compare("fine.ply", "coarse.ply");
  CHECK(ran.code == 0);
  CHECK(number_after(ran.out, "colours A to B   PSNR ") > 120);
  CHECK(number_after(ran.out, "colours B to A   PSNR ") > 120);
  CHECK(number_after(ran.out, "normals A to B   mean ") < 1e-4);
  CHECK(number_after(ran.out, "heat A to B      rms ") < 1e-5);
  CHECK_FALSE(has(ran.out, "only"));
}

TEST_CASE("compare calls colours that are equal exact, not so many decibels") {
  Bench bench;
  bench.write("a.ply", 1, [](Vec3 p) {
    std::vector<float> values = values_at(p);
    values[0] = static_cast<float>((7 * static_cast<int>(p.x) + 11 * static_cast<int>(p.y)) % 256);
    return values;
  });
  const Ran text = bench.compare("a.ply", "a.ply");
  CHECK(has(text.out, "colours A to B   exact\n"));
  CHECK(has(text.out, "colours B to A   exact\n"));
  const Ran json = bench.compare("a.ply", "a.ply", {"--json"});
  CHECK(has(json.out, "\"psnr\": null"));
  CHECK_FALSE(has(json.out, "\"psnr\": 3"));
}

TEST_CASE("compare tells a difference that is the same everywhere as the formulas do") {
  Bench bench;
  const double turn = 20 * std::acos(-1.0) / 180;
  bench.write("a.ply", 1, values_at);
  bench.write("b.ply", 2, [&](Vec3 p) {
    std::vector<float> values = values_at(p);
    for (std::size_t i = 0; i < 3; ++i) values[i] += 8;
    values[4] = static_cast<float>(std::sin(turn));
    values[5] = static_cast<float>(std::cos(turn));
    values[6] += 0.25F;
    return values;
  });
  const double psnr = 20 * std::log10(255.0 / 8);
  const Ran text = bench.compare("a.ply", "b.ply");
  for (const std::string direction : {"A to B", "B to A"}) {
    CAPTURE(direction);
    CHECK(std::abs(number_after(text.out, "colours " + direction + "   PSNR ") - psnr) < 0.006);
    CHECK(number_after(text.out, "normals " + direction + "   mean ") ==
          doctest::Approx(20).epsilon(1e-3));
    CHECK(number_after(text.out, "heat " + direction + "      rms ") == doctest::Approx(0.25));
  }
  const Ran json = bench.compare("a.ply", "b.ply", {"--json"});
  CHECK(json.code == 0);
  CHECK(number_after(json.out, "\"psnr\": ") == doctest::Approx(psnr).epsilon(1e-5));
  CHECK(number_after(json.out, "\"mean_degrees\": ") == doctest::Approx(20).epsilon(1e-5));
  CHECK(number_after(json.out, "\"max_degrees\": ") == doctest::Approx(20).epsilon(1e-5));
  CHECK(has(json.out, "\"channels_not_compared\": null"));
}

TEST_CASE("compare reads the channels of all formats, and names what only one has") {
  Bench bench;
  bench.write("a.ply", 1, values_at);
  for (const std::string name : {"b.obj", "b.off", "b.glb"}) {
    CAPTURE(name);
    REQUIRE(bench.run({"convert", bench.path("a.ply"), bench.path(name), "-q"}).code == 0);
    const Ran ran = bench.compare("a.ply", name);
    CHECK(ran.code == 0);
    const bool are_exact = has(ran.out, "colours A to B   exact\n");
    CHECK((are_exact || number_after(ran.out, "colours A to B   PSNR ") > 120));
    const bool has_normals = name == "b.glb";
    CHECK(has(ran.out,
              has_normals ? "only A has       heat\n" : "only A has       nx, ny, nz, heat"));
    CHECK(has(ran.out, "normals A to B ") == has_normals);
    CHECK(has(bench.compare(name, "a.ply").out, "only B has "));
  }
}

TEST_CASE("compare has not a word about channels where there are none in both") {
  Bench bench;
  bench.write("a.ply", 1, values_at);
  REQUIRE(bench.run({"convert", bench.path("a.ply"), bench.path("b.stl"), "-q"}).code == 0);
  const Ran none = bench.compare("b.stl", "b.stl");
  CHECK(none.code == 0);
  CHECK_FALSE(has(none.out, "colours"));
  CHECK_FALSE(has(none.out, "channels"));
  CHECK_FALSE(has(none.out, "only"));
  // Channels that are not compared need no memory.
  const Ran little = bench.compare("b.stl", "a.ply", {"--memory", "10K"});
  CHECK(little.code == 0);
  CHECK_FALSE(has(little.out, "not compared"));
}

TEST_CASE("compare says in a line that channels do not fit into its memory, and what is enough") {
  Bench bench;
  bench.write("a.ply", 1, values_at);
  bench.write("b.ply", 2, values_at);
  const auto compare_in = [&](const std::string& memory) {
    return bench.compare("a.ply", "b.ply", {"--memory", memory});
  };
  const Ran full = compare_in("1M");
  CHECK(has(full.out, "PSNR"));
  // The distances, in memory or in slabs, do not need the channels.
  for (const std::string memory : {"130K", "30K"}) {
    CAPTURE(memory);
    const Ran little = compare_in(memory);
    CHECK(little.code == 0);
    CHECK(little.err.empty());
    CHECK_FALSE(has(little.out, "PSNR"));
    const std::string words = "channels         not compared: that takes --memory ";
    const auto enough = static_cast<int>(number_after(little.out, words));
    std::string line = words;
    line.append(std::to_string(enough)).append("K, and there is ").append(memory).append("\n");
    CHECK(has(little.out, line));
    CHECK(has(compare_in(std::to_string(enough) + "K").out, "PSNR"));
    CHECK_FALSE(has(compare_in(std::to_string(enough - 1) + "K").out, "PSNR"));
  }
  CHECK(has(bench.compare("a.ply", "b.ply", {"--memory", "30K", "--json"}).out,
            "\"channels_not_compared\": \"that takes"));
}

namespace {

/// A sheet of 24 x 24 units with label 5 left of x, and 9 right of it.
Mesh two_regions(double x) {
  Mesh mesh = test::grid(24, 24);
  for (const Triangle& t : mesh.triangles) {
    const double sum = mesh.positions[t[0]].x + mesh.positions[t[1]].x + mesh.positions[t[2]].x;
    mesh.columns.labels.push_back(sum < 3 * x ? 5 : 9);
  }
  return mesh;
}

}  // namespace

TEST_CASE("compare tells on which share of the area the labels differ") {
  Bench bench;
  const LabelMeaning region{"region", {}};
  write_mesh(bench.path("a.ply"), two_regions(12), PositionType::float32, {}, {}, region);
  write_mesh(bench.path("b.ply"), two_regions(15), PositionType::float32, {}, {}, region);
  const Ran same = bench.compare("a.ply", "a.ply");
  CHECK(has(same.out, "labels A to B    the same everywhere\n"));
  const Ran ran = bench.compare("a.ply", "b.ply");
  CHECK(number_after(ran.out, "labels A to B    another one on ") ==
        doctest::Approx(12.5).epsilon(0.02));
  CHECK(has(ran.out, " % of the area\n"));
  const Ran json = bench.compare("a.ply", "b.ply", {"--json"});
  CHECK(number_after(json.out, "\"other_b_to_a\": ") == doctest::Approx(0.125).epsilon(0.02));
  CHECK(has(json.out, "\"name_a\": \"region\""));
  CHECK(has(json.out, "\"labels_not_compared\": null"));
  // The same with label names, in another order, compared with numbers.
  for (const std::string name : {"b.obj", "b.glb"}) {
    CAPTURE(name);
    REQUIRE(bench.run({"convert", bench.path("b.ply"), bench.path(name), "-q"}).code == 0);
    CHECK(has(bench.compare("b.ply", name).out, "labels B to A    the same everywhere\n"));
    CHECK(has(bench.compare("a.ply", name).out, "labels B to A    another one on 12"));
  }
}

TEST_CASE("compare leaves labels out where one has none, or they do not fit into its memory") {
  Bench bench;
  write_mesh(bench.path("a.ply"), two_regions(12), PositionType::float32, {}, {},
             LabelMeaning{"region", {}});
  write_mesh(bench.path("b.ply"), test::grid(24, 24), PositionType::float32);
  const Ran one = bench.compare("a.ply", "b.ply");
  CHECK(one.code == 0);
  CHECK_FALSE(has(one.out, "labels"));
  CHECK(has(bench.compare("a.ply", "b.ply", {"--json"}).out, "\"labels\": null"));
  const Ran little = bench.compare("a.ply", "a.ply", {"--memory", "30K"});
  CHECK(little.code == 0);
  CHECK(has(little.out, "labels           not compared: that takes --memory "));
  CHECK_FALSE(has(little.out, "channels"));
}

namespace {

/// Two closed spheres of 1,280 triangles each, `apart` from each other.
Mesh two_spheres(double apart) {
  Mesh mesh = test::icosphere(3);
  Mesh other = test::icosphere(3);
  for (Vec3& p : other.positions) p.x += apart;
  test::append(mesh, other);
  return mesh;
}

}  // namespace

TEST_CASE("compare tells sizes, angles and crossings of both meshes, and how they are turned") {
  Bench bench;
  Mesh doubled = two_spheres(3);
  for (Vec3& p : doubled.positions) p = p * 2;
  write_mesh(bench.path("a.ply"), two_spheres(3), PositionType::float64);
  write_mesh(bench.path("b.ply"), doubled, PositionType::float64);
  write_mesh(bench.path("c.ply"), two_spheres(1.1), PositionType::float64);
  const Ran text = bench.compare("a.ply", "b.ply");
  CHECK(text.code == 0);
  CHECK(has(text.out, "border 0 long, edges over 40 degrees 0 long\n"));
  CHECK(has(text.out, "                 0 triangles cut or touch others\n"));
  CHECK(has(text.out, "B against A      area +300 %, volume +700 %\n"));
  CHECK(has(text.out, "facing B to A    rms "));
  CHECK_FALSE(has(text.out, "not measured"));
  const Ran json = bench.compare("a.ply", "b.ply", {"--json"});
  const double area = 8 * std::acos(-1.0);
  CHECK(number_after(json.out, "\"area\": ") == doctest::Approx(area).epsilon(0.01));
  CHECK(number_after(json.out, "\"volume\": ") == doctest::Approx(area / 3).epsilon(0.02));
  CHECK(number_after(json.out, "\"smallest_angle_p1_degrees\": ") > 50);
  CHECK(number_after(json.out, "\"area_change_percent\": ") == doctest::Approx(300));
  CHECK(number_after(json.out, "\"volume_change_percent\": ") == doctest::Approx(700));
  CHECK(number_after(json.out, "\"p95\": ") > number_after(json.out, "\"mean\": "));
  CHECK(number_after(json.out, "\"p99\": ") >= number_after(json.out, "\"p95\": "));
  CHECK(number_after(json.out, "\"p95_degrees\": ") > 0);
  CHECK(has(json.out, "\"crossing_triangles\": 0,"));
  CHECK(has(json.out, "\"not_measured\": null"));
  CHECK(bench.compare("a.ply", "b.ply", {"--json", "--threads", "1"}).out == json.out);
  const Ran info = bench.run({"info", bench.path("a.ply"), "--figures", "--json"});
  CHECK(number_after(info.out, "\"area\": ") == number_after(json.out, "\"area\": "));
  CHECK(number_after(info.out, "\"handles\": ") == 0);
  CHECK(has(info.out, "\"crossing_triangles\": 0,"));
  const Ran small = bench.run({"info", bench.path("a.ply"), "--figures", "--memory", "64K"});
  CHECK(has(small.out, "area "));
  CHECK(has(small.out, "lengths of edges, crossings: that takes --memory "));
  const Ran crossing = bench.compare("c.ply", "c.ply");
  const std::size_t end = crossing.out.find(" triangles cut or touch others");
  REQUIRE(end != std::string::npos);
  CHECK(std::stoi(crossing.out.substr(crossing.out.rfind(' ', end - 1))) > 50);
}

TEST_CASE("compare gives no volume where a mesh is not closed") {
  Bench bench;
  write_mesh(bench.path("a.ply"), test::icosphere(2), PositionType::float32);
  write_mesh(bench.path("b.ply"), test::grid(24, 24), PositionType::float32);
  const Ran text = bench.compare("a.ply", "b.ply");
  CHECK(has(text.out, "area 576, no volume: not closed, border 96 long"));
  CHECK_FALSE(has(text.out, " %, volume"));
  const Ran json = bench.compare("a.ply", "b.ply", {"--json"});
  CHECK(has(json.out, "\"volume\": null"));
  CHECK(has(json.out, "\"volume_change_percent\": null"));
}

TEST_CASE("compare writes a map of the distances, with a number and a colour at each vertex") {
  Bench bench;
  Mesh sheet = test::grid(24, 24);
  write_mesh(bench.path("a.ply"), sheet, PositionType::float32);
  for (Vec3& p : sheet.positions) p.z = p.x / 8;
  write_mesh(bench.path("b.ply"), sheet, PositionType::float32);
  const Ran ran = bench.compare("a.ply", "b.ply", {"--map", bench.path("map.ply"), "--json"});
  REQUIRE(ran.code == 0);
  CHECK(has(ran.out, "\"greatest\": 3.0"));
  const auto map = open_mesh(bench.path("map.ply"));
  REQUIRE(map->info().channels.size() == 4);
  CHECK(map->info().channels[0].name == "quality");
  std::size_t seen = 0;
  map->scan_channels([&](const ChannelPoints& batch) {
    for (std::size_t i = 0; i < batch.points.size(); ++i, ++seen) {
      const float* values = &batch.values[4 * i];
      CHECK(values[0] == doctest::Approx(batch.points[i].x / 8));
      const bool is_farthest = batch.points[i].x == 24;
      if (is_farthest) CHECK((values[1] > 240 && values[2] > 220));  // yellow
      if (values[0] == 0) CHECK(values[1] < 70);                     // dark blue
    }
  });
  CHECK(seen == sheet.positions.size());

  const Ran small =
      bench.compare("a.ply", "b.ply", {"--map", bench.path("no.ply"), "--memory", "64K"});
  CHECK(small.code == 2);
  CHECK(has(small.err, "--map"));
  CHECK(bench.compare("a.ply", "b.ply", {"--map", bench.path("map.xyz")}).code == 1);
  for (const char* const input : {"a.ply", "b.ply"}) {
    const Ran over = bench.compare("a.ply", "b.ply", {"--map", bench.path(input)});
    CHECK(over.code == 2);
    CHECK(has(over.err, "would write over the input"));
  }
}

TEST_CASE("compare bounds the greatest distances over all points, where that is asked for") {
  Bench bench;
  // A slot that the lid's vertices do not reveal: in its middle the lid is 3 from the sheet.
  Mesh sheet = test::grid(24, 24);
  std::erase_if(sheet.triangles, [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(), [&](std::uint32_t v) {
      return sheet.positions[v].x >= 9 && sheet.positions[v].x <= 15;
    });
  });
  Mesh lid = test::grid(1, 1);
  for (Vec3& p : lid.positions) p = p * 24;
  // A degenerate triangle has no surface, so it is not far from anything.
  lid.positions.push_back({0, 0, 100});
  lid.triangles.push_back({4, 4, 4});
  write_mesh(bench.path("a.ply"), sheet, PositionType::float32);
  write_mesh(bench.path("b.ply"), lid, PositionType::float32);
  const Ran plain = bench.compare("a.ply", "b.ply", {"--json"});
  CHECK(has(plain.out, "\"certified\": null"));
  const Ran json = bench.compare("a.ply", "b.ply", {"--json", "--certify"});
  REQUIRE(json.code == 0);
  const std::string bounds = json.out.substr(json.out.find("\"certified\": {"));
  const std::string back = bounds.substr(bounds.find("\"b_to_a\""));
  const double diagonal = 24 * std::sqrt(2.0);
  CHECK(number_after(bounds, "\"at_most\": ") < 2e-5);  // A to B comes first
  CHECK(number_after(back, "\"at_least\": ") <= 3 / diagonal);
  CHECK(number_after(back, "\"at_most\": ") >= 3 / diagonal);
  CHECK(number_after(back, "\"at_most\": ") <= 3.04 / diagonal);
  const Ran text = bench.compare("a.ply", "b.ply", {"--certify"});
  CHECK(has(text.out, "certified B to A max from 0.08"));
  const Ran small = bench.compare("a.ply", "b.ply", {"--certify", "--memory", "64K"});
  CHECK(small.code == 2);
  CHECK(has(small.err, "--certify: that takes --memory "));
}

TEST_CASE("compare says what it leaves out of meshes that do not fit into its memory") {
  Bench bench;
  write_mesh(bench.path("a.ply"), two_spheres(3), PositionType::float32);
  const Ran held = bench.compare("a.ply", "a.ply", {"--json"});
  const Ran little = bench.compare("a.ply", "a.ply", {"--json", "--memory", "30K"});
  CHECK(little.code == 0);
  for (const std::string name : {"area", "volume", "smallest_angle_p1_degrees"}) {
    const std::string words = "\"" + name + "\": ";
    CHECK(number_after(little.out, words) == doctest::Approx(number_after(held.out, words)));
  }
  CHECK(has(little.out, "\"normals\": null"));
  CHECK(has(little.out, "\"border_length\": null"));
  CHECK(has(little.out, "\"feature_length\": null"));
  CHECK(has(little.out, "\"crossing_triangles\": null"));
  CHECK(has(little.out, "\"not_measured\": \"that takes --memory "));
  CHECK(has(bench.compare("a.ply", "a.ply", {"--memory", "30K"}).out,
            "not measured     normals, lengths of edges, crossings: that takes --memory "));
}
