// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <mutex>
#include <numeric>
#include <utility>

#include <meshfarm/stream/divided_surface.hpp>
#include <meshfarm/stream/slab.hpp>
#include <meshfarm/util/control_groups.hpp>
#include <meshfarm/util/parallel.hpp>

#include "stream/sweep_order.hpp"

namespace meshfarm {
namespace {

/// A slab as it is measured: what its boundary vertices are, in the order of their numbers.
struct MeasuredSlab {
  Mesh mesh;
  std::vector<std::uint32_t> shared;
};

/// Of the triangles between slabs so many are shown at a time.
constexpr std::size_t k_between_at_once = 100'000;

/// A boundary vertex: its slab and its number there.
using SideEnds = std::array<BoundaryCorner, 2>;

std::uint64_t slabs_wanted(std::uint64_t triangles, std::uint64_t memory_bytes) {
  // With smaller slabs more would lie between them, which is kept in memory.
  constexpr std::uint64_t k_usual = 2'000'000;
  constexpr std::uint64_t k_most = 65'536;
  const std::uint64_t half = std::max<std::uint64_t>(1, memory_bytes / 2);
  const std::uint64_t least = triangles * k_slab_bytes_per_triangle / half + 1;
  return std::min(k_most, std::max(least, triangles / k_usual + 1));
}

/// Adds up what the slabs tell and what lies between them.
class TopologySum {
 public:
  TopologySum(std::vector<BoundaryTriangle> between, std::size_t slabs)
      : between_(std::move(between)), slabs_(slabs), sides_(slabs) {
    crossing_.reserve(2 * between_.size());
    for (const BoundaryTriangle& t : between_) {
      for (std::size_t k = 0; k < 3; ++k) add_side(t[k], t[(k + 1) % 3]);
    }
  }

  /// From several threads, each slab once.
  void add(std::uint32_t number, const MeasuredSlab& slab) {
    std::vector<std::array<std::uint32_t, 2>> sides;
    sides.swap(sides_[number]);
    for (auto& [a, b] : sides) {
      a = slab.shared[a];
      b = slab.shared[b];
    }
    PieceTopology piece = measure_piece(slab.mesh, sides, slab.shared);
    Slab& kept = slabs_[number];
    kept.roots = std::move(piece.roots);
    for (const std::uint32_t v : slab.shared) kept.positions.push_back(slab.mesh.positions[v]);
    const std::lock_guard lock(mutex_);
    add(piece.topology);
  }

  Topology finish() {
    count_crossing_sides();
    join_components();
    count_triangles_between();
    sum_.euler = static_cast<std::int64_t>(sum_.used_vertices - sum_.edges + sum_.triangles -
                                           sum_.degenerate);
    return sum_;
  }

 private:
  /// Of the shared vertices, by their numbers.
  struct Slab {
    std::vector<std::uint32_t> roots;
    std::vector<Vec3> positions;
  };

  void add_side(BoundaryCorner a, BoundaryCorner b) {
    if (a.part == b.part) {
      sides_[a.part].push_back({a.local, b.local});
    } else {
      crossing_.push_back({a, b});
    }
  }

  void add(const Topology& t) {
    sum_.used_vertices += t.used_vertices;
    sum_.triangles += t.triangles;
    sum_.degenerate += t.degenerate;
    sum_.zero_area += t.zero_area;
    sum_.duplicate += t.duplicate;
    sum_.edges += t.edges;
    sum_.border_edges += t.border_edges;
    sum_.nonmanifold_edges += t.nonmanifold_edges;
    sum_.orientation_conflicts += t.orientation_conflicts;
    sum_.components += t.components;
  }

  void count_crossing_sides() {
    const auto ordered = [](const SideEnds& side) {
      return std::pair(std::min(side[0], side[1]), std::max(side[0], side[1]));
    };
    std::sort(crossing_.begin(), crossing_.end(), [&](const SideEnds& x, const SideEnds& y) {
      return ordered(x) != ordered(y) ? ordered(x) < ordered(y) : x < y;
    });
    for (std::size_t first = 0, last = 0; first < crossing_.size(); first = last) {
      std::size_t up = 0;
      for (; last < crossing_.size() && ordered(crossing_[last]) == ordered(crossing_[first]);
           ++last) {
        up += crossing_[last][0] < crossing_[last][1] ? 1 : 0;
      }
      const std::size_t down = last - first - up;
      ++sum_.edges;
      sum_.border_edges += up + down == 1;
      sum_.nonmanifold_edges += up + down > 2;
      sum_.orientation_conflicts += (up > 1 ? up - 1 : 0) + (down > 1 ? down - 1 : 0);
    }
    crossing_ = {};
  }

