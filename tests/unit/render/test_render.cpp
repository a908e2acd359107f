// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <doctest/doctest.h>

#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/render/render.hpp>
#include <meshfarm/util/errors.hpp>

#include "render/colours.hpp"
#include "support/memory_source.hpp"
#include "support/meshes.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

/// A mesh whose vertices have one value per channel.
class ValuedSource : public test::MemorySource {
 public:
  ValuedSource(const Mesh& mesh, std::vector<Channel> channels, std::vector<float> values)
      : MemorySource(mesh), points_{mesh.positions, std::move(values)} {
    info_.channels = std::move(channels);
  }
  void scan_channels(const std::function<void(const ChannelPoints&)>& take) override {
    take(points_);
  }

 private:
  ChannelPoints points_;
};

RenderOptions small_front() {
  RenderOptions options;
  options.width = 200;
  options.height = 200;
  options.view = {.projection = Projection::orthographic, .azimuth = 0, .elevation = 0};
  options.threads = 1;
  return options;
}

Rendering rendered(const Mesh& mesh, const RenderOptions& options) {
  test::MemorySource source(mesh);
  return render_mesh(source, options);
}

Srgb colour_at(Texels& picture, std::uint32_t x, std::uint32_t y) {
  const std::uint8_t* texel = picture.at(x, y);
  return {texel[0], texel[1], texel[2]};
}

/// A square of half width `half` that faces the front.
void add_square(Mesh& mesh, double half, double z) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    mesh.positions.push_back({half * x, half * y, z});
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

/// The colours of at least `at_least` pixels each: more than edges have.
std::set<Srgb> main_colours(Texels picture, std::size_t at_least = 1000) {
  std::map<Srgb, std::size_t> pixels;
  for (std::uint32_t y = 0; y < picture.height; ++y) {
    for (std::uint32_t x = 0; x < picture.width; ++x) ++pixels[colour_at(picture, x, y)];
  }
  std::set<Srgb> main;
  for (const auto& [colour, count] : pixels) {
    if (count >= at_least) main.insert(colour);
  }
  return main;
}

}  // namespace

