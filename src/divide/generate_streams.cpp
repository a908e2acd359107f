// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Stream generation: Xiong, Jiang, Zhang, Shi, "Parallel Simplification of Large Meshes on PC
// Clusters", EGPGV 2008, 4.1. Scans of the input, each in order and through bounded buffers:
//   vertices    bounding box, and whether they come in order along an axis
//   vertices    how many lie where along the axis -> slabs, one a stream; once more, or a few
//               times, where many lie close together
//   vertices    index map (scratch file): slab and place in it; positions to the slab's bucket
//   triangles   to the slab's bucket, or, when two or three slabs meet in one, to the boundary
// Then each slab is sorted by itself, on all cores, or staged as it is and sorted by a job of the
// farm (pipeline/sort_job.hpp). It is sorted by distribution rather than by merging runs: that,
// too, moves everything to disk and back once, but leaves nothing to merge.
#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>

#include <meshfarm/divide/generate_streams.hpp>
#include <meshfarm/divide/slab.hpp>
#include <meshfarm/geometry/label_corners.hpp>
#include <meshfarm/geometry/uv_facts.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/slab_file.hpp>
#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/util/control_groups.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

#include "divide/mesh_shares.hpp"
#include "divide/slab_map.hpp"
#include "divide/sort_with_columns.hpp"

namespace meshfarm {
namespace {

constexpr std::uint32_t k_most_streams = 65'536;
/// What finding the facts of its texture takes beside a stream, for each triangle.
constexpr std::uint64_t k_fact_bytes = 24;

class Generator {
 public:
  Generator(MeshSource& source, const Stage& stage, const StreamOptions& options)
      : source_(source), stage_(stage), options_(options) {}

  Manifest run() {
    const auto start = std::chrono::steady_clock::now();
    describe_input();
    choose_order();
    choose_slabs();
    distribute_vertices();
    distribute_triangles();
    write_slabs();
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
    manifest_.scheme = Scheme::stream;
    manifest_.window_triangles = options_.window_triangles;
    manifest_.input = options_.input_name;
    manifest_.input_format = info.format;
    if (info.compression != "none") manifest_.input_format += ", " + info.compression;
    manifest_.skipped = info.skipped;
  }

  void tell(std::string_view phase, std::uint64_t done, std::uint64_t all) const {
    if (options_.stop != nullptr && *options_.stop) {
      throw IncompleteError("the making of streams was interrupted; run the same command again");
    }
    if (options_.progress) {
      options_.progress(phase,
                        all == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(all));
    }
  }

  void choose_order() {
    OrderProbe probe;
    do {
      manifest_.positions = source_.info().positions;
      probe = {};
      manifest_.input_vertices = 0;
      source_.scan_vertices([&](std::span<const Vec3> batch) {
        probe.look_at(batch);
        manifest_.input_vertices += batch.size();
        tell("streams: bounding box", manifest_.input_vertices, source_.info().vertices);
      });
    } while (source_.info().positions != manifest_.positions);
    manifest_.box = probe.box();
    sorting_ = {probe.choose(), options_.weld};
    if (options_.sort == SortAt::farm) manifest_.sorting = sorting_;
  }

  /// As many as asked for, but so many that one fits into half the memory.
  std::uint32_t wanted_streams() const {
    // Polygons and strips hold more triangles than the header tells: vertices are a second hint.
    const MeshFileInfo& info = source_.info();
    const std::uint64_t triangles = std::max(info.faces, info.vertices);
    const std::uint64_t wanted =
        options_.streams != 0 ? options_.streams : default_streams(triangles);
    const std::uint64_t half = std::max<std::uint64_t>(1, options_.memory_bytes / 2);
    const std::uint64_t least = triangles * bytes_per_triangle() / half + 1;
    return static_cast<std::uint32_t>(
        std::min<std::uint64_t>(k_most_streams, std::max(wanted, least)));
  }

  std::uint64_t bytes_per_triangle() const {
    return slab_bytes_per_triangle(has_appearances(source_), source_.info().columns());
  }

  void choose_slabs() {
    slabs_ = std::make_unique<SlabMap>(
        manifest_.box, sorting_.order, wanted_streams(),
        options_.weld == Weld::exact ? AtOnePoint::merge : AtOnePoint::deal);
    do {
      std::uint64_t done = 0;
      source_.scan_vertices([&](std::span<const Vec3> batch) {
        slabs_->count(batch);
        tell("streams: slabs", done += batch.size(), manifest_.input_vertices);
      });
    } while (slabs_->refine());
    streams_ = slabs_->divide();
  }

