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
#include <meshfarm/util/parallel.hpp>

#include "divide/share_budget.hpp"
#include "divide/share_out.hpp"
#include "divide/shared_vertices.hpp"
#include "divide/slab_map.hpp"
#include "divide/topology_sum.hpp"

namespace meshfarm {
namespace {

/// Number of triangles between slabs that are shown at a time.
constexpr std::size_t k_between_at_once = 100'000;

/// Smaller slabs would have more triangles between them, which are read at least twice.
constexpr std::uint64_t k_usual_slab = 2'000'000;

struct Divided {
  std::uint32_t slabs = 0;
  /// Whether vertices at crowded points were merged, so that they do not make a slab too large.
  bool merges = false;
  std::unique_ptr<MeshShares> shares;
};

}  // namespace

class DividedSurface::Impl {
 public:
  Impl(MeshSource& source, DivideOptions options) : source_(source), options_(std::move(options)) {
    survey();
    welded_ = divide(AtOnePoint::merge);
    if (welded_.merges) as_it_is_ = divide(AtOnePoint::deal);
  }

  const VertexSurvey& found() const { return survey_; }
  std::uint64_t triangles() const { return triangles_ - dropped(); }
  std::uint64_t dropped() const { return welded_.shares->dropped(); }

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
      for (const std::uint32_t v : boundary_places(raw.boundary)) {
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
  void survey() {
    OrderProbe probe;
    survey_ = survey_vertices(source_, &probe, {});
    sorting_ = {probe.choose(survey_.box), Weld::exact};
  }

  Divided divide(AtOnePoint at_one_point) {
    const MeshFileInfo& info = source_.info();
    const std::uint64_t triangles = likely_triangles(info);
    const ShareBudget budget{options_.memory_bytes, k_slab_bytes_per_triangle};
    auto map = std::make_unique<SlabMap>(survey_.box, sorting_.order,
                                         budget.slabs(triangles, triangles / k_usual_slab + 1),
                                         at_one_point);
    Divided divided;
    divided.slabs = settle(*map, source_, survey_.vertices, {});
    divided.merges = map->merges();
    MeshShares::Options options{.folder = options_.folder,
                                .shares = divided.slabs,
                                .vertices = survey_.vertices,
                                .positions = survey_.positions,
                                .seams = MeshShares::SeamsFor::shares,
                                .triangles = info.faces};
    const std::uint64_t all = MeshShares::memory_for(options);
    if (all <= options_.memory_bytes / 4) options.memory_bytes = all;
    SharedMesh shared = share_out(source_, std::move(map), options, {});
    divided.shares = std::move(shared.shares);
    triangles_ = shared.triangles;
    return divided;
  }

  const Divided& as_it_is() const { return as_it_is_ ? *as_it_is_ : welded_; }

  /// The other half of the memory is for what lies between slabs.
  unsigned threads(std::uint32_t slabs) const {
    const ShareBudget budget{options_.memory_bytes / 2, k_slab_bytes_per_triangle};
    return budget.threads(triangles_, slabs, options_.threads);
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
    topology.vertices = survey_.vertices - (weld == Weld::exact ? merged : 0);
    return topology;
  }

  MeshSource& source_;
  DivideOptions options_;
  VertexSurvey survey_;
  Sorting sorting_;
  Divided welded_;
  std::optional<Divided> as_it_is_;  // empty if the same as welded_
  std::uint64_t triangles_ = 0;
};

DividedSurface::DividedSurface(MeshSource& source, const DivideOptions& options)
    : impl_(std::make_unique<Impl>(source, options)) {}
DividedSurface::~DividedSurface() = default;
DividedSurface::DividedSurface(DividedSurface&&) noexcept = default;
const Box& DividedSurface::box() const {
  return impl_->found().box;
}
std::uint64_t DividedSurface::vertices() const {
  return impl_->found().vertices;
}
std::uint64_t DividedSurface::not_finite() const {
  return impl_->found().not_finite;
}
std::uint64_t DividedSurface::dropped() const {
  return impl_->dropped();
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