TEST_CASE("a sphere's outline has a circle's area, and its shading is that of the lamps") {
  RenderOptions options = small_front();
  options.width = options.height = 400;
  options.transparent = true;
  Rendering made = rendered(test::icosphere(6), options);
  CHECK(made.triangles == 81'920);
  const double radius = 0.94 * 200;
  double area = 0, difference = 0, pixels = 0;
  for (std::uint32_t y = 0; y < 400; ++y) {
    for (std::uint32_t x = 0; x < 400; ++x) {
      area += made.picture.at(x, y)[3] / 255.0;
      const double nx = (x + 0.5 - 200) / radius, ny = (200 - y - 0.5) / radius;
      const double squared = nx * nx + ny * ny;
      if (squared > 0.95) continue;
      const float light = light_on({nx, ny, std::sqrt(1 - squared)});
      const Srgb expected = srgb_of(light_of(k_clay) * light);
      difference += std::abs(int{expected[0]} - int{made.picture.at(x, y)[0]});
      ++pixels;
    }
  }
  CHECK(area == doctest::Approx(std::numbers::pi * radius * radius).epsilon(0.01));
  CHECK(difference / pixels < 0.01 * 255);
}

TEST_CASE("what is nearer covers what is behind it, from both sides and in both projections") {
  Mesh mesh;
  add_square(mesh, 1, 0);
  add_square(mesh, 0.5, 0.4);
  mesh.columns.labels = {0, 0, 1, 1};
  for (const Projection projection : {Projection::orthographic, Projection::perspective}) {
    RenderOptions options = small_front();
    options.colour_by = ColourBy::label;
    options.view.projection = projection;
    Rendering front = rendered(mesh, options);
    const Srgb large = colour_at(front.picture, 20, 100), small = colour_at(front.picture, 90, 110);
    CHECK(large[2] > large[0]);  // the first colour is blue, the second orange
    CHECK(small[0] > small[2]);
    options.view.azimuth = 180;
    Rendering back = rendered(mesh, options);
    const Srgb behind = colour_at(back.picture, 90, 110);
    CHECK(behind[2] > behind[0]);
    std::reverse(mesh.triangles.begin(), mesh.triangles.end());
    std::reverse(mesh.columns.labels.begin(), mesh.columns.labels.end());
    CHECK(rendered(mesh, options).picture.bytes == back.picture.bytes);
    options.view.azimuth = 0;
    CHECK(rendered(mesh, options).picture.bytes == front.picture.bytes);
  }
}

TEST_CASE("a closed surface has no holes between its triangles") {
  RenderOptions options = small_front();
  options.transparent = true;
  options.samples = 1;
  Rendering made = rendered(in_memory(*generate_mesh(Shape::block, 4000)), options);
  std::uint64_t holes = 0;
  for (std::uint32_t y = 1; y < 199; ++y) {
    for (std::uint32_t x = 1; x < 199; ++x) {
      const auto covered = [&](std::uint32_t u, std::uint32_t v) {
        return made.picture.at(u, v)[3] != 0;
      };
      const bool is_within =
          covered(x - 1, y) && covered(x + 1, y) && covered(x, y - 1) && covered(x, y + 1);
      if (is_within && !covered(x, y)) ++holes;
    }
  }
  CHECK(holes == 0);
}

TEST_CASE("threads, memory and the order of triangles make no difference") {
  const test::TempFolder folder;
  Mesh mesh = in_memory(*generate_mesh(Shape::dust, 150'000));
  RenderOptions options = small_front();
  options.folder = folder.path();
  for (const ColourBy by : {ColourBy::none, ColourBy::piece, ColourBy::height}) {
    CAPTURE(static_cast<int>(by));
    options.colour_by = by;
    options.memory_bytes = std::uint64_t{512} << 20;
    options.threads = 1;
    const Rendering first = rendered(mesh, options);
    for (const unsigned threads : {2U, 5U}) {
      options.threads = threads;
      CHECK(rendered(mesh, options).picture.bytes == first.picture.bytes);
    }
    options.memory_bytes = 1'800'000;  // the canvas takes 1.28 MB, and vertices 0.9 MB
    CHECK(rendered(mesh, options).picture.bytes == first.picture.bytes);
    options.folder = folder / "none";
    CHECK_THROWS_AS(rendered(mesh, options), IoError);
    options.folder = folder.path();
    CHECK(first.pieces == (by == ColourBy::piece ? rendered(mesh, options).pieces : 0));
  }
  options.colour_by = ColourBy::none;
  const Rendering first = rendered(mesh, options);
  std::reverse(mesh.triangles.begin(), mesh.triangles.end());
  CHECK(rendered(mesh, options).picture.bytes == first.picture.bytes);
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("two pieces have two colours, and single triangles that touch are one piece") {
  Mesh mesh;
  add_square(mesh, 1, 0);
  add_square(mesh, 1, 0);
  for (std::size_t i = 4; i < 8; ++i) mesh.positions[i].x += 3;
  RenderOptions options = small_front();
  options.colour_by = ColourBy::piece;
  const Rendering two = rendered(mesh, options);
  CHECK(two.pieces == 2);
  CHECK(main_colours(two.picture).size() == 3);  // with the background
  for (std::size_t i = 4; i < 8; ++i) mesh.positions[i].x -= 1;
  const Rendering one = rendered(mesh, options);
  CHECK(one.pieces == 1);
  CHECK(main_colours(one.picture).size() == 2);
}

TEST_CASE("vertices' colours are blended over triangles, and drawn where nothing else is asked") {
  Mesh mesh;
  add_square(mesh, 1, 0);
  const std::vector<Channel> channels = {{"red", ChannelType::uint8, ChannelRole::colour},
                                         {"green", ChannelType::uint8, ChannelRole::colour},
                                         {"blue", ChannelType::uint8, ChannelRole::colour}};
  // Red on the left, blue on the right.
  ValuedSource source(mesh, channels, {255, 0, 0, 0, 0, 255, 0, 0, 255, 255, 0, 0});
  RenderOptions options = small_front();
  Rendering made = render_mesh(source, options);
  CHECK(made.colours == "colour");
  const Srgb left = colour_at(made.picture, 8, 100), right = colour_at(made.picture, 191, 100),
             middle = colour_at(made.picture, 100, 60);
  CHECK(left[0] > 150);
  CHECK(left[2] < 70);
  CHECK(right[2] > 150);
  CHECK(std::abs(int{middle[0]} - int{middle[2]}) < 4);
  options.colour_by = ColourBy::none;
  made = render_mesh(source, options);
  CHECK(made.colours.empty());
  CHECK(main_colours(made.picture).size() == 2);
}

TEST_CASE("a number is coloured by its scale, with a legend beside the mesh") {
  Mesh mesh;
  add_square(mesh, 1, 0);
  const std::vector<Channel> channels = {{"heat", ChannelType::float32, ChannelRole::quality}};
  ValuedSource source(mesh, channels, {10, 20, 20, 10});
  RenderOptions options = small_front();
  options.colour_by = ColourBy::quality;
  Rendering made = render_mesh(source, options);
  CHECK(made.colours == "heat");
  REQUIRE(made.range.has_value());
  CHECK(*made.range == std::array<double, 2>{10, 20});
  CHECK(main_colours(made.picture, 20).size() > 10);
  options.colour_by = ColourBy::channel;
  options.channel = "heat";
  CHECK(render_mesh(source, options).picture.bytes == made.picture.bytes);
  options.range = {{20, 30}};  // everything is at its lower end
  made = render_mesh(source, options);
  CHECK(main_colours(made.picture).size() == 2);
  ValuedSource without(mesh, channels, {NAN, NAN, NAN, NAN});
  options.range.reset();
  CHECK_THROWS_AS(render_mesh(without, options), DataError);
}

TEST_CASE("edges are drawn where triangles are large, and not where they would hide them") {
  Mesh mesh;
  add_square(mesh, 1, 0);
  RenderOptions options = small_front();
  Rendering plain = rendered(mesh, options);
  options.wire = true;
  Rendering wired = rendered(mesh, options);
  // The diagonal from the lower left to the upper right.
  CHECK(colour_at(wired.picture, 100, 99)[0] < colour_at(plain.picture, 100, 99)[0] * 2 / 3);
  CHECK(colour_at(wired.picture, 60, 60) == colour_at(plain.picture, 60, 60));
  const Mesh fine = in_memory(*generate_mesh(Shape::torus, 400'000));
  wired = rendered(fine, options);
  options.wire = false;
  CHECK(wired.picture.bytes == rendered(fine, options).picture.bytes);
}

TEST_CASE("hollows are darker than what stands free") {
  Mesh corner;
  add_square(corner, 1, 0);
  RenderOptions options = small_front();
  Rendering alone = rendered(corner, options);
  const Srgb free = colour_at(alone.picture, 55, 100);
  // A step on its right half.
  corner.positions.insert(corner.positions.end(),
                          {{0.1, -1, 0.1}, {1, -1, 0.1}, {1, 1, 0.1}, {0.1, 1, 0.1}});
  corner.triangles.push_back({4, 5, 6});
  corner.triangles.push_back({4, 6, 7});
  Rendering made = rendered(corner, options);
  CHECK(colour_at(made.picture, 106, 100)[0] + 8 < free[0]);
  CHECK(std::abs(int{colour_at(made.picture, 55, 100)[0]} - int{free[0]}) < 3);
}

TEST_CASE("what lies under no sample, at infinity or nowhere is left out and counted") {
  Mesh mesh = test::icosphere(2);
  const Rendering whole = rendered(mesh, small_front());
  mesh.positions.push_back(k_no_position);
  mesh.triangles.push_back({0, 1, 162});
  mesh.triangles.push_back({0, 0, 1});
  const Rendering made = rendered(mesh, small_front());
  CHECK(made.not_finite == 1);
  CHECK(made.picture.bytes == whole.picture.bytes);
}

TEST_CASE("a source that fails on the way ends the drawing, whatever the threads are at") {
  class Failing : public test::MemorySource {
   public:
    using MemorySource::MemorySource;
    void scan_triangles(const std::function<void(const TriangleView&)>& take) override {
      for (int i = 0; i < 4; ++i) MemorySource::scan_triangles(take);
      throw DataError("truncated");
    }
  };
  Failing source(test::icosphere(6));
  RenderOptions options = small_front();
  for (const unsigned threads : {1U, 5U}) {
    options.threads = threads;
    CHECK_THROWS_WITH_AS(render_mesh(source, options), "truncated", DataError);
  }
}

TEST_CASE("what cannot be drawn is an error that names the mesh") {
  RenderOptions options = small_front();
  options.name = "a.ply";
  CHECK_THROWS_WITH_AS(rendered({{{0, 0, 0}}, {}}, options), "a.ply: has no triangles to draw",
                       DataError);
  CHECK_THROWS_WITH_AS(rendered({}, options), "a.ply: has no vertex with a position", DataError);
  for (const ColourBy by : {ColourBy::colour, ColourBy::label, ColourBy::quality}) {
    options.colour_by = by;
    CHECK_THROWS_AS(rendered(test::icosphere(1), options), DataError);
  }
  options.colour_by = ColourBy::channel;
  options.channel = "heat";
  CHECK_THROWS_WITH_AS(rendered(test::icosphere(1), options),
                       "a.ply: has no channel 'heat' to be coloured by; its vertices have "
                       "positions only",
                       DataError);
  options = small_front();
  options.memory_bytes = 1'000'000;
  CHECK_THROWS_AS(rendered(test::icosphere(1), options), UsageError);
}