  void distribute_vertices() {
    const ColumnSet columns = source_.info().columns();
    const std::uint64_t faces = std::max<std::uint64_t>(source_.info().faces, 1);
    const std::uint64_t all = MeshShares::memory_for(
        manifest_.input_vertices, faces, manifest_.positions, has_appearances(source_), columns);
    shares_ = std::make_unique<MeshShares>(
        MeshShares::Options{scratch_folder(options_.scratch, stage_.root(), all), streams_,
                            manifest_.input_vertices, manifest_.positions, 0,
                            MeshShares::SeamsFor::all, has_appearances(source_), columns, faces});
    static_assert(MeshShares::k_no_point == SlabMap::k_no_point);
    std::vector<std::uint32_t> slabs;
    std::vector<std::uint32_t> points;
    std::uint64_t done = 0;
    scan_appearances(source_, [&](const VertexView& batch) {
      slabs.clear();
      points.clear();
      for (const Vec3& p : batch.positions) {
        const SlabMap::Target target =
            has_position(p) ? slabs_->target_of(p) : SlabMap::Target{MeshShares::k_no_share};
        slabs.push_back(target.slab);
        if (slabs_->merges()) points.push_back(target.point);
      }
      shares_->add_vertices(batch, slabs, points);
      tell("streams: vertices", done += batch.size(), manifest_.input_vertices);
    });
    manifest_.coincident_vertices = shares_->merged();
    slabs_.reset();
  }

  void distribute_triangles() {
    source_.scan_triangles([&](const TriangleView& batch) {
      shares_->add_triangles(batch);
      manifest_.input_triangles += batch.size();
      tell("streams: triangles", manifest_.input_triangles, source_.info().faces);
    });
    shares_->finish();
    manifest_.dropped_not_finite = shares_->dropped();
    manifest_.dropped_degenerate = shares_->points_left_out();
    manifest_.coincident_corners = shares_->points_left_out();
  }

  /// As many at once as fit into the memory, going by the average.
  unsigned threads() const {
    const unsigned cores = processors();
    const std::uint64_t of_triangle =
        bytes_per_triangle() + (source_.info().uvs ? k_fact_bytes : 0);
    const std::uint64_t bytes =
        of_triangle * manifest_.input_triangles / std::max<std::uint64_t>(1, streams_);
    const std::uint64_t buffers = std::min(options_.memory_bytes, shares_->buffer_bytes());
    const std::uint64_t fit = (options_.memory_bytes - buffers) / std::max<std::uint64_t>(1, bytes);
    return static_cast<unsigned>(
        std::clamp<std::uint64_t>(fit, 1, options_.threads != 0 ? options_.threads : cores));
  }

  void write_slabs() {
    const bool sorts = options_.sort == SortAt::here;
    manifest_.parts.resize(streams_);
    if (sorts) manifest_.samples.resize(streams_);
    numbers_.resize(streams_);
    uv_facts_.resize(streams_);
    std::mutex mutex;
    std::uint64_t done = 0;
    parallel_for(streams_, threads(), [&](std::uint64_t i) {
      MeshShare slab = shares_->read(static_cast<std::uint32_t>(i), sorting_.weld);
      numbers_[i] = number_boundary(slab, sorting_);
      const std::uint64_t corners =
          count_label_corners(slab.triangles, slab.columns.labels, slab.positions.size());
      sorts ? sort_one(std::move(slab), static_cast<std::uint32_t>(i), mutex)
            : stage_unsorted(std::move(slab), static_cast<std::uint32_t>(i));
      const std::lock_guard lock(mutex);
      manifest_.label_corners += corners;
      tell(sorts ? "streams: sort" : "streams: stage", ++done, streams_);
    });
  }

  void sort_one(MeshShare raw, std::uint32_t number, std::mutex& mutex) {
    SortedSlab slab = sort_slab(std::move(raw), sorting_);
    if (slab.boundary_vertices != numbers_[number].count()) {
      throw Error("a stream's boundary vertices are not those that were numbered");
    }
    manifest_.samples[number] = write_sample(slab.stream, number);
    manifest_.parts[number] = write_stream(slab, number);
    const std::lock_guard lock(mutex);
    manifest_.coincident_vertices += slab.coincident_vertices;
    manifest_.dropped_degenerate += slab.dropped_degenerate;
    manifest_.coincident_corners += slab.coincident_corners;
  }

