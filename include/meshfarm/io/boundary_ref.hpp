// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <meshfarm/staging/sections.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/bytes.hpp>

namespace meshfarm {

/// One of the side files (boundary_file.hpp) that hold the triangles between parts.
struct BoundaryFile {
  FileRef file;
  FileSection index;               // in that file
  std::uint32_t first_region = 0;  // it has the regions from here up to the next file's first
};
/// All of them, ordered by region. A cut makes one; jobs make several (divide/block_cut.hpp).
using BoundaryFiles = std::vector<BoundaryFile>;

std::uint64_t bytes_of(const BoundaryFiles& files);

/// As encoded in job parameters: u32 x (file | index section | first region u32).
void put_boundary(ByteWriter& out, const BoundaryFiles& files);
/// The first begins with region 0, and none begins before its predecessor.
BoundaryFiles get_boundary(ByteReader& in);

}  // namespace meshfarm
