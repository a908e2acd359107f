// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include <meshfarm/util/errors.hpp>

#include "divide/bundle_file.hpp"

namespace meshfarm {
namespace {

/// Finds where the corners of a block of triangles lie: the block's triangles are looked through
/// once for each block of vertices that they touch, which are few where the file has locality.
class CornerJoin {
 public:
  CornerJoin(const Stage& stage, std::span<const VertexBundleRef> bundles, std::uint32_t parts,
             std::uint64_t vertices)
      : bundles_(bundles), vertices_(vertices), places_(stage, bundles, parts) {}

  std::vector<SeamTriangle> find(std::span<const WideTriangle> triangles) const {
    std::vector<bool> touched(bundles_.size(), false);
    const std::uint64_t size =
        std::max<std::uint64_t>(1, block_of(vertices_, bundles_.size(), 0).count);
    std::uint64_t last = UINT64_MAX;
    for (const WideTriangle& t : triangles) {
      for (const std::uint64_t v : t) {
        if (std::exchange(last, v / size) != v / size) touched[v / size] = true;
      }
    }
    std::vector<SeamTriangle> found(triangles.size());
    for (std::size_t block = 0; block < touched.size(); ++block) {
      if (touched[block]) answer(block, triangles, found);
    }
    return found;
  }

 private:
  void answer(std::size_t block, std::span<const WideTriangle> triangles,
              std::vector<SeamTriangle>& found) const {
    const std::vector<SharePlace> places = places_of(block);
    const std::uint64_t first = block_of(vertices_, bundles_.size(), block).first;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint64_t at = triangles[i][corner] - first;  // wraps round below the first
        if (at < places.size()) found[i][corner] = places[at];
      }
    }
  }

  std::vector<SharePlace> places_of(std::size_t block) const {
    const auto runs = read_section<PlaceRun>(places_.file(block), bundles_[block].bundle.runs);
    std::vector<SharePlace> places;
    const std::uint64_t count = block_of(vertices_, bundles_.size(), block).count;
    places.reserve(count);
    for (const PlaceRun& run : runs) {
      if (run.count > count - places.size()) break;
      if (run.part == MeshShares::k_no_share) {
        places.insert(places.end(), run.count, SharePlace{run.part, 0});
        continue;
      }
      const std::uint32_t base = places_.first(block, run.part) + run.place;
      for (std::uint32_t i = 0; i < run.count; ++i) places.push_back({run.part, base + i});
    }
    if (places.size() != count) {
      throw DataError(bundles_[block].file.name + ": is of other vertices: the input was changed");
    }
    return places;
  }

  std::span<const VertexBundleRef> bundles_;
  std::uint64_t vertices_;
  BlockPlaces places_;
};

/// As MeshShares::add_triangles() has it.
class TriangleScatter {
 public:
  explicit TriangleScatter(std::uint32_t parts) : parts_(parts) {}

  void add(const SeamTriangle& t) {
    const auto& [a, b, c] = t;
    constexpr std::uint32_t k_none = MeshShares::k_no_share;
    if (a.share == k_none || b.share == k_none || c.share == k_none) {
      ++bundle_.dropped;
    } else if (a == b && b == c) {
      ++bundle_.points_left_out;
    } else if (a.share == b.share && b.share == c.share) {
      OfPart& of = parts_[a.share];
      of.triangles += of.packer.pack({a.place, b.place, c.place});
      ++of.count;
    } else {
      add_seam(t);
    }
  }

  TriangleBundle write(const WriteBytes& write) {
    SectionWriter sections(write);
    std::vector<BundleEntry> directory;
    for (std::uint32_t part = 0; part < parts_.size(); ++part) {
      OfPart& of = parts_[part];
      if (of.count == 0 && of.seams.empty()) continue;
      directory.push_back({part, of.count, sections.add(std::exchange(of.triangles, {})),
                           sections.add(bytes_of(std::exchange(of.seams, {})))});
    }
    bundle_.directory = sections.add(bytes_of(directory));
    bundle_.seams = sections.add(bytes_of(seams_));
    return bundle_;
  }

 private:
  struct OfPart {
    TrianglePacker packer;
    std::string triangles;
    std::uint32_t count = 0;
    std::vector<SeamTriangle> seams;
  };

  template <class T>
  static std::string bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
  }

  /// To each of its parts, once.
  void add_seam(const SeamTriangle& t) {
    seams_.push_back(t);
    for (std::size_t i = 0; i < 3; ++i) {
      const bool seen = (i > 0 && t[i].share == t[0].share) || (i > 1 && t[i].share == t[1].share);
      if (!seen) parts_[t[i].share].seams.push_back(t);
    }
  }

  std::vector<OfPart> parts_;
  std::vector<SeamTriangle> seams_;
  TriangleBundle bundle_;
};

}  // namespace

TriangleBundle scatter_triangles(const Stage& stage, std::span<const VertexBundleRef> bundles,
                                 std::uint32_t parts, const MeshBlocks& mesh,
                                 const BlockRange& triangles, const WriteBytes& write) {
  if (triangles.count > 0xfffffffe) throw DataError("a block of 2^32 triangles or more");
  std::vector<WideTriangle> corners;
  corners.reserve(triangles.count);
  mesh.scan_triangles(triangles, [&](std::span<const WideTriangle> batch) {
    corners.insert(corners.end(), batch.begin(), batch.end());
  });
  std::vector<SeamTriangle> found =
      CornerJoin(stage, bundles, parts, mesh.vertices()).find(corners);
  corners = {};
  TriangleScatter scatter(parts);
  for (const SeamTriangle& t : found) scatter.add(t);
  found = {};
  return scatter.write(write);
}

}  // namespace meshfarm
