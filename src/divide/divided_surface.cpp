// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <memory>
#include <mutex>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include <meshfarm/divide/divided_surface.hpp>
#include <meshfarm/divide/slab.hpp>
#include <meshfarm/util/control_groups.hpp>
#include <meshfarm/util/parallel.hpp>

#include "divide/shared_vertices.hpp"
#include "divide/slab_map.hpp"
#include "divide/topology_sum.hpp"

namespace meshfarm {
namespace {

/// Of the triangles between slabs so many are shown at a time.
constexpr std::size_t k_between_at_once = 100'000;

std::uint64_t slabs_wanted(std::uint64_t triangles, std::uint64_t memory_bytes) {
  // With smaller slabs more would lie between them, which is read twice and more.
  constexpr std::uint64_t k_usual = 2'000'000;
  constexpr std::uint64_t k_most = 65'536;
  const std::uint64_t half = std::max<std::uint64_t>(1, memory_bytes / 2);
  const std::uint64_t least = triangles * k_slab_bytes_per_triangle / half + 1;
  return std::min(k_most, std::max(least, triangles / k_usual + 1));
}

struct Divided {
  std::uint32_t slabs = 0;
  /// Whether many vertices at one point were made one, so that they do not make a slab too large.
  bool merges = false;
  std::unique_ptr<MeshShares> shares;
};

}  // namespace

class DividedSurface::Impl {
 public:
  Impl(MeshSource& source, DivideOptions options) : source_(source), options_(std::move(options)) {
    choose_order();
    welded_ = divide(AtOnePoint::merge);
    if (welded_.merges) as_it_is_ = divide(AtOnePoint::deal);
  }

  const Box& box() const { return box_; }
  std::uint64_t vertices() const { return vertices_; }
  std::uint64_t not_finite() const { return not_finite_; }
  std::uint64_t triangles() const { return triangles_ - welded_.shares->dropped(); }

  SurfaceTopology measure() const {
    std::uint64_t merged = 0;
    SurfaceTopology measured;
    measured.welded = sum_of(welded_, Weld::exact, merged);
    measured.as_it_is = merged == 0 && measured.welded.degenerate == 0
                            ? measured.welded
                            : sum_of(as_it_is(), Weld::off, merged);
    return measured;
  }

  void show(
      const std::function<void(std::span<const Vec3>, std::span<const Triangle>)>& take) const {
    const Divided& divided = as_it_is();
    SharedVertices shared(options_.folder, divided.slabs);
    for (std::uint32_t i = 0; i < divided.slabs; ++i) {
      const MeshShare raw = divided.shares->read(i, Weld::off);
      std::vector<SharedVertex> vertices;
      for (const std::uint32_t v : number_as_they_are(raw).places) {
        vertices.push_back({v, 0, 0, raw.positions[v]});
      }
      shared.add(i, vertices);
      take(raw.positions, raw.triangles);
    }
    shared.finish();
    Mesh between;
    const auto flush = [&] {
      take(between.positions, between.triangles);
      between.positions.clear();
      between.triangles.clear();
    };
    for (std::uint32_t i = 0; i < divided.slabs; ++i) {
      shared.forget_below(i);
      for (const SeamTriangle& t : divided.shares->seam(i)) {
        if (std::min({t[0].share, t[1].share, t[2].share}) != i) continue;
        if (between.triangles.size() == k_between_at_once) flush();
        const auto first = static_cast<std::uint32_t>(between.positions.size());
        for (const SharePlace v : t) between.positions.push_back(shared.at(v).position);
        between.triangles.push_back({first, first + 1, first + 2});
      }
    }
    flush();
  }

 private:
  void choose_order() {
    OrderProbe probe;
    PositionType positions{};
    do {
      positions = source_.info().positions;
      probe = {};
      vertices_ = not_finite_ = 0;
      source_.scan_vertices([&](std::span<const Vec3> batch) {
        probe.look_at(batch);
        vertices_ += batch.size();
        for (const Vec3& p : batch) not_finite_ += has_position(p) ? 0 : 1;
      });
    } while (source_.info().positions != positions);
    box_ = probe.box();
    sorting_ = {probe.choose(), Weld::exact};
  }

  Divided divide(AtOnePoint at_one_point) {
    Divided divided;
    SlabMap map = choose_slabs(at_one_point);
    divided.slabs = map.divide();
    divided.merges = map.merges();
    const MeshFileInfo& info = source_.info();
    const std::uint64_t all = MeshShares::memory_for(vertices_, info.faces, info.positions);
    divided.shares = std::make_unique<MeshShares>(MeshShares::Options{
        options_.folder, divided.slabs, vertices_, info.positions,
        all <= options_.memory_bytes / 4 ? all : 0, MeshShares::SeamsFor::each_share});
    share_out(map, *divided.shares);
    return divided;
  }

