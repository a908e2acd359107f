// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <meshfarm/io/bundles.hpp>

namespace meshfarm {
namespace {

template <class T>
bool may_have_some(const std::optional<std::vector<T>>& told, PartRange parts) {
  if (!told) return true;
  const auto at =
      std::lower_bound(told->begin(), told->end(), parts.first,
                       [](const T& of, std::uint32_t wanted) { return part_of(of) < wanted; });
  return at != told->end() && part_of(*at) < parts.end;
}

VertexBundleRef untold(const VertexBundleRef& ref) {
  const VertexBundle& b = ref.bundle;
  return {ref.file, {b.directory, b.runs, b.crowds, b.merged}};
}

TriangleBundleRef untold(const TriangleBundleRef& ref) {
  const TriangleBundle& b = ref.bundle;
  return {
      ref.file,
      {b.directory, b.seams, b.seam_triangles, b.dropped, b.points_left_out, b.vertices, b.groups}};
}

}  // namespace

BundlesOfMesh bundles_of_parts(const BundlesOfMesh& all, PartRange parts) {
  BundlesOfMesh some{all.positions, all.parts, {}, {}};
  for (const VertexBundleRef& each : all.vertices) {
    if (may_have_some(each.bundle.parts, parts)) some.vertices.push_back(untold(each));
  }
  for (const TriangleBundleRef& each : all.triangles) {
    if (may_have_some(each.bundle.parts, parts)) some.triangles.push_back(untold(each));
  }
  return some;
}

BundlesOfMesh bundles_of_group(const BundlesOfMesh& all, std::uint32_t group) {
  BundlesOfMesh some{all.positions, all.parts, {}, {}};
  for (const TriangleBundleRef& each : all.triangles) {
    if ((each.bundle.groups >> group & 1) != 0) some.triangles.push_back(untold(each));
  }
  return some;
}

}  // namespace meshfarm
