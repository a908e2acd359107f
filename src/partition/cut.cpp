// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The cut: Xiong, Jiang, Zhang, Shi, "Parallel Simplification of Large Meshes on PC Clusters",
// EGPGV 2008, 3.1. Scans of the input, each in order and through bounded buffers:
//   vertices    bounding box
//   vertices    cells with their counts and means -> METIS -> part of each cell
//   vertices    vertex map (scratch file): part and raw index; positions to the part's bucket
//   triangles   to the part's bucket, or, when two or three parts meet in one, to the boundary
// Then each part is built from its buckets by itself, on all cores.
#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <mutex>

#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/partition/cell_graph.hpp>
#include <meshfarm/partition/cut.hpp>
#include <meshfarm/partition/grid.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>
#include <meshfarm/util/parallel.hpp>

#include "partition/bucket_file.hpp"
#include "partition/part_builder.hpp"

namespace meshfarm {
namespace {

struct MapEntry {
  std::uint32_t part = 0;
  std::uint32_t raw = 0;
};
using RawBoundaryTriangle = std::array<MapEntry, 3>;

/// Parts of 200 to 1000 cells each: fine enough for even sizes and smooth seams.
unsigned grid_bits(std::uint32_t parts) {
  unsigned bits = 4;
  while (bits < 12 && (std::uint64_t{1} << (2 * bits)) < std::uint64_t{512} * parts) ++bits;
  return bits;
}

class Cutter {
 public:
  Cutter(MeshSource& source, const Stage& stage, const CutOptions& options)
      : source_(source), stage_(stage), options_(options) {}

  Manifest run() {
    const auto start = std::chrono::steady_clock::now();
    describe_input();
    measure_box();
    choose_parts();
    distribute_vertices();
    distribute_triangles();
    build_parts();
    write_boundary();
    manifest_.cut_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    stage_.publish(ManifestName{}, encode_manifest(manifest_));
    return std::move(manifest_);
  }

 private:
  void describe_input() {
    const MeshFileInfo& info = source_.info();
    manifest_.input = options_.input_name;
    manifest_.input_format = info.format;
    if (info.compression != "none") manifest_.input_format += ", " + info.compression;
    manifest_.positions = info.positions;
    manifest_.skipped = info.skipped;
  }

  void tell(std::string_view phase, std::uint64_t done, std::uint64_t all) const {
    if (options_.stop != nullptr && *options_.stop) {
      throw IncompleteError("the cut was interrupted; run the same command again");
    }
    if (options_.progress) {
      options_.progress(phase,
                        all == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(all));
    }
  }

  void measure_box() {
    source_.scan_vertices([&](std::span<const Vec3> batch) {
      for (const Vec3& p : batch) manifest_.box.add(p);
      manifest_.input_vertices += batch.size();
      tell("cut: bounding box", manifest_.input_vertices, source_.info().vertices);
    });
  }

  void choose_parts() {
    // Polygons and strips hold more triangles than the header tells: vertices are a second hint.
    const MeshFileInfo& info = source_.info();
    const std::uint32_t wanted =
        options_.parts != 0 ? options_.parts : default_parts(std::max(info.faces, info.vertices));
    grid_ = UniformGrid(manifest_.box, wanted == 1 ? 0 : grid_bits(wanted));
    std::uint64_t done = 0;
    source_.scan_vertices([&](std::span<const Vec3> batch) {
      for (const Vec3& p : batch) cells_.add(grid_.cell_of(p), p);
      tell("cut: cells", done += batch.size(), manifest_.input_vertices);
    });
    cells_.finish();
    part_of_cell_ = partition_cells(cells_.cells(), {.parts = wanted});
    const auto last = std::max_element(part_of_cell_.begin(), part_of_cell_.end());
    parts_ = last == part_of_cell_.end() ? 0 : *last + 1;
  }

  void distribute_vertices() {
    map_ = MappedFile::scratch(stage_.root(), manifest_.input_vertices * sizeof(MapEntry));
    vertices_ = std::make_unique<BucketFile>(stage_.root(), parts_);
    const std::span<MapEntry> map = map_.as_span<MapEntry>();
    std::vector<std::uint64_t> next(parts_, 0);
    std::uint64_t done = 0;
    source_.scan_vertices([&](std::span<const Vec3> batch) {
      for (const Vec3& p : batch) {
        const std::uint32_t part = part_of_cell_[cells_.number_of(grid_.cell_of(p))];
        if (next[part] > 0xfffffffe) {
          throw DataError("a part would have 2^32 vertices or more; ask for more --parts");
        }
        map[done++] = {part, static_cast<std::uint32_t>(next[part]++)};
        put_position(part, p);
      }
      tell("cut: vertices", done, manifest_.input_vertices);
    });
    vertices_->finish();
  }

  void put_position(std::uint32_t part, Vec3 p) {
    if (manifest_.positions == PositionType::float64) {
      vertices_->put(part, p);
    } else {
      vertices_->put(part, std::array<float, 3>{static_cast<float>(p.x), static_cast<float>(p.y),
                                                static_cast<float>(p.z)});
    }
  }

