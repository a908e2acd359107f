// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/seam_vertices.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <tuple>
#include <utility>

#include <meshfarm/geometry/place_hash.hpp>

namespace meshfarm {
namespace {

constexpr std::uint32_t k_no_vertex = UINT32_MAX;

/// A cheap hash for filtering out most vertices; its high bits are the better ones.
std::uint64_t quick_hash_of(Vec3 position) {
  const PlaceKey key(position);
  return key.x * 0x9e3779b97f4a7c15U + key.y * 0xd6e8feb86659fd93U + key.z * 0xa0761d6478bd642fU;
}

/// The boundary vertices and all others at their points, ascending, with a few false positives.
std::vector<std::uint32_t> near_boundary(const MeshShare& share) {
  const int shift = 64 - static_cast<int>(std::bit_width(share.boundary.size() * 16));
  std::vector<bool> hashes(std::size_t{1} << (64 - shift), false);
  const auto slot = [&](std::uint32_t v) { return quick_hash_of(share.positions[v]) >> shift; };
  for (const std::uint32_t v : share.boundary) hashes[slot(v)] = true;
  std::vector<std::uint32_t> near;
  for (std::uint32_t v = 0; v < share.positions.size(); ++v) {
    if (hashes[slot(v)]) near.push_back(v);
  }
  return near;
}

/// Vertices at points that several vertices share, among them a boundary vertex.
class Twins {
 public:
  explicit Twins(const MeshShare& share) : share_(share) { find(); }

  bool empty() const { return vertices_.empty(); }
  bool has(std::uint32_t place) const { return index_[place] != k_no_vertex; }

  /// Keeps points whose vertices all have enough triangles for a closed fan.
  void keep_fans(std::uint32_t number, std::span<const SeamTriangle> outer) {
    constexpr std::uint32_t k_least = 3;
    std::vector<std::uint32_t> triangles(vertices_.size(), 0);
    const auto count = [&](std::uint32_t place) {
      if (has(place)) ++triangles[index_[place]];
    };
    for (const Triangle& t : share_.triangles) {
      for (const std::uint32_t v : t) count(v);
    }
    for (const SeamTriangle& t : outer) {
      for (const SharePlace& corner : t) {
        if (corner.share == number) count(corner.place);
      }
    }
    std::vector<std::uint8_t> is_poor(vertices_.size(), 0);  // at a point's first vertex
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      if (triangles[i] < k_least) is_poor[first_[i]] = 1;
    }
    keep([&](std::size_t i) { return is_poor[first_[i]] == 0; });
  }

 private:
  void find() {
    if (share_.boundary.empty()) return;
    vertices_ = near_boundary(share_);
    std::vector<Vec3> positions;
    positions.reserve(vertices_.size());
    for (const std::uint32_t v : vertices_) positions.push_back(share_.positions[v]);
    WeldResult welded = weld(positions);
    first_ = std::move(welded.first);
    index_.assign(welded.merged == 0 ? 0 : share_.positions.size(), k_no_vertex);
    if (welded.merged == 0) {
      vertices_.clear();
      return;
    }
    number_them();
    std::vector<std::uint8_t> wanted(vertices_.size(), 0);  // at a point's first vertex
    constexpr std::uint8_t k_twins = 1;
    constexpr std::uint8_t k_boundary = 2;
    for (std::size_t i = 0; i < first_.size(); ++i) {
      if (first_[i] != i) wanted[first_[i]] |= k_twins;
    }
    for (const std::uint32_t v : share_.boundary) wanted[first_[index_[v]]] |= k_boundary;
    keep([&](std::size_t i) { return wanted[first_[i]] == (k_twins | k_boundary); });
  }

  void number_them() {
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      index_[vertices_[i]] = static_cast<std::uint32_t>(i);
    }
  }

  /// Keeps all vertices of a point or none, so the first of each point remains the first.
  template <class Wanted>
  void keep(const Wanted& wanted) {
    std::vector<std::uint32_t> now(vertices_.size(), k_no_vertex);
    std::uint32_t kept = 0;
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      index_[vertices_[i]] = k_no_vertex;
      if (!wanted(i)) continue;
      now[i] = kept;
      vertices_[kept] = vertices_[i];
      first_[kept++] = now[first_[i]];
    }
    vertices_.resize(kept);
    first_.resize(kept);
    number_them();
  }

  const MeshShare& share_;
  std::vector<std::uint32_t> vertices_;  // ascending
  std::vector<std::uint32_t> first_;     // for each vertex the first at its point, both by index
  std::vector<std::uint32_t> index_;     // by vertex of the share
};

/// The triangles at the twins, as a separate mesh in which each twin has all of its triangles.
class TwinStars {
 public:
  TwinStars(const MeshShare& share, std::uint32_t number, const Twins& twins)
      : share_(share), number_(number), twins_(twins) {}

