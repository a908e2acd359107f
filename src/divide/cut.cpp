// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The cut: Xiong, Jiang, Zhang, Shi, "Parallel Simplification of Large Meshes on PC Clusters",
// EGPGV 2008, 3.1. Scans of the input, each in order and through bounded buffers:
//   vertices    bounding box
//   vertices    cells with their counts and means -> METIS -> part of each cell; once more, or a
//               few times, where vertices are not spread as a surface is
//   vertices    vertex map: part and raw index; positions to the part's bucket
//   triangles   to the part's bucket, or, when two or three parts meet in one, to the boundary
// Then each part is built from its buckets by itself, on all cores.
#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/geometry/label_corners.hpp>
#include <meshfarm/geometry/uv_facts.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/util/control_groups.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

#include "divide/cell_graph.hpp"
#include "divide/cell_tree.hpp"
#include "divide/mesh_shares.hpp"
#include "divide/part_builder.hpp"

namespace meshfarm {
namespace {

/// A mesh that fits into this much memory is cut without scratch files.
constexpr std::uint64_t k_memory_bytes = std::uint64_t{256} << 20;

/// What making a part takes for each triangle, and how often its columns are there at once.
constexpr std::uint64_t k_part_bytes = 80;
constexpr std::uint64_t k_column_copies = 3;
/// The same of finding the facts of its texture.
constexpr std::uint64_t k_fact_bytes = 40;
constexpr std::uint32_t k_no_cell = UINT32_MAX;

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
    write_channels();
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
    manifest_.skipped = info.skipped;
    manifest_.partitioner = partitioner_name();
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
    do {
      manifest_.positions = source_.info().positions;
      manifest_.box = {};
      manifest_.input_vertices = 0;
      source_.scan_vertices([&](std::span<const Vec3> batch) {
        for (const Vec3& p : batch) manifest_.box.add(p);
        manifest_.input_vertices += batch.size();
        tell("cut: bounding box", manifest_.input_vertices, source_.info().vertices);
      });
    } while (source_.info().positions != manifest_.positions);
  }

  void choose_parts() {
    // Polygons and strips hold more triangles than the header tells: vertices are a second hint.
    const MeshFileInfo& info = source_.info();
    const std::uint32_t wanted =
        options_.parts != 0 ? options_.parts : default_parts(std::max(info.faces, info.vertices));
    cells_ = std::make_unique<CellTree>(
        manifest_.box,
        CellTreeOptions{
            .bits = wanted == 1 ? 0 : grid_bits(wanted), .parts = wanted, .weld = options_.weld});
    do {
      std::uint64_t done = 0;
      source_.scan_vertices([&](std::span<const Vec3> batch) {
        for (const Vec3& p : batch) {
          if (has_position(p)) cells_->add(p);
        }
        tell("cut: cells", done += batch.size(), manifest_.input_vertices);
      });
    } while (cells_->refine());
    part_of_cell_ =
        partition_cells(cells_->cells(), {.parts = wanted, .threads = options_.threads});
    const auto last = std::max_element(part_of_cell_.begin(), part_of_cell_.end());
    parts_ = last == part_of_cell_.end() ? 0 : *last + 1;
  }

  void distribute_vertices() {
    const ColumnSet columns = source_.info().columns();
    const std::uint64_t faces = std::max<std::uint64_t>(source_.info().faces, 1);
    const std::uint64_t all = MeshShares::memory_for(
        manifest_.input_vertices, faces, manifest_.positions, has_appearances(source_), columns);
    const std::uint64_t most = options_.memory_bytes == 0
                                   ? k_memory_bytes
                                   : std::min(k_memory_bytes, options_.memory_bytes / 4);
    const std::uint64_t memory = all <= most ? all : 0;
    shares_ = std::make_unique<MeshShares>(
        MeshShares::Options{scratch_folder(options_.scratch, stage_.root(), all - memory), parts_,
                            manifest_.input_vertices, manifest_.positions, memory,
                            MeshShares::SeamsFor::all, has_appearances(source_), columns, faces});
    std::vector<std::uint32_t> parts;
    std::vector<std::uint32_t> points;
    const std::span<const Cell> cells = cells_->cells();
    const bool has_points =
        std::any_of(cells.begin(), cells.end(), [](const Cell& cell) { return cell.is_one; });
    std::uint64_t done = 0;
    scan_appearances(source_, [&](const VertexView& batch) {
      parts.clear();
      points.clear();
      for (const Vec3& p : batch.positions) {
        const std::uint32_t cell = has_position(p) ? cells_->number_of(p) : k_no_cell;
        parts.push_back(cell == k_no_cell ? MeshShares::k_no_share : part_of_cell_[cell]);
        if (!has_points) continue;
        points.push_back(cell != k_no_cell && cells[cell].is_one ? cell : MeshShares::k_no_point);
      }
      shares_->add_vertices(batch, parts, points);
      tell("cut: vertices", done += batch.size(), manifest_.input_vertices);
    });
    manifest_.coincident_vertices = shares_->merged();
    cells_.reset();
  }