  void stage_unsorted(MeshShare slab, std::uint32_t number) {
    PartEntry& entry = manifest_.parts[number];
    entry.vertices = slab.positions.size();
    entry.triangles = slab.triangles.size();
    entry.boundary_vertices = numbers_[number].count();
    slab.boundary = numbers_[number].places;
    entry.file = stage_.publish(SlabName{number}, encode_slab(slab));
    if (!slab.columns.uvs.empty()) find_unsorted_facts(std::move(slab), number);
  }

  /// It must be known before the work, so the slab is sorted for it after all.
  void find_unsorted_facts(MeshShare slab, std::uint32_t number) {
    find_facts(encode_stream(sort_slab(std::move(slab), sorting_).stream), number);
  }

  PartEntry write_stream(SortedSlab& slab, std::uint32_t number) {
    PartEntry entry;
    entry.vertices = slab.stream.mesh.positions.size();
    entry.triangles = slab.stream.mesh.triangles.size();
    entry.boundary_vertices = slab.boundary_vertices;
    const std::string bytes = encode_stream(slab.stream);
    slab.stream = {};
    find_facts(bytes, number);
    entry.file = stage_.publish(StreamName{number}, bytes);
    return entry;
  }

  void find_facts(const std::string& stream, std::uint32_t number) {
    if (!source_.info().uvs) return;
    StreamReader reader(fill_from(stream, "stream"), "stream");
    const Part part = read_stream(reader);
    uv_facts_[number] = find_uv_facts(part.mesh, part.boundary_vertices);
  }

  /// Nothing for a short stream: it can be tried as a whole.
  PartEntry write_sample(const StreamMesh& stream, std::uint32_t number) const {
    if (stream.mesh.triangles.size() <= options_.window_triangles) return {};
    const Part part = sample_slab(stream, sorting_.order, number);
    PartEntry entry;
    entry.vertices = part.mesh.positions.size();
    entry.triangles = part.mesh.triangles.size();
    entry.boundary_vertices = part.boundary_vertices;
    entry.file = stage_.publish(PartName{number}, encode_part(part));
    return entry;
  }

  void write_boundary() {
    SharedTriangles shared = shares_->boundary(numbers_);
    std::vector<BoundaryTriangle>& triangles = shared.triangles;
    manifest_.dropped_degenerate += shared.degenerate;
    manifest_.coincident_corners += shared.coincident;
    // As the streams, these are not to tell of the order of the input.
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      const auto least = std::min_element(triangles[i].begin(), triangles[i].end());
      const auto turn = least - triangles[i].begin();
      std::rotate(triangles[i].begin(), least, triangles[i].end());
      if (shared.columns.uvs.empty()) continue;
      CornerUvs& uvs = shared.columns.uvs[i];
      std::rotate(uvs.begin(), uvs.begin() + turn, uvs.end());
    }
    sort_with_columns(triangles, shared.columns);
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
      tell("streams: colours and other channels", done, manifest_.input_vertices);
    });
  }

  MeshSource& source_;
  const Stage& stage_;
  const StreamOptions& options_;
  Manifest manifest_;
  Sorting sorting_;
  std::unique_ptr<SlabMap> slabs_;
  std::uint32_t streams_ = 0;
  std::unique_ptr<MeshShares> shares_;
  std::vector<BoundaryNumbers> numbers_;
  std::vector<UvFacts> uv_facts_;  // of the parts
};

}  // namespace

std::uint32_t default_streams(std::uint64_t triangles) {
  constexpr std::uint64_t k_stream = 1'200'000;
  constexpr std::uint64_t k_worth_dividing = 50'000;
  constexpr std::uint64_t k_few = 16;
  const std::uint64_t streams = std::max((triangles + k_stream - 1) / k_stream,
                                         std::min(k_few, triangles / k_worth_dividing));
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(streams, 1, k_most_streams));
}

Manifest generate_streams(MeshSource& source, const Stage& stage, const StreamOptions& options) {
  return Generator(source, stage, options).run();
}

}  // namespace meshfarm
