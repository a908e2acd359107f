// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <mutex>
#include <utility>
#include <vector>

#include <meshfarm/geometry/merge_near.hpp>
#include <meshfarm/geometry/near_misses.hpp>
#include <meshfarm/io/near_vertices.hpp>
#include <meshfarm/util/bucket_file.hpp>
#include <meshfarm/util/control_groups.hpp>
#include <meshfarm/util/file.hpp>
#include <meshfarm/util/parallel.hpp>

#include "scratch_array.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_slab_vertices = std::uint64_t{1} << 20;
constexpr unsigned k_most_threads = 8;
constexpr std::size_t k_bins = 65'536;
/// What a slab sees of its neighbours, in units of the distance: what becomes of a vertex hardly
/// ever depends on vertices that are farther away.
constexpr double k_slab_margin = 8;

/// Slabs across the longest side of the box with at most k_slab_vertices each, if no bin has more.
class Slabs {
 public:
  explicit Slabs(const Box& box) {
    const Vec3 size = box.hi - box.lo;
    axis_ = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    from_ = box.lo[axis_];
    scale_ = size[axis_] > 0 ? k_bins / size[axis_] : 0;
    counts_.resize(k_bins);
    slab_of_.resize(k_bins);
  }
  void count(Vec3 p) { ++counts_[bin(p[axis_])]; }
  void divide() {
    std::uint64_t inside = 0;
    for (std::size_t i = 0; i < k_bins; ++i) {
      if (inside > 0 && inside + counts_[i] > k_slab_vertices) {
        ++last_;
        inside = 0;
      }
      inside += counts_[i];
      slab_of_[i] = last_;
    }
  }
  std::uint32_t size() const { return last_ + 1; }
  std::uint32_t of(Vec3 p) const { return slab_of_[bin(p[axis_])]; }
  /// The first and the last slab that a vertex moved by up to `margin` could be in.
  std::pair<std::uint32_t, std::uint32_t> near(Vec3 p, double margin) const {
    return {slab_of_[bin(p[axis_] - margin)], slab_of_[bin(p[axis_] + margin)]};
  }

 private:
  std::size_t bin(double x) const {
    return static_cast<std::size_t>(std::clamp((x - from_) * scale_, 0.0, k_bins - 1.0));
  }

  int axis_ = 0;
  double from_ = 0;
  double scale_ = 0;
  std::uint32_t last_ = 0;
  std::vector<std::uint64_t> counts_;  // by bin
  std::vector<std::uint32_t> slab_of_;
};

/// The positions of all vertices, by number, in the type of the file.
template <class Real>
class RealPositions {
 public:
  using Row = std::array<Real, 3>;
  static Row row(Vec3 p) {
    return {static_cast<Real>(p.x), static_cast<Real>(p.y), static_cast<Real>(p.z)};
  }
  static Vec3 point(const Row& row) { return {row[0], row[1], row[2]}; }

  explicit RealPositions(std::uint64_t vertices) : rows_(vertices) {}

  std::uint64_t size() { return rows_.size(); }
  void put(std::uint64_t vertex, Vec3 p) {
    rows_.items()[vertex] = row(p);
    rows_.used(1);
  }
  void read(std::uint64_t first, std::size_t count, std::vector<Vec3>& to) {
    to.clear();
    for (const Row& row : rows_.items().subspan(first, count)) to.push_back(point(row));
    rows_.used(count);
  }

 private:
  ScratchArray<Row> rows_;
};

/// Finds the new positions slab by slab.
template <class Real>
class Merger {
 public:
  Merger(MeshSource& source, const Box& box, const NearMerging& options)
      : source_(source), slabs_(box), options_(options) {}

  RealPositions<Real> run() {
    count();
    slabs_.divide();
    BucketFile buckets(temporary_folder(), slabs_.size(), k_in_memory);
    RealPositions<Real> merged(vertices_);
    deal(buckets, merged);
    buckets.finish();
    std::uint32_t started = 0;
    parallel_for(slabs_.size(), threads(), [&](std::uint64_t slab) {
      {
        const std::lock_guard lock(mutex_);
        tell(0.5 + 0.5 * started++ / slabs_.size());
      }
      const std::vector<Dealt> placed = merge(static_cast<std::uint32_t>(slab), buckets);
      const std::lock_guard lock(mutex_);
      for (const Dealt& d : placed) merged.put(d.vertex, RealPositions<Real>::point(d.position));
    });
    return merged;
  }
  std::uint64_t moved() const { return moved_; }

 private:
  static constexpr std::uint64_t k_in_memory = std::uint64_t{64} << 20;
#pragma pack(push, 4)
  struct Dealt {
    std::uint64_t vertex = 0;
    typename RealPositions<Real>::Row position{};
  };
#pragma pack(pop)

  unsigned threads() const {
    return std::min(options_.threads == 0 ? processors() : options_.threads, k_most_threads);
  }

  void tell(double done) const {
    if (options_.progress) options_.progress(done);
  }

  void count() {
    source_.scan_vertices([&](std::span<const Vec3> batch) {
      for (const Vec3& p : batch) {
        if (has_position(p)) slabs_.count(p);
      }
      vertices_ += batch.size();
      tell(0.2 * part_of_scan(vertices_));
    });
  }