  /// Components that triangles between slabs join.
  void join_components() {
    std::vector<BoundaryCorner> nodes;  // slab and root
    for (std::uint32_t s = 0; s < slabs_.size(); ++s) {
      std::vector<std::uint32_t> roots = slabs_[s].roots;
      std::sort(roots.begin(), roots.end());
      roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
      for (const std::uint32_t root : roots) nodes.push_back({s, root});
    }
    const auto node = [&](BoundaryCorner c) {
      return BoundaryCorner{c.part, slabs_[c.part].roots[c.local]};
    };
    std::vector<std::size_t> parent(nodes.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto find = [&](BoundaryCorner c) {
      const auto at = std::lower_bound(nodes.begin(), nodes.end(), node(c));
      auto i = static_cast<std::size_t>(at - nodes.begin());
      while (parent[i] != i) i = parent[i] = parent[parent[i]];
      return i;
    };
    for (const BoundaryTriangle& t : between_) {
      for (std::size_t k = 1; k < 3; ++k) {
        const std::size_t a = find(t[0]);
        const std::size_t b = find(t[k]);
        if (a == b) continue;
        parent[std::max(a, b)] = std::min(a, b);
        --sum_.components;
      }
    }
  }

  void count_triangles_between() {
    sum_.triangles += between_.size();
    const auto position = [&](BoundaryCorner c) { return slabs_[c.part].positions[c.local]; };
    for (const BoundaryTriangle& t : between_) {
      const Vec3 a = position(t[0]);
      sum_.zero_area += cross(position(t[1]) - a, position(t[2]) - a) == Vec3{} ? 1 : 0;
    }
    sum_.duplicate += drop_duplicates(between_);
  }

  std::vector<BoundaryTriangle> between_;
  std::vector<Slab> slabs_;
  std::vector<std::vector<std::array<std::uint32_t, 2>>> sides_;  // within a slab
  std::vector<SideEnds> crossing_;                                // from one to another
  Topology sum_;
  std::mutex mutex_;
};

/// The numbers of boundary vertices where none is welded.
BoundaryNumbers number_as_they_are(const MeshShare& raw) {
  BoundaryNumbers made;
  made.places = raw.boundary;
  std::sort(made.places.begin(), made.places.end());
  made.places.erase(std::unique(made.places.begin(), made.places.end()), made.places.end());
  made.numbers.resize(made.places.size());
  std::iota(made.numbers.begin(), made.numbers.end(), 0U);
  return made;
}

}  // namespace

class DividedSurface::Impl {
 public:
  Impl(MeshSource& source, DivideOptions options) : source_(source), options_(std::move(options)) {
    choose_order();
    choose_slabs();
    distribute();
  }

  const Box& box() const { return box_; }
  std::uint64_t vertices() const { return vertices_; }
  std::uint64_t not_finite() const { return not_finite_; }
  std::uint64_t triangles() const { return triangles_ - shares_->dropped(); }

  SurfaceTopology measure() const {
    std::uint64_t merged = 0;
    SurfaceTopology measured;
    measured.welded = sum_of(Weld::exact, merged);
    measured.as_it_is = merged == 0 && measured.welded.degenerate == 0 ? measured.welded
                                                                       : sum_of(Weld::off, merged);
    return measured;
  }

