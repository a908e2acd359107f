// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "geometry/generate/generate_grid.hpp"
#include "geometry/generate/generate_noise.hpp"

namespace meshfarm {

/// The grid of well-shaped cells on the bumpy torus.
Grid torus_grid(std::uint64_t cells);

/// The surface of the bumpy torus, one ring of the tube at a time. Each ring is star-shaped about
/// its own centre and stays on its own side of the axis. So, whatever the bumps, the surface cannot
/// intersect itself, nor the same surface with another `thickness`.
class TorusRings {
 public:
  explicit TorusRings(std::uint64_t columns);
  /// Adds the ring at `turn` round the axis, in doubles; `thickness` scales it about its centre.
  void add_ring(double turn, double thickness, std::vector<Vec3>& ring);

 private:
  double bump(double turn) const;

  NoiseRow mask_;
  std::vector<NoiseRow> octaves_;
  std::vector<double> turns_;
  std::vector<Circle> profile_;
};

}  // namespace meshfarm