  void gather(std::span<const SeamTriangle> outer,
              const std::function<Vec3(SharePlace)>& position_of) {
    std::vector<SeamTriangle> triangles;
    for (const auto& [a, b, c] : share_.triangles) {
      if (!twins_.has(a) && !twins_.has(b) && !twins_.has(c)) continue;
      triangles.push_back({{{number_, a}, {number_, b}, {number_, c}}});
    }
    for (const SeamTriangle& t : outer) {
      if (std::any_of(t.begin(), t.end(), [&](SharePlace v) { return is_twin(v); })) {
        triangles.push_back(t);
      }
    }
    for (const SeamTriangle& t : triangles) vertices_.insert(vertices_.end(), t.begin(), t.end());
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
    for (const SharePlace v : vertices_) {
      mesh_.positions.push_back(v.share == number_ ? share_.positions[v.place] : position_of(v));
    }
    for (const auto& [a, b, c] : triangles) {
      mesh_.triangles.push_back({index(a), index(b), index(c)});
    }
  }

  std::vector<ApartVertex> separate() {
    std::vector<std::uint32_t> open;
    for (std::uint32_t v = 0; v < vertices_.size(); ++v) {
      if (!is_twin(vertices_[v])) open.push_back(v);
    }
    WeldResult welded = weld(mesh_.positions);
    const std::vector<std::uint32_t> point = welded.first;
    separate_touching(mesh_.triangles, open, welded);
    std::vector<std::uint8_t> is_parted(point.size(), 0);
    for (std::uint32_t v = 0; v < point.size(); ++v) {
      if (welded.first[v] != point[v]) is_parted[point[v]] = 1;
    }
    const std::vector<std::uint32_t> sheet = number_sheets(welded.first, point, is_parted);
    std::vector<ApartVertex> apart;
    for (std::uint32_t v = 0; v < point.size(); ++v) {
      if (is_parted[point[v]] != 0) apart.push_back({vertices_[v].place, sheet[welded.first[v]]});
    }
    return apart;
  }

 private:
  bool is_twin(SharePlace v) const { return v.share == number_ && twins_.has(v.place); }
  std::uint32_t index(SharePlace v) const {
    return static_cast<std::uint32_t>(std::lower_bound(vertices_.begin(), vertices_.end(), v) -
                                      vertices_.begin());
  }

  /// A triangle at a corner, given by the positions of its other two corners.
  using Wedge = std::array<double, 6>;
  struct Sheet {
    std::uint32_t point = 0;
    std::uint32_t first = 0;
    std::vector<Wedge> star;
  };

  /// For the first vertex of each sheet its number: the sheets of a point are ordered by their
  /// stars.
  std::vector<std::uint32_t> number_sheets(const std::vector<std::uint32_t>& first,
                                           const std::vector<std::uint32_t>& point,
                                           const std::vector<std::uint8_t>& is_parted) const {
    std::vector<std::uint32_t> number(first.size(), k_no_vertex);
    std::vector<Sheet> sheets;
    for (std::uint32_t v = 0; v < first.size(); ++v) {
      if (first[v] != v || is_parted[point[v]] == 0) continue;
      number[v] = static_cast<std::uint32_t>(sheets.size());
      sheets.push_back({point[v], v, {}});
    }
    for (const Triangle& t : mesh_.triangles) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t n = number[first[t[i]]];
        if (n == k_no_vertex) continue;
        const Vec3 a = mesh_.positions[t[(i + 1) % 3]];
        const Vec3 b = mesh_.positions[t[(i + 2) % 3]];
        sheets[n].star.push_back({a.x, a.y, a.z, b.x, b.y, b.z});
      }
    }
    for (Sheet& sheet : sheets) std::sort(sheet.star.begin(), sheet.star.end());
    std::stable_sort(sheets.begin(), sheets.end(), [](const Sheet& a, const Sheet& b) {
      return std::tie(a.point, a.star) < std::tie(b.point, b.star);
    });
    for (std::uint32_t n = 0; n < sheets.size(); ++n) number[sheets[n].first] = n;
    return number;
  }

  const MeshShare& share_;
  std::uint32_t number_;
  const Twins& twins_;
  std::vector<SharePlace> vertices_;
  Mesh mesh_;
};

}  // namespace

std::uint32_t sheet_of(std::uint32_t place, std::span<const ApartVertex> apart) {
  const auto at =
      std::lower_bound(apart.begin(), apart.end(), place,
                       [](const ApartVertex& v, std::uint32_t wanted) { return v.place < wanted; });
  return at != apart.end() && at->place == place ? at->sheet : k_no_sheet;
}

std::vector<ApartVertex> find_apart(const MeshShare& share, std::uint32_t number,
                                    std::span<const SeamTriangle> outer,
                                    const std::function<Vec3(SharePlace)>& position_of) {
  Twins twins(share);
  if (!twins.empty()) twins.keep_fans(number, outer);
  if (twins.empty()) return {};
  TwinStars stars(share, number, twins);
  stars.gather(outer, position_of);
  return stars.separate();
}

}  // namespace meshfarm
