// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Any bytes, opened as a mesh file and scanned twice, end in triangles with good indices or in an
// Error of ours.
#include <cstdlib>

#include <sys/mman.h>
#include <unistd.h>

#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>
#include <meshfarm/util/log.hpp>

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

void scan(meshfarm::MeshSource& source) {
  std::uint64_t vertices = 0;
  source.scan_vertices([&vertices](std::span<const meshfarm::Vec3> batch) {
    require(batch.size() <= 65'536);
    vertices += batch.size();
    for (const meshfarm::Vec3& vertex : batch) require(is_finite(vertex) || !has_position(vertex));
  });
  require(vertices == source.info().vertices);
  source.scan_triangles([vertices](std::span<const meshfarm::WideTriangle> batch) {
    require(batch.size() <= 65'536);
    for (const meshfarm::WideTriangle& triangle : batch) {
      for (const std::uint64_t index : triangle) require(index < vertices);
    }
  });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t k_most_bytes = 1 << 16;  // a compressed input grows by a factor of 1000
  if (size > k_most_bytes) return -1;
  meshfarm::set_log("", meshfarm::LogLevel::off);
  const meshfarm::Fd file(::memfd_create("mesh", MFD_CLOEXEC));
  require(bool(file));
  meshfarm::write_all(file.get(), {reinterpret_cast<const char*>(data), size}, "memfd");
  try {
    scan(*meshfarm::open_mesh("/proc/self/fd/" + std::to_string(file.get())));
  } catch (const meshfarm::Error&) {
    return 0;
  }
  return 0;
}
