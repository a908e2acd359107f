// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <meshfarm/io/boundary_file.hpp>

#include "divide/boundary_numbers.hpp"
#include "divide/mesh_shares.hpp"

namespace meshfarm {

/// Triangles between shares with final vertex numbers; those that lost a corner are left out.
struct SharedTriangles {
  std::vector<BoundaryTriangle> triangles;
  TriangleColumns columns;       // of these
  std::uint64_t degenerate = 0;  // left out
  std::uint64_t coincident = 0;  // with two corners at one point, left out or not
};

/// Gives triangles between shares their final numbers. The numbers of a share are loaded when they
/// are first needed.
class SeamNumbers {
 public:
  using Load = std::function<BoundaryNumbers(std::uint32_t share)>;
  SeamNumbers(std::uint32_t shares, Load load);

  /// Keeps the order. Throws DataError for a corner that has no number.
  SharedTriangles number(const Seams& seams);
  /// Unloads the shares not needed since the last call.
  void forget_unused();

 private:
  struct Loaded {
    BoundaryNumbers numbers;
    std::size_t last = 0;  // last index found
    bool used = false;
    std::size_t find(std::uint32_t place);
  };
  Loaded& of(std::uint32_t share);

  Load load_;
  std::vector<std::unique_ptr<Loaded>> loaded_;  // by share
  std::vector<std::uint32_t> shares_;            // the loaded ones
};

}  // namespace meshfarm