  void distribute_triangles() {
    source_.scan_triangles([&](const TriangleView& batch) {
      shares_->add_triangles(batch);
      manifest_.input_triangles += batch.size();
      tell("cut: triangles", manifest_.input_triangles, source_.info().faces);
    });
    shares_->finish();
    manifest_.dropped_not_finite = shares_->dropped();
    manifest_.dropped_degenerate = shares_->points_left_out();
    manifest_.coincident_corners = shares_->points_left_out();
  }

  /// As many parts at once as fit into the memory, going by the average.
  unsigned threads() const {
    if (options_.memory_bytes == 0) return options_.threads;
    const ColumnSet columns = source_.info().columns();
    const std::uint64_t of_triangle =
        k_part_bytes + (has_appearances(source_) ? 2 * sizeof(Appearance) : 0) +
        k_column_copies * columns.bytes() + (columns.uvs ? k_fact_bytes : 0);
    const std::uint64_t part =
        1 + of_triangle * manifest_.input_triangles / std::max<std::uint32_t>(1, parts_);
    const std::uint64_t buffers = std::min(options_.memory_bytes, shares_->buffer_bytes());
    const std::uint64_t fit = (options_.memory_bytes - buffers) / part;
    return static_cast<unsigned>(
        std::clamp<std::uint64_t>(fit, 1, options_.threads != 0 ? options_.threads : processors()));
  }

  void build_parts() {
    manifest_.parts.resize(parts_);
    numbers_.resize(parts_);
    uv_facts_.resize(parts_);
    std::mutex mutex;
    std::uint64_t done = 0;
    parallel_for(parts_, threads(), [&](std::uint64_t i) {
      const auto number = static_cast<std::uint32_t>(i);
      BuiltPart built =
          build_part(shares_->read(number, options_.weld), manifest_.positions, options_.weld);
      const Mesh& mesh = built.part.mesh;
      const std::uint64_t corners =
          count_label_corners(mesh.triangles, mesh.columns.labels, mesh.positions.size());
      uv_facts_[i] = find_uv_facts(mesh, built.part.boundary_vertices);
      PartEntry entry;
      entry.vertices = built.part.mesh.positions.size();
      entry.triangles = built.part.mesh.triangles.size();
      entry.boundary_vertices = built.part.boundary_vertices;
      const std::string bytes = encode_part(built.part);
      built.part.mesh = {};
      entry.file = stage_.publish(PartName{number}, bytes);
      const std::lock_guard lock(mutex);
      manifest_.parts[i] = std::move(entry);
      numbers_[i] = std::move(built.boundary);
      manifest_.coincident_vertices += built.coincident_vertices;
      manifest_.dropped_degenerate += built.dropped_degenerate;
      manifest_.coincident_corners += built.coincident_corners;
      manifest_.label_corners += corners;
      tell("cut: parts", ++done, parts_);
    });
  }

  void write_boundary() {
    SharedTriangles shared = shares_->boundary(numbers_);
    std::vector<BoundaryTriangle>& triangles = shared.triangles;
    manifest_.dropped_degenerate += shared.degenerate;
    manifest_.coincident_corners += shared.coincident;
    manifest_.dropped_duplicate = drop_duplicates(triangles, shared.columns);
    manifest_.boundary_triangles = triangles.size();
    manifest_.boundary = stage_.publish(BoundaryName{}, encode_boundary(triangles, shared.columns));
    manifest_.labels = source_.info().labels;
    manifest_.uvs = source_.info().uvs;
    manifest_.pictures = stage_pictures(source_, stage_);
    set_uv_facts(manifest_, uv_facts_);
  }

  void write_channels() {
    manifest_.channels = stage_channels(source_, stage_, [&](std::uint64_t done) {
      tell("cut: colours and other channels", done, manifest_.input_vertices);
    });
  }

  MeshSource& source_;
  const Stage& stage_;
  const CutOptions& options_;
  Manifest manifest_;
  std::unique_ptr<CellTree> cells_;
  std::vector<std::uint32_t> part_of_cell_;
  std::uint32_t parts_ = 0;
  std::unique_ptr<MeshShares> shares_;
  std::vector<BoundaryNumbers> numbers_;
  std::vector<UvFacts> uv_facts_;  // of the parts
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
