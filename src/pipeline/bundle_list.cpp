// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/bundle_list.hpp"

#include <utility>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/staging/file_ref.hpp>

namespace meshfarm {
namespace {

void put_bundle(ByteWriter& out, const VertexBundle& bundle) {
  out.put(bundle.directory);
  out.put(bundle.runs);
  out.put(bundle.crowds);
  out.put(bundle.merged);
}

VertexBundle get_vertex_bundle(ByteReader& in) {
  VertexBundle bundle;
  bundle.directory = in.get<FileSection>();
  bundle.runs = in.get<FileSection>();
  bundle.crowds = in.get<FileSection>();
  bundle.merged = in.get<std::uint64_t>();
  return bundle;
}

void put_bundle(ByteWriter& out, const TriangleBundle& bundle) {
  out.put(bundle.directory);
  out.put(bundle.seams);
  out.put(bundle.seam_triangles);
  out.put(bundle.dropped);
  out.put(bundle.points_left_out);
}

TriangleBundle get_triangle_bundle(ByteReader& in) {
  TriangleBundle bundle;
  bundle.directory = in.get<FileSection>();
  bundle.seams = in.get<FileSection>();
  bundle.seam_triangles = in.get<std::uint64_t>();
  bundle.dropped = in.get<std::uint64_t>();
  bundle.points_left_out = in.get<std::uint64_t>();
  return bundle;
}

std::uint32_t get_count(ByteReader& in) {
  const auto count = in.get<std::uint32_t>();
  if (count > k_most_cut_blocks) in.fail("too many bundles");
  return count;
}

}  // namespace

void put_bundles(ByteWriter& out, const BundlesOfMesh& bundles) {
  out.put(bundles.positions);
  out.put(bundles.parts);
  out.put(static_cast<std::uint32_t>(bundles.vertices.size()));
  for (const VertexBundleRef& each : bundles.vertices) {
    put_file(out, each.file);
    put_bundle(out, each.bundle);
  }
  out.put(static_cast<std::uint32_t>(bundles.triangles.size()));
  for (const TriangleBundleRef& each : bundles.triangles) {
    put_file(out, each.file);
    put_bundle(out, each.bundle);
  }
}

BundlesOfMesh get_bundles(ByteReader& in) {
  constexpr std::uint32_t k_most_parts = 1'000'000;
  BundlesOfMesh bundles;
  bundles.positions = in.get<PositionType>();
  if (bundles.positions != PositionType::float32 && bundles.positions != PositionType::float64) {
    in.fail("unknown kind of positions");
  }
  bundles.parts = in.get<std::uint32_t>();
  if (bundles.parts > k_most_parts) in.fail("too many parts");
  const std::uint32_t vertices = get_count(in);
  for (std::uint32_t i = 0; i < vertices; ++i) {
    FileRef file = get_file(in);
    bundles.vertices.push_back({std::move(file), get_vertex_bundle(in)});
  }
  const std::uint32_t triangles = get_count(in);
  for (std::uint32_t i = 0; i < triangles; ++i) {
    FileRef file = get_file(in);
    bundles.triangles.push_back({std::move(file), get_triangle_bundle(in)});
  }
  return bundles;
}

std::string encode_summary(const VertexBundle& bundle) {
  ByteWriter out;
  put_bundle(out, bundle);
  return out.take();
}

std::string encode_summary(const TriangleBundle& bundle) {
  ByteWriter out;
  put_bundle(out, bundle);
  return out.take();
}

VertexBundle decode_vertex_bundle(std::string_view summary, std::string_view what) {
  ByteReader in(summary, what);
  const VertexBundle bundle = get_vertex_bundle(in);
  in.expect_end();
  return bundle;
}

TriangleBundle decode_triangle_bundle(std::string_view summary, std::string_view what) {
  ByteReader in(summary, what);
  const TriangleBundle bundle = get_triangle_bundle(in);
  in.expect_end();
  return bundle;
}

}  // namespace meshfarm