  void distribute_triangles() {
    triangles_ = std::make_unique<BucketFile>(stage_.root(), parts_);
    boundary_vertices_ = std::make_unique<BucketFile>(stage_.root(), parts_);
    const std::span<const MapEntry> map = map_.as_span<const MapEntry>();
    source_.scan_triangles([&](std::span<const WideTriangle> batch) {
      for (const WideTriangle& t : batch) {
        const MapEntry a = map[t[0]];
        const MapEntry b = map[t[1]];
        const MapEntry c = map[t[2]];
        if (a.part == b.part && b.part == c.part) {
          triangles_->put(a.part, Triangle{a.raw, b.raw, c.raw});
        } else {
          boundary_.push_back({a, b, c});
          for (const MapEntry& corner : {a, b, c}) boundary_vertices_->put(corner.part, corner.raw);
        }
      }
      manifest_.input_triangles += batch.size();
      tell("cut: triangles", manifest_.input_triangles, source_.info().faces);
    });
    triangles_->finish();
    boundary_vertices_->finish();
    map_ = {};
  }

  RawPart read_raw(std::uint32_t part) const {
    RawPart raw;
    if (manifest_.positions == PositionType::float64) {
      raw.positions = vertices_->read<Vec3>(part);
    } else {
      const auto floats = vertices_->read<std::array<float, 3>>(part);
      raw.positions.reserve(floats.size());
      for (const auto& p : floats) raw.positions.push_back({p[0], p[1], p[2]});
    }
    raw.triangles = triangles_->read<Triangle>(part);
    raw.boundary = boundary_vertices_->read<std::uint32_t>(part);
    return raw;
  }

  void build_parts() {
    manifest_.parts.resize(parts_);
    boundary_raw_.resize(parts_);
    boundary_final_.resize(parts_);
    std::mutex mutex;
    std::uint64_t done = 0;
    parallel_for(parts_, options_.threads, [&](std::uint64_t i) {
      const auto number = static_cast<std::uint32_t>(i);
      BuiltPart built = build_part(read_raw(number), manifest_.positions, options_.weld);
      PartEntry entry;
      entry.vertices = built.part.mesh.positions.size();
      entry.triangles = built.part.mesh.triangles.size();
      entry.boundary_vertices = built.part.boundary_vertices;
      const std::string bytes = encode_part(built.part);
      built.part.mesh = {};
      entry.file = stage_.publish(PartName{number}, bytes);
      const std::lock_guard lock(mutex);
      manifest_.parts[i] = std::move(entry);
      boundary_raw_[i] = std::move(built.boundary_raw);
      boundary_final_[i] = std::move(built.boundary_final);
      manifest_.merged_vertices += built.merged_vertices;
      manifest_.dropped_degenerate += built.dropped_degenerate;
      tell("cut: parts", ++done, parts_);
    });
  }

  BoundaryCorner final_corner(MapEntry corner) const {
    const std::vector<std::uint32_t>& raw = boundary_raw_[corner.part];
    const auto at = std::lower_bound(raw.begin(), raw.end(), corner.raw) - raw.begin();
    return {corner.part, boundary_final_[corner.part][static_cast<std::size_t>(at)]};
  }

  void write_boundary() {
    std::vector<BoundaryTriangle> triangles;
    triangles.reserve(boundary_.size());
    for (const RawBoundaryTriangle& t : boundary_) {
      const BoundaryTriangle made = {final_corner(t[0]), final_corner(t[1]), final_corner(t[2])};
      if (made[0] == made[1] || made[1] == made[2] || made[2] == made[0]) {
        ++manifest_.dropped_degenerate;
      } else {
        triangles.push_back(made);
      }
    }
    manifest_.dropped_duplicate = drop_duplicates(triangles);
    manifest_.boundary_triangles = triangles.size();
    manifest_.boundary = stage_.publish(BoundaryName{}, encode_boundary(triangles));
  }

  /// Keeps the first of the triangles with the same corners, in whatever order they name them.
  static std::uint64_t drop_duplicates(std::vector<BoundaryTriangle>& triangles) {
    std::vector<std::pair<BoundaryTriangle, std::size_t>> sorted;
    sorted.reserve(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      BoundaryTriangle key = triangles[i];
      std::sort(key.begin(), key.end());
      sorted.emplace_back(key, i);
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<bool> duplicate(triangles.size(), false);
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      if (sorted[i].first == sorted[i - 1].first) duplicate[sorted[i].second] = true;
    }
    const std::size_t before = triangles.size();
    std::size_t index = 0;
    std::erase_if(triangles, [&](const BoundaryTriangle&) { return duplicate[index++]; });
    return before - triangles.size();
  }

  MeshSource& source_;
  const Stage& stage_;
  const CutOptions& options_;
  Manifest manifest_;
  UniformGrid grid_{Box{}, 0};
  CellTable cells_;
  std::vector<std::uint32_t> part_of_cell_;
  std::uint32_t parts_ = 0;
  MappedFile map_;
  std::unique_ptr<BucketFile> vertices_;
  std::unique_ptr<BucketFile> triangles_;
  std::unique_ptr<BucketFile> boundary_vertices_;
  std::vector<RawBoundaryTriangle> boundary_;  // as the square root of the input
  std::vector<std::vector<std::uint32_t>> boundary_raw_;
  std::vector<std::vector<std::uint32_t>> boundary_final_;
};

}  // namespace

std::uint32_t default_parts(std::uint64_t triangles) {
  constexpr std::uint64_t k_part = 1'000'000;
  constexpr std::uint64_t k_worth_cutting = 50'000;
  constexpr std::uint64_t k_few = 16;
  const std::uint64_t parts =
      std::max(triangles / k_part, std::min(k_few, triangles / k_worth_cutting));
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(parts, 1, 1'000'000));
}

Manifest cut_mesh(MeshSource& source, const Stage& stage, const CutOptions& options) {
  return Cutter(source, stage, options).run();
}

}  // namespace meshfarm
