// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/bundle_list.hpp"

#include <algorithm>
#include <utility>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/staging/file_ref.hpp>
#include <meshfarm/util/byte_lists.hpp>

namespace meshfarm {
namespace {

/// A summary has room for twice as much, parameters for nearly three times as much.
constexpr std::size_t k_most_told_of_one = 8'192;
constexpr std::size_t k_most_told_of_all = 98'304;

template <class T>
std::size_t bytes_of_told(const std::optional<std::vector<T>>& parts) {
  return parts ? parts->size() * sizeof(T) : 0;
}

template <class T>
void put_told(ByteWriter& out, const std::optional<std::vector<T>>& parts, bool tells) {
  const bool told = parts && tells;
  out.put(static_cast<std::uint8_t>(told ? 1 : 0));
  if (told) put_list(out, *parts);
}

template <class T>
std::optional<std::vector<T>> get_told(ByteReader& in) {
  const auto told = in.get<std::uint8_t>();
  if (told > 1) in.fail("neither told nor not");
  if (told == 0) return std::nullopt;
  std::vector<T> parts = get_list<T>(in);
  const auto not_after = [](const T& a, const T& b) { return part_of(b) <= part_of(a); };
  if (std::adjacent_find(parts.begin(), parts.end(), not_after) != parts.end()) {
    in.fail("parts in no order");
  }
  return parts;
}

void put_bundle(ByteWriter& out, const VertexBundle& bundle, bool tells) {
  out.put(bundle.directory);
  out.put(bundle.runs);
  out.put(bundle.crowds);
  out.put(bundle.merged);
  put_told(out, bundle.parts, tells);
}

VertexBundle get_vertex_bundle(ByteReader& in) {
  VertexBundle bundle;
  bundle.directory = in.get<FileSection>();
  bundle.runs = in.get<FileSection>();
  bundle.crowds = in.get<FileSection>();
  bundle.merged = in.get<std::uint64_t>();
  bundle.parts = get_told<VertexBundle::OfPart>(in);
  return bundle;
}

void put_bundle(ByteWriter& out, const TriangleBundle& bundle, bool tells) {
  out.put(bundle.directory);
  out.put(bundle.seams);
  out.put(bundle.seam_triangles);
  out.put(bundle.dropped);
  out.put(bundle.points_left_out);
  out.put(bundle.vertices);
  out.put(bundle.groups);
  put_told(out, bundle.parts, tells);
}

TriangleBundle get_triangle_bundle(ByteReader& in) {
  TriangleBundle bundle;
  bundle.directory = in.get<FileSection>();
  bundle.seams = in.get<FileSection>();
  bundle.seam_triangles = in.get<std::uint64_t>();
  bundle.dropped = in.get<std::uint64_t>();
  bundle.points_left_out = in.get<std::uint64_t>();
  bundle.vertices = in.get<FileSection>();
  bundle.groups = in.get<std::uint32_t>();
  bundle.parts = get_told<std::uint32_t>(in);
  return bundle;
}

std::uint32_t get_count(ByteReader& in) {
  const auto count = in.get<std::uint32_t>();
  if (count > k_most_cut_blocks) in.fail("too many bundles");
  return count;
}

}  // namespace

void put_bundles(ByteWriter& out, const BundlesOfMesh& bundles) {
  std::size_t told = 0;
  for (const VertexBundleRef& each : bundles.vertices) told += bytes_of_told(each.bundle.parts);
  for (const TriangleBundleRef& each : bundles.triangles) told += bytes_of_told(each.bundle.parts);
  const bool tells = told <= k_most_told_of_all;
  out.put(bundles.positions);
  out.put(bundles.parts);
  out.put(static_cast<std::uint32_t>(bundles.vertices.size()));
  for (const VertexBundleRef& each : bundles.vertices) {
    put_file(out, each.file);
    put_bundle(out, each.bundle, tells);
  }
  out.put(static_cast<std::uint32_t>(bundles.triangles.size()));
  for (const TriangleBundleRef& each : bundles.triangles) {
    put_file(out, each.file);
    put_bundle(out, each.bundle, tells);
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
  put_bundle(out, bundle, bytes_of_told(bundle.parts) <= k_most_told_of_one);
  return out.take();
}

std::string encode_summary(const TriangleBundle& bundle) {
  ByteWriter out;
  put_bundle(out, bundle, bytes_of_told(bundle.parts) <= k_most_told_of_one);
  return out.take();
}

VertexBundle decode_vertex_bundle(std::string_view summary, std::string_view what) {
  ByteReader in(summary, what);
  VertexBundle bundle = get_vertex_bundle(in);
  in.expect_end();
  return bundle;
}

TriangleBundle decode_triangle_bundle(std::string_view summary, std::string_view what) {
  ByteReader in(summary, what);
  TriangleBundle bundle = get_triangle_bundle(in);
  in.expect_end();
  return bundle;
}

}  // namespace meshfarm
