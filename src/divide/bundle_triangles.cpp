// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include <meshfarm/io/regions.hpp>
#include <meshfarm/util/errors.hpp>

#include "divide/bundle_file.hpp"

namespace meshfarm {
namespace {

/// Minimum number of triangles in a slice.
constexpr std::uint64_t k_least_slice = std::uint64_t{1} << 16;

/// Finds the places of triangle corners. They are first asked for, and then answered together, so
/// that each block of vertices that they touch is read once.
class CornerJoin {
 public:
  CornerJoin(const Stage& stage, std::span<const VertexBundleRef> bundles, std::uint32_t parts,
             std::uint64_t vertices)
      : bundles_(bundles),
        vertices_(vertices),
        places_(stage, bundles, parts),
        touched_(bundles.size(), false) {}

  /// Returns a placeholder for the corner until it is answered.
  SharePlace ask(std::uint64_t vertex) {
    if (vertex - asked_.first >= asked_.count) touch(vertex);
    return {k_unanswered | asked_block_, static_cast<std::uint32_t>(vertex - asked_.first)};
  }

  /// From this many triangles on, finding the places of the vertices of all touched blocks costs
  /// less than looking up the triangles. Few suffice if the file has locality, none do if it has
  /// not.
  std::uint64_t worth_answering() const { return std::max(k_least_slice, touched_vertices_ / 2); }

  void answer(std::span<SeamTriangle> triangles) {
    for (std::uint32_t block = 0; block < touched_.size(); ++block) {
      if (touched_[block]) answer(block, triangles);
    }
    touched_.assign(touched_.size(), false);
    touched_vertices_ = 0;
    asked_ = {};
  }

 private:
  static constexpr std::uint32_t k_unanswered = std::uint32_t{1} << 31;

  void touch(std::uint64_t vertex) {
    const std::uint64_t size = block_of(vertices_, bundles_.size(), 0).count;
    asked_block_ = static_cast<std::uint32_t>(vertex / size);
    asked_ = block_of(vertices_, bundles_.size(), asked_block_);
    if (touched_.at(asked_block_)) return;
    touched_[asked_block_] = true;
    touched_vertices_ += asked_.count;
  }

  void answer(std::uint32_t block, std::span<SeamTriangle> triangles) {
    if (std::exchange(known_block_, block) != block) find_places(block);
    for (SeamTriangle& t : triangles) {
      for (SharePlace& corner : t) {
        if (corner.share == (k_unanswered | block)) corner = known_[corner.place];
      }
    }
  }

  void find_places(std::uint32_t block) {
    const auto runs = read_section<PlaceRun>(places_.file(block), bundles_[block].bundle.runs);
    const std::uint64_t count = block_of(vertices_, bundles_.size(), block).count;
    known_.clear();
    known_.reserve(count);
    for (const PlaceRun& run : runs) {
      if (run.count > count - known_.size()) break;
      if (run.part == MeshShares::k_no_share) {
        known_.insert(known_.end(), run.count, SharePlace{run.part, 0});
        continue;
      }
      if (run.part >= places_.parts()) {
        throw DataError(bundles_[block].file.name + ": has a vertex of no part");
      }
      const std::uint32_t base = places_.first(block, run.part) + run.place;
      for (std::uint32_t i = 0; i < run.count; ++i) known_.push_back({run.part, base + i});
    }
    if (known_.size() != count) {
      throw DataError(bundles_[block].file.name + ": is of other vertices: the input was changed");
    }
  }

  std::span<const VertexBundleRef> bundles_;
  std::uint64_t vertices_;
  BlockPlaces places_;
  std::vector<bool> touched_;  // blocks, by the corners asked for
  std::uint64_t touched_vertices_ = 0;
  BlockRange asked_{};  // the vertices of the block asked for last
  std::uint32_t asked_block_ = 0;
  std::vector<SharePlace> known_;  // of the vertices of a block
  std::uint32_t known_block_ = UINT32_MAX;
};

/// Scatters like MeshShares::add_triangles().
class TriangleScatter {
 public:
  explicit TriangleScatter(std::uint32_t parts)
      : parts_(parts), groups_(parts), seams_(groups_.count()) {}

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

  TriangleBundle write(std::span<const VertexBundleRef> vertices, const WriteBytes& write) {
    SectionWriter sections(write);
    std::vector<BundleEntry> directory;
    bundle_.parts.emplace();
    for (std::uint32_t part = 0; part < parts_.size(); ++part) {
      OfPart& of = parts_[part];
      if (of.count == 0 && of.seams.empty()) continue;
      bundle_.parts->push_back(part);
      directory.push_back({part, of.count, sections.add(std::exchange(of.triangles, {})),
                           sections.add(bytes_of(std::exchange(of.seams, {})))});
    }
    bundle_.directory = sections.add(bytes_of(directory));
    std::vector<FileSection> seams;
    for (std::size_t group = 0; group < seams_.size(); ++group) {
      std::vector<SeamTriangle>& of_group = seams_[group];
      if (!of_group.empty()) bundle_.groups |= 1U << group;
      seams.push_back(sections.add(bytes_of(std::exchange(of_group, {}))));
    }
    bundle_.seams = sections.add(bytes_of(seams));
    bundle_.vertices = sections.add(encode_bundles(vertices));
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

  /// Adds the triangle to each of its parts, once.
  void add_seam(const SeamTriangle& t) {
    ++bundle_.seam_triangles;
    seams_[groups_.of(t[0].share, t[1].share, t[2].share)].push_back(t);
    for (std::size_t i = 0; i < 3; ++i) {
      const bool seen = (i > 0 && t[i].share == t[0].share) || (i > 1 && t[i].share == t[1].share);
      if (!seen) parts_[t[i].share].seams.push_back(t);
    }
  }

  std::vector<OfPart> parts_;
  RegionGroups groups_;
  std::vector<std::vector<SeamTriangle>> seams_;  // by group
  TriangleBundle bundle_;
};

}  // namespace

TriangleBundle scatter_triangles(const Stage& stage, std::span<const VertexBundleRef> bundles,
                                 std::uint32_t parts, const MeshBlocks& mesh,
                                 const BlockRange& triangles, const WriteBytes& write) {
  if (triangles.count > 0xfffffffe) throw DataError("a block of 2^32 triangles or more");
  CornerJoin join(stage, bundles, parts, mesh.vertices());
  TriangleScatter scatter(parts);
  std::vector<SeamTriangle> slice;
  slice.reserve(triangles.count);
  const auto scatter_slice = [&] {
    join.answer(slice);
    for (const SeamTriangle& t : slice) scatter.add(t);
    slice.clear();
  };
  mesh.scan_triangles(triangles, [&](std::span<const WideTriangle> batch) {
    for (const auto& [a, b, c] : batch) slice.push_back({join.ask(a), join.ask(b), join.ask(c)});
    if (slice.size() >= join.worth_answering()) scatter_slice();
  });
  scatter_slice();
  return scatter.write(bundles, write);
}

}  // namespace meshfarm