  void deal(BucketFile& buckets, RealPositions<Real>& merged) {
    std::uint64_t vertex = 0;
    source_.scan_vertices([&](std::span<const Vec3> batch) {
      for (const Vec3& p : batch) {
        if (has_position(p)) {
          const auto [first, last] = slabs_.near(p, k_slab_margin * options_.distance);
          for (std::uint32_t slab = first; slab <= last; ++slab) {
            buckets.put(slab, Dealt{vertex, RealPositions<Real>::row(p)});
          }
        } else {
          merged.put(vertex, p);
        }
        ++vertex;
      }
      tell(0.2 + 0.3 * part_of_scan(vertex));
    });
  }

  /// The slab's vertices at their new positions.
  std::vector<Dealt> merge(std::uint32_t slab, const BucketFile& buckets) {
    std::vector<Dealt> dealt = buckets.template read<Dealt>(slab);
    std::vector<Vec3> points;
    points.reserve(dealt.size());
    for (const Dealt& d : dealt) points.push_back(RealPositions<Real>::point(d.position));
    const std::vector<std::uint32_t> taken = merge_near(points, options_.distance);
    std::size_t kept = 0;
    std::uint64_t moved = 0;
    for (std::size_t i = 0; i < dealt.size(); ++i) {
      if (slabs_.of(points[i]) != slab) continue;
      const Vec3 p = points[taken[i]];
      moved += p == points[i] ? 0 : 1;
      dealt[kept++] = {dealt[i].vertex, RealPositions<Real>::row(p)};
    }
    dealt.resize(kept);
    moved_ += moved;
    return dealt;
  }

  double part_of_scan(std::uint64_t vertices) const {
    return static_cast<double>(vertices) /
           static_cast<double>(std::max(source_.info().vertices, vertices));
  }

  MeshSource& source_;
  Slabs slabs_;
  const NearMerging& options_;
  std::uint64_t vertices_ = 0;
  std::atomic<std::uint64_t> moved_ = 0;
  std::mutex mutex_;  // of what is told and stored
};

template <class Real>
class NearMergedSource : public MeshSource {
 public:
  NearMergedSource(std::unique_ptr<MeshSource> source, RealPositions<Real> positions,
                   NearMerges merges)
      : source_(std::move(source)), positions_(std::move(positions)), info_(source_->info()) {
    info_.near_merges = merges;
  }

  const MeshFileInfo& info() const override { return info_; }
  void scan_vertices(const std::function<void(std::span<const Vec3>)>& take) override {
    constexpr std::uint64_t k_batch = 8192;
    std::vector<Vec3> batch;
    for (std::uint64_t done = 0; done < positions_.size(); done += batch.size()) {
      positions_.read(done, std::min(k_batch, positions_.size() - done), batch);
      take(batch);
    }
  }
  void scan_triangles(const std::function<void(const TriangleView&)>& take) override {
    source_->scan_triangles(take);
  }
  void scan_channels(const std::function<void(const ChannelPoints&)>& take) override {
    std::uint64_t done = 0;
    std::vector<Vec3> points;
    source_->scan_channels([&](const ChannelPoints& batch) {
      positions_.read(done, batch.points.size(), points);
      done += batch.points.size();
      take({points, batch.values});
    });
  }
  std::uint64_t small_faces() const override { return source_->small_faces(); }

 private:
  std::unique_ptr<MeshSource> source_;
  RealPositions<Real> positions_;
  MeshFileInfo info_;
};

template <class Real>
std::unique_ptr<MeshSource> merged_source(std::unique_ptr<MeshSource> source, const Box& box,
                                          const NearMerging& options) {
  Merger<Real> merger(*source, box, options);
  RealPositions<Real> positions = merger.run();
  return std::make_unique<NearMergedSource<Real>>(std::move(source), std::move(positions),
                                                  NearMerges{options.distance, merger.moved()});
}

}  // namespace

Box vertex_box(MeshSource& source) {
  Box box;
  PositionType positions{};
  do {
    positions = source.info().positions;
    box = {};
    source.scan_vertices([&](std::span<const Vec3> batch) {
      for (const Vec3& p : batch) box.add(p);
    });
  } while (source.info().positions != positions);
  return box;
}

bool may_have_near_misses(const MeshFileInfo& info) {
  // A closed surface of triangles has half as many vertices as faces.
  constexpr double k_per_face = 0.6;
  return static_cast<double>(info.vertices) > k_per_face * static_cast<double>(info.faces);
}

double find_near_misses(MeshSource& source, const Box& box) {
  NearMisses misses(box);
  source.scan_vertices([&](std::span<const Vec3> batch) { misses.add(batch); });
  if (!misses.look()) return 0;
  source.scan_triangles([&](const TriangleView& batch) { misses.add(batch.corners); });
  return misses.distance();
}

std::unique_ptr<MeshSource> with_near_merged(std::unique_ptr<MeshSource> source, const Box& box,
                                             const NearMerging& options) {
  if (box.empty()) return source;
  return source->info().positions == PositionType::float64
             ? merged_source<double>(std::move(source), box, options)
             : merged_source<float>(std::move(source), box, options);
}

}  // namespace meshfarm
