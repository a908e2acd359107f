// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <meshfarm/geometry/vec.hpp>

#include "gltf_buffers.hpp"
#include "gltf_json.hpp"
#include "ply_types.hpp"

namespace meshfarm {

/// An accessor: rows of one to four components, as stored in a buffer. It lies within the buffer.
struct GltfColumn {
  std::shared_ptr<const GltfBuffer> buffer;
  std::uint64_t start = 0;
  std::uint64_t rows = 0;
  std::size_t stride = 0;
  std::size_t components = 0;
  PlyType type = PlyType::float32;
  bool normalized = false;  // whole numbers that stand for 0 to 1, or -1 to 1
};

/// Throws DataError for an accessor that does not fit its buffer view, for a view that does not fit
/// its buffer, and for an accessor that is sparse or has no buffer view.
GltfColumn open_column(const GltfValue& document, std::uint64_t accessor, GltfBuffers& buffers);

/// Reads rows, in memory that it reuses.
class GltfColumnReader {
 public:
  static constexpr std::size_t k_most_rows = 8190;  // a multiple of three: whole triangles

  /// Read rows, which must exist: of a column of three components, of one with three or four (with
  /// three, the last is left unchanged), and of one with whole numbers.
  void read(const GltfColumn& column, std::uint64_t first, std::span<Vec3> out);
  void read(const GltfColumn& column, std::uint64_t first, std::span<std::array<double, 4>> out);
  void read(const GltfColumn& column, std::uint64_t first, std::span<std::uint32_t> out);

 private:
  const char* fetch(const GltfColumn& column, std::uint64_t first, std::size_t rows);

  std::string bytes_;
};

}  // namespace meshfarm
