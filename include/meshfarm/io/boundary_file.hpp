// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/boundary_ref.hpp>
#include <meshfarm/io/fill.hpp>
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/bucket_file.hpp>

namespace meshfarm {

/// A corner of a boundary triangle: a vertex by its part and its index there.
struct BoundaryCorner {
  std::uint32_t part = 0;
  std::uint32_t local = 0;
  friend auto operator<=>(const BoundaryCorner&, const BoundaryCorner&) = default;
};
using BoundaryTriangle = std::array<BoundaryCorner, 3>;

/// Of triangles with the same corners, in any order, keeps the first, and removes the columns of
/// the others. Returns how many were removed.
std::uint64_t drop_duplicates(std::vector<BoundaryTriangle>& triangles, TriangleColumns& columns);
std::uint64_t drop_duplicates(std::vector<BoundaryTriangle>& triangles);

/// Sorts the triangles between `parts` parts by region (regions.hpp), keeping the order within a
/// region, and drops duplicates as drop_duplicates() does. Returns how many were removed.
std::uint64_t order_by_region(std::uint32_t parts, std::vector<BoundaryTriangle>& triangles,
                              TriangleColumns& columns);

/// The side file, and where its index is.
struct EncodedBoundary {
  std::string file;
  FileSection index;
};
/// All triangles whose corners lie in two or three of `parts` parts (Xiong et al. 2008, 3.1 step
/// 4), in the order of order_by_region(), with their columns.
EncodedBoundary encode_boundary(std::uint32_t parts, const std::vector<BoundaryTriangle>& triangles,
                                const TriangleColumnsView& columns = {});

/// A region's entry in a side file's index.
struct BoundaryRegion {
  std::uint64_t triangles = 0;
  std::uint64_t hash = 0;  // of their bytes
};

/// Publishes the same file, made region by region; holds one region at a time.
class BoundaryWriter {
 public:
  /// `folder` is for a scratch file.
  BoundaryWriter(const std::filesystem::path& folder, std::uint32_t parts);
  /// The triangles of the next region, and their columns.
  void add_region(std::span<const BoundaryTriangle> triangles, const TriangleColumnsView& columns);
  /// Those added so far.
  std::uint64_t triangles() const { return triangles_; }
  /// After all regions.
  BoundaryFile publish(const Stage& stage);

 private:
  std::uint32_t parts_;
  ColumnSet columns_;
  std::uint64_t triangles_ = 0;
  std::vector<BoundaryRegion> regions_;
  BucketFile scratch_;
};

std::vector<BoundaryTriangle> decode_boundary(std::string_view file, std::string_view what);
/// With the columns of the file.
std::vector<BoundaryTriangle> decode_boundary(std::string_view file, std::string_view what,
                                              TriangleColumns& columns);
/// Shows every triangle of a side file in order, in batches with their columns, without holding the
/// file in memory. Does not check the file's checksum: that is up to the caller's `fill`.
void scan_boundary(
    const Fill& fill, std::string_view what,
    const std::function<void(std::span<const BoundaryTriangle>, const TriangleColumnsView&)>& show);

/// All triangles of the files, with their columns.
std::vector<BoundaryTriangle> read_boundary(const Stage& stage, const BoundaryFiles& files,
                                            TriangleColumns& columns);
std::vector<BoundaryTriangle> read_boundary(const Stage& stage, const BoundaryFiles& files);

/// Reads the triangles of single regions without reading the others. A file is opened when one of
/// its regions is first asked for.
class BoundaryRegions {
 public:
  BoundaryRegions(const Stage& stage, BoundaryFiles files, std::uint32_t parts);
  /// Appends the triangles of a region, with their columns. Throws as SectionedFile does, and
  /// DataError for a malformed index or one for other parts.
  void read(std::uint32_t region, std::vector<BoundaryTriangle>& triangles,
            TriangleColumns& columns);

 private:
  struct Open {
    SectionedFile file;
    ColumnSet columns;
    std::vector<FileSection> sections;  // by region
  };
  Open open(const BoundaryFile& from) const;

  const Stage& stage_;
  BoundaryFiles files_;
  std::uint32_t parts_;
  std::vector<std::optional<Open>> open_;  // by file
};

}  // namespace meshfarm