  void show(
      const std::function<void(std::span<const Vec3>, std::span<const Triangle>)>& take) const {
    std::vector<BoundaryNumbers> numbers(slabs_);
    std::vector<std::vector<Vec3>> shared(slabs_);
    for (std::uint32_t i = 0; i < slabs_; ++i) {
      const MeshShare raw = shares_->read(i);
      numbers[i] = number_as_they_are(raw);
      for (const std::uint32_t v : numbers[i].places) shared[i].push_back(raw.positions[v]);
      take(raw.positions, raw.triangles);
    }
    std::uint64_t degenerate = 0;
    Mesh between;
    const auto flush = [&] {
      take(between.positions, between.triangles);
      between.positions.clear();
      between.triangles.clear();
    };
    for (const BoundaryTriangle& t : shares_->boundary(numbers, degenerate)) {
      if (between.triangles.size() == k_between_at_once) flush();
      const auto first = static_cast<std::uint32_t>(between.positions.size());
      for (const BoundaryCorner& c : t) between.positions.push_back(shared[c.part][c.local]);
      between.triangles.push_back({first, first + 1, first + 2});
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

  void choose_slabs() {
    const MeshFileInfo& info = source_.info();
    const std::uint64_t triangles = std::max(info.faces, info.vertices);
    map_ = std::make_unique<SlabMap>(
        box_, sorting_.order,
        static_cast<std::uint32_t>(slabs_wanted(triangles, options_.memory_bytes)),
        AtOnePoint::stay);
    do {
      source_.scan_vertices([&](std::span<const Vec3> batch) { map_->count(batch); });
    } while (map_->refine());
    slabs_ = map_->divide();
  }

  void distribute() {
    const MeshFileInfo& info = source_.info();
    const std::uint64_t all = MeshShares::memory_for(vertices_, info.faces, info.positions);
    shares_ = std::make_unique<MeshShares>(
        MeshShares::Options{options_.folder, slabs_, vertices_, info.positions,
                            all <= options_.memory_bytes / 4 ? all : 0});
    std::vector<std::uint32_t> slabs;
    source_.scan_vertices([&](std::span<const Vec3> batch) {
      slabs.clear();
      for (const Vec3& p : batch) {
        slabs.push_back(has_position(p) ? map_->target_of(p).slab : MeshShares::k_no_share);
      }
      shares_->add_vertices(batch, slabs);
    });
    map_.reset();
    source_.scan_triangles([&](std::span<const WideTriangle> batch) {
      shares_->add_triangles(batch);
      triangles_ += batch.size();
    });
    shares_->finish();
  }

  /// As many at once as fit into the memory, going by the average.
  unsigned threads() const {
    const std::uint64_t slab =
        k_slab_bytes_per_triangle * triangles_ / std::max<std::uint64_t>(1, slabs_);
    const std::uint64_t fit = options_.memory_bytes / 2 / std::max<std::uint64_t>(1, slab);
    const unsigned most = options_.threads != 0 ? options_.threads : processors();
    return static_cast<unsigned>(std::clamp<std::uint64_t>(fit, 1, most));
  }

  /// Boundary vertices are numbered first, as a slab's edges are counted with those of triangles
  /// that lie in it in part.
  Topology sum_of(Weld weld, std::uint64_t& merged) const {
    std::vector<BoundaryNumbers> numbers(slabs_);
    parallel_for(slabs_, threads(), [&](std::uint64_t i) {
      const MeshShare raw = shares_->read(static_cast<std::uint32_t>(i));
      numbers[i] = weld == Weld::off ? number_as_they_are(raw) : number_boundary(raw, sorting_);
    });
    std::uint64_t degenerate = 0;
    TopologySum sum(shares_->boundary(numbers, degenerate), slabs_);
    std::mutex mutex;
    parallel_for(slabs_, threads(), [&](std::uint64_t i) {
      MeshShare raw = shares_->read(static_cast<std::uint32_t>(i));
      if (weld == Weld::off) {
        sum.add(static_cast<std::uint32_t>(i),
                {{std::move(raw.positions), std::move(raw.triangles)}, numbers[i].places});
        return;
      }
      SortedSlab slab = sort_slab(std::move(raw), sorting_);
      const StreamMesh& stream = slab.stream;
      MeasuredSlab measured{std::move(slab.stream.mesh), {}};
      for (std::uint32_t v = 0; v < stream.boundary.size(); ++v) {
        if (stream.boundary[v] != 0) measured.shared.push_back(v);
      }
      sum.add(static_cast<std::uint32_t>(i), measured);
      const std::lock_guard lock(mutex);
      merged += slab.coincident_vertices;
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
  std::unique_ptr<SlabMap> map_;
  std::uint32_t slabs_ = 0;
  std::unique_ptr<MeshShares> shares_;
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
