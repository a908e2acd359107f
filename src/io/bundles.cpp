// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <meshfarm/io/bundles.hpp>

namespace meshfarm {

BundlesOfMesh bundles_of_parts(const BundlesOfMesh& all, PartRange parts) {
  const auto is_wanted = [&](std::uint32_t part) {
    return parts.first <= part && part < parts.end;
  };
  BundlesOfMesh some{all.positions, all.parts, {}, {}};
  for (VertexBundleRef each : all.vertices) {
    const bool has =
        !each.bundle.parts ||
        std::any_of(each.bundle.parts->begin(), each.bundle.parts->end(),
                    [&](const VertexBundle::OfPart& of) { return is_wanted(of.part); });
    each.bundle.parts.reset();
    if (has) some.vertices.push_back(std::move(each));
  }
  for (TriangleBundleRef each : all.triangles) {
    const bool has = !each.bundle.parts ||
                     std::any_of(each.bundle.parts->begin(), each.bundle.parts->end(), is_wanted);
    each.bundle.parts.reset();
    if (has) some.triangles.push_back(std::move(each));
  }
  return some;
}

BundlesOfMesh bundles_of_group(const BundlesOfMesh& all, std::uint32_t group) {
  BundlesOfMesh some{all.positions, all.parts, {}, {}};
  for (TriangleBundleRef each : all.triangles) {
    each.bundle.parts.reset();
    if ((each.bundle.groups >> group & 1) != 0) some.triangles.push_back(std::move(each));
  }
  return some;
}

}  // namespace meshfarm
