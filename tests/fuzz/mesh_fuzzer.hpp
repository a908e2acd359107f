// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm::fuzz {

/// The limit for a picture that is sampled.
inline constexpr std::uint64_t k_most_picture_bytes = 1 << 18;

inline void require(bool holds) {
  if (!holds) std::abort();
}

inline void scan(MeshSource& source) {
  std::uint64_t vertices = 0;
  source.scan_vertices([&vertices](std::span<const Vec3> batch) {
    require(batch.size() <= 65'536);
    vertices += batch.size();
    for (const Vec3& vertex : batch) require(is_finite(vertex) || !has_position(vertex));
  });
  require(vertices == source.info().vertices);
  const std::size_t channels = source.info().channels.size();
  std::uint64_t valued = 0;
  source.scan_channels([channels, &valued](const ChannelPoints& batch) {
    require(batch.values.size() == channels * batch.points.size());
    for (const Vec3& point : batch.points) require(is_finite(point) || !has_position(point));
    valued += batch.points.size();
  });
  require(channels == 0 || valued == vertices);
  const std::optional<LabelMeaning>& labels = source.info().labels;
  const ColumnSet columns = source.info().columns();
  source.scan_triangles([vertices, &labels, columns](const TriangleView& batch) {
    require(batch.size() <= 65'536);
    for (const WideTriangle& triangle : batch.corners) {
      for (const std::uint64_t index : triangle) require(index < vertices);
    }
    require(batch.columns.fits(columns, batch.size()));
    for (const Label label : batch.columns.labels) {
      require(labels->materials.empty() || label < labels->materials.size());
    }
  });
}

/// Any bytes, opened as a mesh file by `open(path)` and scanned twice, give triangles with valid
/// indices, or one of our Errors.
template <class Open>
int fuzz_mesh(const std::uint8_t* data, std::size_t size, const Open& open) {
  constexpr std::size_t k_most_bytes = 1 << 16;  // a compressed input grows by a factor of 1000
  if (size > k_most_bytes) return -1;
  set_log("", LogLevel::off);
  const Fd file(::memfd_create("mesh", MFD_CLOEXEC));
  require(bool(file));
  write_all(file.get(), {reinterpret_cast<const char*>(data), size}, "memfd");
  try {
    const std::unique_ptr<MeshSource> source = open("/proc/self/fd/" + std::to_string(file.get()));
    scan(*source);
    scan(*source);
  } catch (const Error&) {
    return 0;
  }
  return 0;
}

}  // namespace meshfarm::fuzz
