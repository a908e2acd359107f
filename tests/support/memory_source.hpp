// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <utility>

#include <meshfarm/io/mesh_source.hpp>

namespace meshfarm::test {

/// A mesh in memory, served like a file, in small batches.
class MemorySource : public MeshSource {
 public:
  explicit MemorySource(Mesh mesh, PositionType positions = PositionType::float64)
      : mesh_(std::move(mesh)) {
    info_.format = "memory";
    info_.compression = "none";
    info_.vertices = mesh_.positions.size();
    info_.faces = mesh_.triangles.size();
    info_.positions = positions;
    if (!mesh_.columns.labels.empty()) info_.labels = LabelMeaning{"region", {}};
    info_.uvs = !mesh_.columns.uvs.empty();
  }
  const MeshFileInfo& info() const override { return info_; }
  void scan_vertices(const std::function<void(std::span<const Vec3>)>& take) override {
    const std::span<const Vec3> all(mesh_.positions);
    for (std::size_t i = 0; i < all.size(); i += k_batch) {
      take(all.subspan(i, std::min(k_batch, all.size() - i)));
    }
  }
  void scan_triangles(const std::function<void(const TriangleView&)>& take) override {
    std::vector<WideTriangle> all;
    for (const Triangle& t : mesh_.triangles) all.push_back({t[0], t[1], t[2]});
    const TriangleView triangles(all, mesh_.columns);
    for (std::size_t i = 0; i < all.size(); i += k_batch) {
      take(triangles.part(i, std::min(k_batch, all.size() - i)));
    }
  }

 private:
  static constexpr std::size_t k_batch = 100;
  Mesh mesh_;

 protected:
  MeshFileInfo info_;
};

}  // namespace meshfarm::test
