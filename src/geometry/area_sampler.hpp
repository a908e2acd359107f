// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm {

// Samples are summed up and handed out by chunks of a fixed size, so that nothing depends on the
// threads.
constexpr std::uint64_t k_samples_a_chunk = 1024;

inline std::uint64_t chunks_of(std::uint64_t samples) {
  return (samples + k_samples_a_chunk - 1) / k_samples_a_chunk;
}

/// The area of all triangles before each block of them; the whole area at the end. Throws DataError
/// naming `which` mesh if the area is not finite.
std::vector<double> areas_before(const Mesh& mesh, unsigned threads, const char* which);

/// Throws DataError naming `which` mesh if it has no area.
void check_area(const std::vector<double>& before, const char* which);

/// Sample n lies in the n-th of equal shares of the area, at a random place within it. Samples must
/// be requested in ascending order.
class AreaSampler {
 public:
  AreaSampler(const Mesh& mesh, const std::vector<double>& before, std::uint64_t samples);
  Vec3 sample(std::uint64_t n);
  /// The triangle that the last sample lies on.
  std::size_t triangle() const { return triangle_; }

 private:
  void seek(double place);

  const Mesh& mesh_;
  const std::vector<double>& before_;
  double share_;
  std::size_t block_ = static_cast<std::size_t>(-1);
  std::size_t triangle_ = 0;
  double walked_ = 0;  // area up to the end of triangle_
};

}  // namespace meshfarm
