// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <string>
#include <utility>

#include <meshfarm/divide/block_cut.hpp>
#include <meshfarm/divide/slab.hpp>
#include <meshfarm/geometry/point_meter.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/io/slab_file.hpp>
#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/pipeline/input_surface.hpp>
#include <meshfarm/staging/staged_reader.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

namespace meshfarm {
namespace {

constexpr std::size_t k_between_at_once = 16'384;  // triangles

/// Those vertices of a stream that later triangles may use, block by block.
class StreamWindow {
 public:
  /// Returns the block's triangles, as indices into positions().
  const std::vector<Triangle>& add(const StreamBlock& block) {
    forget_finished();
    positions_.insert(positions_.end(), block.positions.begin(), block.positions.end());
    finished_.resize(positions_.size(), 0);
    shown_.resize(positions_.size(), 0);
    for (const StreamCorner vertex : block.boundary) {
      if (vertex.last_use())
        finished_[positions_.size() - block.positions.size() + vertex.vertex()] = 1;
    }
    triangles_.clear();
    for (const auto& corners : block.triangles) {
      Triangle triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        triangle[k] = corners[k].vertex() - first_;
        if (corners[k].last_use()) finished_[triangle[k]] = 1;
      }
      triangles_.push_back(triangle);
    }
    fresh_.clear();
    for_corners_with_area(positions_, triangles_, [&](std::uint32_t v) {
      if (std::exchange(shown_[v], 1) == 0) fresh_.push_back(positions_[v]);
    });
    return triangles_;
  }
  std::span<const Vec3> positions() const { return positions_; }
  /// The vertices of the block's triangles that no earlier triangle used.
  std::span<const Vec3> fresh() const { return fresh_; }

 private:
  void forget_finished() {
    const auto first = std::find(finished_.begin(), finished_.end(), 0) - finished_.begin();
    first_ += static_cast<std::uint32_t>(first);
    positions_.erase(positions_.begin(), positions_.begin() + first);
    finished_.erase(finished_.begin(), finished_.begin() + first);
    shown_.erase(shown_.begin(), shown_.begin() + first);
  }

  std::uint32_t first_ = 0;  // number in the stream of the first vertex kept
  std::vector<Vec3> positions_;
  std::vector<std::uint8_t> finished_;
  std::vector<std::uint8_t> shown_;
  std::vector<Triangle> triangles_;
  std::vector<Vec3> fresh_;
};

}  // namespace

InputSurface::InputSurface(const Stage& stage, const Manifest& manifest, unsigned threads)
    : stage_(stage), manifest_(manifest), threads_(threads) {}

void InputSurface::show(const Wants& wants, const Show& show) {
  if (manifest_.cutting) {
    throw DataError("this stage keeps no parts of the input: its runs cut it (--cut farm)");
  }
  const bool is_first = boxes_.empty();
  boxes_.resize(manifest_.parts.size());
  boundary_.resize(manifest_.parts.size());
  parallel_for(manifest_.parts.size(), threads_, [&](std::uint64_t p) {
    if (!is_first && !wants(boxes_[p])) return;
    show_one(static_cast<std::uint32_t>(p), show);
  });
  show_between(wants, show);
}

void InputSurface::show_parts(const Stage& stage, const Manifest& manifest,
                              std::span<const std::uint32_t> parts, const Show& show) {
  InputSurface some(stage, manifest, 1);
  some.boxes_.resize(manifest.parts.size());
  some.boundary_.resize(manifest.parts.size());
  for (const std::uint32_t part : parts) {
    if (part >= manifest.parts.size()) throw DataError("no such parts in the stage");
    some.show_one(part, show);
  }
}

void InputSurface::show_one(std::uint32_t part, const Show& show) {
  if (manifest_.sorting) return show_slab(part, show);
  manifest_.scheme == Scheme::stream ? show_stream(part, show) : show_part(part, show);
}

