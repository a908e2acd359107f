// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/bundle_list.hpp"

using namespace meshfarm;

namespace {

/// Bundles of `blocks` blocks, each with something of each of `parts` parts.
BundlesOfMesh make_bundles(std::uint32_t blocks, std::uint32_t parts) {
  BundlesOfMesh bundles{PositionType::float64, parts, {}, {}};
  for (std::uint32_t b = 0; b < blocks; ++b) {
    VertexBundleRef vertices{{"results/v" + std::to_string(b), 100, b}, {{1, 2, 3}, {}, {}, b}};
    TriangleBundleRef triangles{{"results/t" + std::to_string(b), 200, b}, {}};
    triangles.bundle.vertices = {7, 8, b};
    triangles.bundle.groups = 1U << (b % 24);
    vertices.bundle.parts.emplace();
    triangles.bundle.parts.emplace();
    for (std::uint32_t p = 0; p < parts; ++p) {
      vertices.bundle.parts->push_back({p, b + 1});
      triangles.bundle.parts->push_back(p);
    }
    bundles.vertices.push_back(vertices);
    bundles.triangles.push_back(triangles);
  }
  return bundles;
}

BundlesOfMesh again(const BundlesOfMesh& bundles) {
  ByteWriter out;
  put_bundles(out, bundles);
  const std::string bytes = out.take();
  CHECK(bytes.size() < k_max_parameters_bytes);
  ByteReader in(bytes, "bundles");
  const BundlesOfMesh read = get_bundles(in);
  in.expect_end();
  return read;
}

}  // namespace

TEST_CASE("bundles come back as they were, with what they have") {
  const BundlesOfMesh bundles = make_bundles(3, 4);
  const BundlesOfMesh read = again(bundles);
  CHECK(read.positions == PositionType::float64);
  CHECK(read.parts == 4);
  REQUIRE(read.vertices.size() == 3);
  REQUIRE(read.triangles.size() == 3);
  CHECK(read.vertices[2].file == bundles.vertices[2].file);
  CHECK(read.vertices[2].bundle.merged == 2);
  CHECK(read.vertices[2].bundle.parts == bundles.vertices[2].bundle.parts);
  CHECK(read.triangles[1].bundle.parts == bundles.triangles[1].bundle.parts);
  CHECK(read.triangles[1].bundle.groups == 2);
  CHECK(read.triangles[1].bundle.vertices == bundles.triangles[1].bundle.vertices);
}

TEST_CASE("what bundles have is left out where there is no room for it") {
  const BundlesOfMesh many = again(make_bundles(144, 1'500));
  REQUIRE(many.vertices.size() == 144);
  CHECK_FALSE(many.vertices[0].bundle.parts);
  CHECK_FALSE(many.triangles[143].bundle.parts);

  const VertexBundle large = make_bundles(1, 5'000).vertices[0].bundle;
  const std::string summary = encode_summary(large);
  CHECK(summary.size() < k_max_summary_bytes);
  CHECK_FALSE(decode_vertex_bundle(summary, "summary").parts);
  const TriangleBundle fits = make_bundles(1, 2'000).triangles[0].bundle;
  CHECK(encode_summary(fits).size() < k_max_summary_bytes);
  CHECK(decode_triangle_bundle(encode_summary(fits), "summary").parts == fits.parts);
}

TEST_CASE("bundles are chosen by what they have, or may have") {
  BundlesOfMesh all = make_bundles(3, 0);
  all.parts = 8;
  all.vertices[0].bundle.parts = {{2, 10}, {5, 1}};
  all.vertices[1].bundle.parts.reset();
  all.triangles[1].bundle.parts = {3, 4};
  const BundlesOfMesh some = bundles_of_parts(all, {4, 6});
  CHECK(some.parts == 8);
  REQUIRE(some.vertices.size() == 2);
  CHECK(some.vertices[0].file == all.vertices[0].file);
  CHECK(some.vertices[1].file == all.vertices[1].file);
  CHECK_FALSE(some.vertices[0].bundle.parts);
  REQUIRE(some.triangles.size() == 1);
  CHECK(some.triangles[0].file == all.triangles[1].file);
  CHECK(bundles_of_parts(all, {3, 3}).triangles.empty());
  const BundlesOfMesh of_group = bundles_of_group(all, 2);
  CHECK(of_group.vertices.empty());
  REQUIRE(of_group.triangles.size() == 1);
  CHECK(of_group.triangles[0].file == all.triangles[2].file);
}

TEST_CASE("a summary with parts in no order is refused") {
  TriangleBundle bundle;
  bundle.parts = {3, 3};
  CHECK_THROWS_AS(decode_triangle_bundle(encode_summary(bundle), "summary"), DataError);
  std::string summary = encode_summary(TriangleBundle{});
  summary.back() = 2;  // neither told nor not
  CHECK_THROWS_AS(decode_triangle_bundle(summary, "summary"), DataError);
}
