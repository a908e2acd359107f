// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/util/file.hpp>

namespace meshfarm {

/// All positions of a mesh in file order, kept between scans: a limited number in memory, more in a
/// scratch file without a name in $TMPDIR (or /tmp), with 12 bytes per vertex for floats and 24 for
/// doubles.
class KeptPositions {
 public:
  /// For this number of vertices. Throws IoError.
  KeptPositions(PositionType type, std::uint64_t vertices);

  /// Appends positions. Throws IoError, for a full disk, say.
  void add(std::span<const Vec3> batch);
  void scan(const std::function<void(std::span<const Vec3>)>& take) const;

  /// The positions, if they are in memory.
  const std::vector<Vec3>& in_memory() const { return memory_; }
  bool is_in_memory() const { return !file_; }
  PositionType type() const { return type_; }
  std::uint64_t count() const { return count_; }
  /// Reads bytes of the scratch file.
  void read(std::uint64_t offset, std::span<char> out) const;

 private:
  void write(std::span<const Vec3> batch);

  PositionType type_;
  std::vector<Vec3> memory_;
  std::filesystem::path folder_;
  Fd file_;
  std::vector<float> floats_;  // of a batch
  std::uint64_t count_ = 0;
};

}  // namespace meshfarm
