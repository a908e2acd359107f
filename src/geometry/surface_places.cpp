// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cassert>

#include <meshfarm/geometry/channel_fit.hpp>
#include <meshfarm/geometry/surface_places.hpp>

#include "geometry/bvh.hpp"

namespace meshfarm {

class SurfacePlaces::Impl {
 public:
  Impl(const Mesh& mesh, const SurfacePlacesOptions& options)
      : mesh_(mesh), squared_reach_(options.reach * options.reach), bvh_(mesh, options.threads) {}

  SurfacePlace find(Vec3 point, Vec3 normal, std::uint32_t guess) const {
    Bvh::Nearest found = bvh_.nearest(point, guess);
    if (!faces(found.triangle, normal) && squared_length(normal) > 0) {
      const Bvh::Nearest facing = bvh_.nearest_facing(point, normal, guess, squared_reach_);
      if (facing.squared < std::numeric_limits<double>::infinity()) found = facing;
    }
    const auto [a, b, c] = mesh_.triangles[found.triangle];
    return {found.triangle,
            nearest_shares(point, mesh_.positions[a], mesh_.positions[b], mesh_.positions[c]),
            found.squared};
  }

 private:
  bool faces(std::uint32_t triangle, Vec3 normal) const {
    const auto [a, b, c] = mesh_.triangles[triangle];
    const Vec3 p = mesh_.positions[a];
    return dot(cross(mesh_.positions[b] - p, mesh_.positions[c] - p), normal) > 0;
  }

  const Mesh& mesh_;
  double squared_reach_;
  Bvh bvh_;
};

SurfacePlaces::SurfacePlaces(const Mesh& mesh, const SurfacePlacesOptions& options)
    : impl_(std::make_unique<Impl>(mesh, options)) {}
SurfacePlaces::~SurfacePlaces() = default;
SurfacePlaces::SurfacePlaces(SurfacePlaces&&) noexcept = default;

SurfacePlace SurfacePlaces::find(Vec3 point, Vec3 normal, std::uint32_t guess) const {
  return impl_->find(point, normal, guess);
}

void SurfacePlaces::find(std::span<const Vec3> points, std::span<const Vec3> normals,
                         std::span<SurfacePlace> places) const {
  assert(points.size() == normals.size() && points.size() == places.size());
  std::uint32_t guess = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    places[i] = impl_->find(points[i], normals[i], guess);
    guess = places[i].triangle;
  }
}

}  // namespace meshfarm