Part InputSurface::read_part(std::uint32_t p) const {
  if (manifest_.bundles) return build_from_blocks(stage_, *manifest_.bundles, p).part;
  const FileRef& file = manifest_.parts[p].file;
  return decode_part(stage_.read(file), file.name);
}

void InputSurface::show_part(std::uint32_t p, const Show& show) {
  const Part part = read_part(p);
  const std::vector<Vec3>& positions = part.mesh.positions;
  if (boxes_[p].empty()) {
    for (const Vec3& v : positions) boxes_[p].add(v);
    boundary_[p].assign(positions.begin(), positions.begin() + part.boundary_vertices);
  }
  const std::vector<Vec3> fresh = vertices_of_surface(positions, part.mesh.triangles);
  show({positions, part.mesh.triangles, part.mesh.columns, fresh, p});
}

/// Sorted as the sort job does, to get the numbers of the boundary vertices.
void InputSurface::show_slab(std::uint32_t p, const Show& show) {
  const FileRef& file = manifest_.parts[p].file;
  const StreamMesh sorted =
      sort_slab(decode_slab(stage_.read(file), file.name), *manifest_.sorting).stream;
  const std::vector<Vec3>& positions = sorted.mesh.positions;
  if (boxes_[p].empty()) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      boxes_[p].add(positions[i]);
      if (sorted.boundary[i] != 0) boundary_[p].push_back(positions[i]);
    }
  }
  const std::vector<Vec3> fresh = vertices_of_surface(positions, sorted.mesh.triangles);
  show({positions, sorted.mesh.triangles, sorted.mesh.columns, fresh, p});
}

void InputSurface::show_stream(std::uint32_t p, const Show& show) {
  const FileRef& file = manifest_.parts[p].file;
  StagedReader bytes(stage_, file);
  StreamReader reader([&](std::span<char> buffer) { bytes.fill(buffer); }, file.name);
  StreamWindow window;
  StreamBlock block;
  const bool is_first = boxes_[p].empty();
  while (reader.next(block)) {
    if (is_first) {
      for (const Vec3& v : block.positions) boxes_[p].add(v);
      for (const StreamCorner v : block.boundary) {
        boundary_[p].push_back(block.positions[v.vertex()]);
      }
    }
    const std::vector<Triangle>& triangles = window.add(block);
    show({window.positions(), triangles, block.columns, window.fresh(), p});
  }
  bytes.expect_end();
}

Vec3 InputSurface::corner(const BoundaryCorner& corner) const {
  if (corner.part >= boundary_.size() || corner.local >= boundary_[corner.part].size()) {
    throw DataError("a boundary triangle names vertex " + std::to_string(corner.local) +
                    " of part " + std::to_string(corner.part) +
                    ", which is no boundary vertex there; cut the mesh again");
  }
  return boundary_[corner.part][corner.local];
}

/// Shown as a part after the last one.
void InputSurface::show_between(const Wants& wants, const Show& show) const {
  Mesh some;
  const auto flush = [&] {
    Box box;
    for (const Vec3& v : some.positions) box.add(v);
    if (wants(box)) {
      show({some.positions,
            some.triangles,
            some.columns,
            {},
            static_cast<std::uint32_t>(boundary_.size())});
    }
    some = {};
  };
  const auto add = [&](std::span<const BoundaryTriangle> triangles,
                       const TriangleColumnsView& columns) {
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const auto first = static_cast<std::uint32_t>(some.positions.size());
      for (const BoundaryCorner& each : triangles[i]) some.positions.push_back(corner(each));
      some.columns.append(columns, i);
      some.triangles.push_back({first, first + 1, first + 2});
      if (some.triangles.size() == k_between_at_once) flush();
    }
  };
  for (const BoundaryFile& each : manifest_.boundary) {
    StagedReader bytes(stage_, each.file);
    scan_boundary([&](std::span<char> buffer) { bytes.fill(buffer); }, each.file.name, add);
    bytes.expect_end();
  }
  flush();
}

}  // namespace meshfarm
