// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <numeric>
#include <utility>

#include <meshfarm/io/boundary_ref.hpp>
#include <meshfarm/staging/file_ref.hpp>

namespace meshfarm {

std::uint64_t bytes_of(const BoundaryFiles& files) {
  return std::accumulate(
      files.begin(), files.end(), std::uint64_t{0},
      [](std::uint64_t sum, const BoundaryFile& each) { return sum + each.file.size; });
}

void put_boundary(ByteWriter& out, const BoundaryFiles& files) {
  out.put(static_cast<std::uint32_t>(files.size()));
  for (const BoundaryFile& each : files) {
    put_file(out, each.file);
    out.put(each.index);
    out.put(each.first_region);
  }
}

BoundaryFiles get_boundary(ByteReader& in) {
  BoundaryFiles files;
  const auto count = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    BoundaryFile each;
    each.file = get_file(in);
    each.index = in.get<FileSection>();
    each.first_region = in.get<std::uint32_t>();
    const bool follows =
        i == 0 ? each.first_region == 0 : each.first_region >= files.back().first_region;
    if (!follows) in.fail("regions in another order");
    files.push_back(std::move(each));
  }
  if (files.empty()) in.fail("no boundary");
  return files;
}

}  // namespace meshfarm
