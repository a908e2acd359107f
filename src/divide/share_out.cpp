// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/share_out.hpp"

#include <algorithm>
#include <utility>

namespace meshfarm {

VertexSurvey survey_vertices(MeshSource& source, OrderProbe* probe, const ScanProgress& tell) {
  VertexSurvey found;
  do {
    found = {};
    found.positions = source.info().positions;
    if (probe != nullptr) *probe = {};
    source.scan_vertices([&](std::span<const Vec3> batch) {
      for (const Vec3& p : batch) {
        found.box.add(p);
        found.not_finite += has_position(p) ? 0 : 1;
      }
      if (probe != nullptr) probe->look_at(batch);
      found.vertices += batch.size();
      if (tell) tell("bounding box", found.vertices, source.info().vertices);
    });
  } while (source.info().positions != found.positions);
  return found;
}

std::uint64_t likely_triangles(const MeshFileInfo& info) {
  // Polygons and strips hold more triangles than the header says: vertices are a second hint.
  return std::max(info.faces, info.vertices);
}

std::uint32_t settle(ShareMap& map, MeshSource& source, std::uint64_t vertices,
                     const ScanProgress& tell) {
  do {
    std::uint64_t done = 0;
    source.scan_vertices([&](std::span<const Vec3> batch) {
      map.count(batch);
      done += batch.size();
      if (tell) tell(map.name(), done, vertices);
    });
  } while (map.refine());
  return map.divide();
}

SharedMesh share_out(MeshSource& source, std::unique_ptr<ShareMap> map,
                     const MeshShares::Options& options, const ScanProgress& tell) {
  SharedMesh made{std::make_unique<MeshShares>(options), 0};
  ShareTargets targets;
  std::uint64_t done = 0;
  const auto add_vertices = [&](const VertexView& batch) {
    map->find_targets(batch.positions, targets);
    made.shares->add_vertices(batch, targets.shares, targets.points);
    done += batch.size();
    if (tell) tell("vertices", done, options.vertices);
  };
  options.appearances ? scan_appearances(source, add_vertices) : source.scan_vertices(add_vertices);
  map.reset();  // it may be large
  source.scan_triangles([&](const TriangleView& batch) {
    made.shares->add_triangles(batch);
    made.triangles += batch.size();
    if (tell) tell("triangles", made.triangles, source.info().faces);
  });
  made.shares->finish();
  return made;
}

}  // namespace meshfarm