  SlabMap choose_slabs(AtOnePoint at_one_point) {
    const MeshFileInfo& info = source_.info();
    const std::uint64_t triangles = std::max(info.faces, info.vertices);
    SlabMap map(box_, sorting_.order,
                static_cast<std::uint32_t>(slabs_wanted(triangles, options_.memory_bytes)),
                at_one_point);
    do {
      source_.scan_vertices([&](std::span<const Vec3> batch) { map.count(batch); });
    } while (map.refine());
    return map;
  }

  void share_out(SlabMap& map, MeshShares& shares) {
    std::vector<std::uint32_t> slabs;
    std::vector<std::uint32_t> points;
    source_.scan_vertices([&](std::span<const Vec3> batch) {
      slabs.clear();
      points.clear();
      for (const Vec3& p : batch) {
        const SlabMap::Target target =
            has_position(p) ? map.target_of(p) : SlabMap::Target{MeshShares::k_no_share};
        slabs.push_back(target.slab);
        if (map.merges()) points.push_back(target.point);
      }
      shares.add_vertices(batch, slabs, points);
    });
    triangles_ = 0;
    source_.scan_triangles([&](std::span<const WideTriangle> batch) {
      shares.add_triangles(batch);
      triangles_ += batch.size();
    });
    shares.finish();
  }

  const Divided& as_it_is() const { return as_it_is_ ? *as_it_is_ : welded_; }

  /// As many at once as fit into the memory, going by the average.
  unsigned threads(std::uint32_t slabs) const {
    const std::uint64_t slab =
        k_slab_bytes_per_triangle * triangles_ / std::max<std::uint64_t>(1, slabs);
    const std::uint64_t fit = options_.memory_bytes / 2 / std::max<std::uint64_t>(1, slab);
    const unsigned most = options_.threads != 0 ? options_.threads : processors();
    return static_cast<unsigned>(std::clamp<std::uint64_t>(fit, 1, most));
  }

  Topology sum_of(const Divided& divided, Weld weld, std::uint64_t& merged) const {
    TopologySum sum(*divided.shares, options_.folder, divided.slabs);
    std::uint64_t degenerate = divided.shares->points_left_out();
    std::mutex mutex;
    if (weld == Weld::exact) merged += divided.shares->merged();
    parallel_for(divided.slabs, threads(divided.slabs), [&](std::uint64_t i) {
      const auto number = static_cast<std::uint32_t>(i);
      MeshShare raw = divided.shares->read(number, weld);
      const BoundaryNumbers numbers =
          weld == Weld::off ? number_as_they_are(raw) : number_boundary(raw, sorting_);
      if (weld == Weld::off) {
        sum.add(number, {{std::move(raw.positions), std::move(raw.triangles)}, numbers.places},
                numbers);
        return;
      }
      SortedSlab slab = sort_slab(std::move(raw), sorting_);
      const StreamMesh& stream = slab.stream;
      MeasuredSlab measured{std::move(slab.stream.mesh), {}};
      for (std::uint32_t v = 0; v < stream.boundary.size(); ++v) {
        if (stream.boundary[v] != 0) measured.shared.push_back(v);
      }
      sum.add(number, measured, numbers);
      const std::lock_guard lock(mutex);
      merged += slab.merged_vertices;
      degenerate += slab.dropped_degenerate;
    });
    Topology topology = sum.finish();
    topology.degenerate += degenerate;
    topology.triangles += degenerate;
    topology.vertices = vertices_ - (weld == Weld::exact ? merged : 0);
    return topology;
  }

  MeshSource& source_;
  DivideOptions options_;
  Box box_;
  Sorting sorting_;
  Divided welded_;
  std::optional<Divided> as_it_is_;  // where it is not welded_
  std::uint64_t vertices_ = 0;
  std::uint64_t not_finite_ = 0;
  std::uint64_t triangles_ = 0;
};

DividedSurface::DividedSurface(MeshSource& source, const DivideOptions& options)
    : impl_(std::make_unique<Impl>(source, options)) {}
DividedSurface::~DividedSurface() = default;
DividedSurface::DividedSurface(DividedSurface&&) noexcept = default;
const Box& DividedSurface::box() const {
  return impl_->box();
}
std::uint64_t DividedSurface::vertices() const {
  return impl_->vertices();
}
std::uint64_t DividedSurface::not_finite() const {
  return impl_->not_finite();
}
std::uint64_t DividedSurface::triangles() const {
  return impl_->triangles();
}
SurfaceTopology DividedSurface::measure_topology() const {
  return impl_->measure();
}
void DividedSurface::show(
    const std::function<void(std::span<const Vec3>, std::span<const Triangle>)>& take) const {
  impl_->show(take);
}

}  // namespace meshfarm
