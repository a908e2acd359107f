// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/report/run_page.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

#include "report/page_html.hpp"
#include "support/meshes.hpp"

namespace meshfarm {
namespace {

bool page_has(const std::string& text, std::string_view what) {
  return text.find(what) != std::string::npos;
}

const char* const k_summary = R"({"run": "00000000000000aa", "epoch": 1,
  "output": {"path": "out/small.ply", "triangles": 120, "vertices": 62},
  "topology": "kept",
  "topology_change": {
    "input": {"components": 2, "handles": 1, "closed": true, "border_edges": 0,
              "nonmanifold_edges": null},
    "output": {"components": 1, "handles": 1, "closed": true, "border_edges": 0,
               "nonmanifold_edges": 0}},
  "error": {"rms": 0.001, "max": 0.01, "input_to_output": {"rms": 0.001},
            "output_to_input": {"rms": 0.0005}},
  "warning": "too <few> triangles",
  "seconds": {"cut": 1, "farm": 2, "stitch": 0.5, "finish": 0.25, "measure": 0.25, "write": 0}})";

RunPage some_page() {
  RunPage page;
  page.manifest.input = "in/large <mesh>.ply";
  page.manifest.input_triangles = 12'000;
  page.manifest.box.add({0, 0, 0});
  page.manifest.box.add({3, 4, 0});
  page.summary = k_summary;
  page.command = "meshfarm simplify 'a & b'";
  return page;
}

PageScene some_scene() {
  const PagePicture picture{"a picture", 4, 3};
  PageScene scene;
  scene.views = {{"from the front", picture, picture}, {"from behind", picture, picture}};
  scene.zoom = {"at a place", picture, picture};
  scene.parts = scene.map = picture;
  scene.model = "a model";
  scene.scale = {{0, 0, 32}, {255, 255, 0}};
  return scene;
}

PageFigures some_figures() {
  PageFigures figures;
  figures.samples = 1234;
  figures.histogram = {0.5, {0.75, 0.25}, 0.01};
  figures.input.shape = {.area = 10, .volume = 4};
  figures.result.shape = {.area = 9, .volume = 3};
  figures.result.edges = EdgeLengths{1, 2};
  return figures;
}

std::size_t count_of(const std::string& text, std::string_view what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
    ++count;
  }
  return count;
}

TEST_CASE("bytes become base64") {
  CHECK(base64("") == "");
  CHECK(base64("M") == "TQ==");
  CHECK(base64("Ma") == "TWE=");
  CHECK(base64("Man") == "TWFu");
  CHECK(base64(std::string("\xff\x00\xfe", 3)) == "/wD+");
}

TEST_CASE("a page of a run without pictures has its figures and times") {
  const std::string page = render_run_page(some_page());
  CHECK(page_has(page, "<title>large &lt;mesh&gt;.ply → small.ply</title>"));
  CHECK(page_has(page, "too &lt;few&gt; triangles"));
  CHECK(page_has(page, "<pre>meshfarm simplify 'a &amp; b'</pre>"));
  CHECK(page_has(page, "<b>12,000</b>"));
  CHECK(page_has(page, "<b>4 s</b>"));
  CHECK(page_has(page, "<td>pieces</td><td>2</td><td>1</td><td>−1</td>"));
  CHECK_FALSE(page_has(page, "<img"));
  CHECK_FALSE(page_has(page, "<script"));
}

TEST_CASE("a bound that is proven is told as one, and one that is not is none") {
  RunPage run = some_page();
  CHECK_FALSE(page_has(render_run_page(run), "proven"));
  const std::string rest = run.summary.substr(1);
  run.summary = R"({"bound": {"kind": "sampled", "max": 0.011},)" + rest;
  CHECK_FALSE(page_has(render_run_page(run), "proven"));
  run.summary = R"({"bound": {"kind": "certified", "max": 0.012},)" + rest;
  const std::string page = render_run_page(run);
  CHECK(page_has(page, "proven to be within 0.012 everywhere"));
  CHECK(page_has(page, "<td>proven for every point</td><td>≤ 0.012</td><td>≤ 0.012</td>"));
}

TEST_CASE("what a run counted of its result need not be counted again") {
  CHECK_FALSE(parse_run_result(k_summary, "it").crossing_triangles);
  const std::string rest = std::string(k_summary).substr(1);
  CHECK(parse_run_result(R"({"surface": {"crossing_triangles": 7},)" + rest, "it")
            .crossing_triangles == 7U);
  CHECK_FALSE(parse_run_result(R"({"surface": {"crossing_triangles": null},)" + rest, "it")
                  .crossing_triangles);
}

TEST_CASE("a page with pictures loads nothing") {
  RunPage run = some_page();
  run.scene = some_scene();
  run.figures = some_figures();
  const std::string page = render_run_page(run);
  CHECK(count_of(page, "<img ") == 8);
  CHECK(count_of(page, "src=\"data:image/png;base64,YSBwaWN0dXJl\"") == 8);
  CHECK(count_of(page, "src=") == 8);
  CHECK_FALSE(page_has(page, "@import"));
  CHECK_FALSE(page_has(page, "url("));
  CHECK_FALSE(page_has(page, "<link"));
  CHECK(count_of(page, "http:") == count_of(page, "http://www.w3.org/2000/svg"));
  CHECK(page_has(page, "<td>volume</td><td>4</td><td>3</td><td>−25 %</td>"));
  CHECK(page_has(page, base64("a model")));
  CHECK(render_run_page(run) == page);
  run.scene->model.clear();
  CHECK_FALSE(page_has(render_run_page(run), "<script"));
}

TEST_CASE("a run that has not ended is said to be so") {
  RunPage run = some_page();
  run.summary.clear();
  CHECK(page_has(render_run_page(run), "This run has not ended"));
  CHECK_THROWS_AS(parse_run_result("{}", "it"), DataError);
  CHECK(parse_run_result(k_summary, "it").path == "out/small.ply");
}

TEST_CASE("a model holds each triangle, as the page reads it") {
  const Mesh mesh = test::icosphere(2);
  const std::vector<float> values(mesh.positions.size(), 0.5F);
  const std::string bytes = encode_model(mesh, values);
  ByteReader in(bytes, "the model");
  CHECK(in.get<std::uint32_t>() == mesh.positions.size());
  CHECK(in.get<std::uint32_t>() == mesh.triangles.size());
  const auto largest = static_cast<double>(in.get<float>());
  CHECK(largest == doctest::Approx(2).epsilon(0.02));
  in.take(3 * sizeof(float));
  const auto vertices = in.get_array<std::uint16_t>(4 * mesh.positions.size());
  CHECK(vertices[3] == 32768);
  std::uint32_t next = 0;
  double area = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::vector<Vec3> corners;
    for (int k = 0; k < 3; ++k) {
      std::uint32_t back = 0;
      for (unsigned shift = 0;; shift += 7) {
        const auto byte = in.get<std::uint8_t>();
        back |= (byte & 127U) << shift;
        if (byte < 128) break;
      }
      const std::uint32_t vertex = next - back;
      if (back == 0) ++next;
      const double side = largest / 65535;
      corners.push_back({vertices[4 * vertex] * side, vertices[4 * vertex + 1] * side,
                         vertices[4 * vertex + 2] * side});
    }
    area += length(cross(corners[1] - corners[0], corners[2] - corners[0])) / 2;
  }
  in.expect_end();
  CHECK(next == mesh.positions.size());
  CHECK(area == doctest::Approx(4 * 3.14159).epsilon(0.06));
}

}  // namespace
}  // namespace meshfarm
