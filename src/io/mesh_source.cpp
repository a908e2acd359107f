// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {

Mesh read_mesh(MeshSource& source) {
  if (source.info().vertices > UINT32_MAX) {
    throw DataError("a mesh of " + std::to_string(source.info().vertices) +
                    " vertices is too large to be read into memory: the limit is " +
                    std::to_string(UINT32_MAX));
  }
  Mesh mesh;
  if (source.info().compression == "none") {  // else the counts are only the header's claim
    mesh.positions.reserve(source.info().vertices);
    mesh.triangles.reserve(source.info().faces);
  }
  PositionType positions{};
  do {
    positions = source.info().positions;
    mesh.positions.clear();
    source.scan_vertices([&mesh](std::span<const Vec3> batch) {
      mesh.positions.insert(mesh.positions.end(), batch.begin(), batch.end());
    });
  } while (source.info().positions != positions);
  const auto lacks = [&mesh](std::uint64_t v) { return !has_position(mesh.positions[v]); };
  source.scan_triangles([&](const TriangleView& batch) {
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const WideTriangle& triangle = batch.corners[i];
      if (std::any_of(triangle.begin(), triangle.end(), lacks)) continue;
      mesh.columns.append(batch.columns, i);
      mesh.triangles.push_back({static_cast<std::uint32_t>(triangle[0]),
                                static_cast<std::uint32_t>(triangle[1]),
                                static_cast<std::uint32_t>(triangle[2])});
    }
  });
  return mesh;
}

bool has_appearances(const MeshSource& source) {
  return !AppearanceColumns(source.info().channels).empty();
}

void scan_appearances(MeshSource& source, const std::function<void(const VertexView&)>& take) {
  const AppearanceColumns columns(source.info().channels);
  if (columns.empty()) return source.scan_vertices(take);
  const std::size_t channels = source.info().channels.size();
  std::vector<Appearance> appearances;
  source.scan_channels([&](const ChannelPoints& batch) {
    appearances.clear();
    const std::span<const float> values(batch.values);
    for (std::size_t i = 0; i < batch.points.size(); ++i) {
      appearances.push_back(columns.of(values.subspan(i * channels, channels)));
    }
    take({batch.points, appearances});
  });
}

}  // namespace meshfarm
