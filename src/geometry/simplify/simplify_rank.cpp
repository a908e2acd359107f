// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "geometry/simplify/simplify_rank.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "geometry/simplify/collapse.hpp"
#include "geometry/simplify/vertex_flags.hpp"

namespace meshfarm {
namespace {

// Edges whose costs differ by less than 3 % are taken in vertex order, which costs nothing
// measurable and walks through memory in order.
constexpr unsigned k_bucket_shift = 15;
std::uint32_t bucket_of(CostKey key) {
  return key >> k_bucket_shift;
}

// About 12,000 edges determine the rank to half a per cent.
constexpr std::uint32_t k_sampled_vertices = 4096;
constexpr std::uint64_t k_least_sample = 2000;

// A key holds the sign, the eleven bits of the exponent, and the first bits of the fraction.
constexpr int k_exponent_shift = 20;

// Keys of infinity and NaN are greater.
constexpr CostKey k_greatest_finite = 0x7FEFFFFF;

// The predictions for the merged vertex differ within the star of each end, which its quadric
// measures, and nearly as much between the two stars, which no sum of two quadrics does. This
// factor accounts for both. Along an edge between two colours it is too much, so bounds of costs
// are only approximate there.
constexpr double k_both_ends = 1.8;

// Few enough that the data prefetched while listing is still in the L1 cache.
constexpr std::size_t k_listed_at_once = 256;

}  // namespace

CostKey key_of(double cost) {
  return static_cast<CostKey>(std::bit_cast<std::uint64_t>(cost) >> 32);
}

double cost_of(CostKey key) {
  if (key >= k_any_cost) return HUGE_VAL;
  return std::bit_cast<double>(static_cast<std::uint64_t>(key) << 32 | 0xFFFFFFFFU);
}

void EdgeRanking::begin_pass(const RankingInput& input) {
  input_ = input;
  fine_.clear();
  quadrics_.assign(input_.positions.size(), {});
  sum_planes();
  if (!input_.appearances.empty()) {
    for (std::uint32_t v = 0; v < quadrics_.size(); ++v) {
      quadrics_[v].add(FloatQuadric(appearance_at(v)));
    }
  }
  if (weighs_uvs()) {
    for (std::uint32_t v = 0; v < quadrics_.size(); ++v) {
      quadrics_[v].add(FloatQuadric(uvs_at(v)));
    }
  }
  sum_line_planes();
}

void EdgeRanking::refine() {
  fine_.resize(input_.positions.size());
  for (std::uint32_t v = 0; v < fine_.size(); ++v) refresh(v);
}

/// The appearance quadric of the vertex's star, about the vertex, where all its triangles agree.
Quadric EdgeRanking::appearance_at(std::uint32_t vertex) {
  const std::span<const Corner> fan = input_.adjacency->at(vertex);
  if (fan.size() > k_max_star) return {};
  star_.clear(input_.appearance_scale);
  const Vec3 at = input_.positions[vertex];
  for (const Corner& c : fan) {
    star_.add(StarTriangle::of({}, input_.positions[c.next] - at, input_.positions[c.prev] - at),
              {input_.appearances[vertex], input_.appearances[c.next], input_.appearances[c.prev]});
  }
  return star_.quadric() * k_both_ends;
}

/// The same for texture coordinates, for the triangles of each wedge separately.
Quadric EdgeRanking::uvs_at(std::uint32_t vertex) {
  const CornerFan fan = input_.adjacency->fan_at(vertex);
  if (fan.corners.size() > k_max_star) return {};
  const std::span<const CornerUvs> uvs = input_.adjacency->columns().uvs;
  const Vec3 at = input_.positions[vertex];
  wedges_.clear();
  for (std::size_t i = 0; i < fan.corners.size(); ++i) {
    const auto [next, prev] = fan.corners[i];
    const CornerId id = fan.ids[i];
    const Uv& own = uv_of(uvs, id);
    auto wedge = std::find_if(wedges_.begin(), wedges_.end(),
                              [&](const auto& known) { return is_same(known.first, own); });
    if (wedge == wedges_.end()) wedge = wedges_.insert(wedge, {own, {}});
    wedge->second.add(LinearUv::of({{},
                                    input_.positions[next] - at,
                                    input_.positions[prev] - at,
                                    own,
                                    uv_of(uvs, next_corner(id)),
                                    uv_of(uvs, prev_corner(id))},
                                   own, input_.uv_scale));
  }
  Quadric sum;
  for (const auto& [uv, sums] : wedges_) sum = sum + sums.quadric();
  return sum * (k_both_ends * input_.uv_scale * input_.uv_scale);
}

void EdgeRanking::sum_planes() {
  for (const Triangle& t : input_.triangles) {
    const Vec3 p = input_.positions[t[0]];
    const Vec3 n = cross(input_.positions[t[1]] - p, input_.positions[t[2]] - p);
    const double twice_area = length(n);
    if (!(twice_area > 0 && std::isfinite(twice_area))) continue;
    Quadric plane;
    plane.add(n, 0.5 / twice_area);
    const FloatQuadric narrow(plane);
    for (const std::uint32_t v : t) quadrics_[v].add(narrow);
  }
}

void EdgeRanking::sum_line_planes() {
  for (std::uint32_t v = 0; v < input_.flags.size(); ++v) {
    if ((input_.flags[v] & k_line) != 0) quadrics_[v].add(FloatQuadric(line_planes_at(v)));
  }
}

Quadric EdgeRanking::line_planes_at(std::uint32_t vertex) const {
  const std::uint8_t flags = input_.flags[vertex];
  const std::span<const Corner> fan = input_.adjacency->at(vertex);
  if ((flags & k_fixed) != 0 || fan.size() > k_max_star) return {};
  const Vec3 at = input_.positions[vertex];
  Quadric planes;
  const auto add = [&](const Corner& c, std::uint32_t end, double weight) {
    const Vec3 normal = cross(input_.positions[c.next] - at, input_.positions[c.prev] - at);
    add_line_plane(planes, normal, input_.positions[end] - at, weight);
  };
  if ((flags & k_border) != 0) {
    for_border_edges(fan,
                     [&](const Corner& c, std::uint32_t end) { add(c, end, k_border_weight); });
  }
  for_creases_at(vertex, [&](const Corner& one, const Corner& other, bool is_between_labels) {
    add(one, one.prev, input_.creases->weight(is_between_labels));
    add(other, one.prev, input_.creases->weight(is_between_labels));
  });
  return planes;
}

void EdgeRanking::move_to(std::span<const Vec3> positions, std::span<const std::uint8_t> flags,
                          std::span<const Appearance> appearances) {
  input_.positions = positions;
  input_.flags = flags;
  input_.appearances = appearances;
  quadrics_.resize(positions.size());
  if (is_refined()) fine_.resize(positions.size());
}

void EdgeRanking::refresh(std::uint32_t vertex) {
  const Vec3 at = input_.positions[vertex];
  Quadric planes;
  for (const Corner& c : input_.adjacency->at(vertex)) {
    const Vec3 n = cross(input_.positions[c.next] - at, input_.positions[c.prev] - at);
    const double twice_area = length(n);
    if (twice_area > 0 && std::isfinite(twice_area)) planes.add(n, 0.5 / twice_area);
  }
  if (!input_.appearances.empty()) planes = planes + appearance_at(vertex);
  if (weighs_uvs()) planes = planes + uvs_at(vertex);
  if ((input_.flags[vertex] & k_line) != 0) planes = planes + line_planes_at(vertex);
  quadrics_[vertex] = FloatQuadric(planes);
  if (is_refined()) fine_[vertex] = planes;
}

/// The creases at the vertex, by the mesh as it was at the beginning of the pass.
template <typename Take>
void EdgeRanking::for_creases_at(std::uint32_t vertex, const Take& take) const {
  if ((input_.flags[vertex] & k_crease) == 0) return;
  const auto is_on_crease = [&](std::uint32_t end) { return (input_.flags[end] & k_crease) != 0; };
  for_crease_edges(input_.adjacency->fan_at(vertex), input_.positions[vertex], input_.positions,
                   *input_.creases, is_on_crease, take);
}

void EdgeRanking::list_edges_at(std::uint32_t vertex, std::uint32_t least) {
  const std::uint8_t* const all_flags = input_.flags.data();
  const Vec3* const positions = input_.positions.data();
  const FloatQuadric* const quadrics = quadrics_.data();
  const std::uint8_t flags = all_flags[vertex];
  const std::span<const Corner> fan = input_.adjacency->at(vertex);
  const std::uint8_t still = input_.general ? std::uint8_t{k_fixed} : k_still;
  if ((flags & still) != 0 || fan.size() > k_max_star) return;
  // Always written, counted only if wanted: a branch on which neighbours are greater would be
  // mispredicted.
  const std::size_t most = listed_count_ + 2 * fan.size() + 2;
  if (listed_.size() < most) listed_.resize(2 * most);
  Edge* end_of_list = listed_.data() + listed_count_;
  const bool any_seam = !input_.seam_only || (flags & k_seam) != 0;
  const auto consider = [&](std::uint32_t end, std::uint8_t barred) {
    const std::uint8_t other = all_flags[end];
    *end_of_list = {vertex, end};
    __builtin_prefetch(positions + end);
    __builtin_prefetch(quadrics + end);
    const bool wanted =
        (end >= least) & ((other & (still | barred)) == 0) & (any_seam | ((other & k_seam) != 0));
    end_of_list += wanted ? 1 : 0;
  };
  const std::uint8_t beside = input_.any_topology ? flags & k_crease : barred_beside(flags);
  for (const Corner& c : fan) consider(c.next, beside);
  if (input_.general && (input_.any_topology || (flags & k_complex) != 0)) {
    // The last neighbours of fans that are not closed.
    for (const Corner& c : fan) {
      const bool begins = std::any_of(fan.begin(), fan.end(),
                                      [&](const Corner& other) { return other.next == c.prev; });
      if (!begins) consider(c.prev, beside);
    }
  }
  if ((flags & k_line) != 0) {
    const std::uint8_t barred = barred_along(flags);
    if ((flags & k_border) != 0) {
      for_border_edges(fan, [&](const Corner&, std::uint32_t end) { consider(end, barred); });
    }
    for_creases_at(vertex,
                   [&](const Corner& one, const Corner&, bool) { consider(one.prev, barred); });
  }
  listed_count_ = static_cast<std::size_t>(end_of_list - listed_.data());
}

/// The merged vertex takes the position of the end of higher rank, or of the cheaper end. `moved`
/// is the cost of moving one end to the other.
template <typename Moved>
EdgeCost EdgeRanking::cost_of_line_end(const Edge& e, const Moved& moved) const {
  const int rank_a = line_rank(input_.flags[e.a]);
  const int rank_b = line_rank(input_.flags[e.b]);
  if (rank_a != rank_b || !input_.adjacency->has_uvs()) return moved(rank_a > rank_b ? e.b : e.a);
  const EdgeCost to_b = moved(e.a);
  const EdgeCost to_a = moved(e.b);
  return to_a.ranking < to_b.ranking ? to_a : to_b;
}

EdgeCost EdgeRanking::cost_of_line_end(const Edge& e) const {
  const Vec3 half = (input_.positions[e.b] - input_.positions[e.a]) * 0.5;
  return cost_of_line_end(
      e, [&](std::uint32_t end) { return cost_of_end(quadrics_[end], half, input_.bounds); });
}

/// Whether no triangle of a sheet or a tetrahedron would stay. The cost of that depends on the
/// distance from the rest, not on the planes, so the edge must be judged to know it.
bool EdgeRanking::is_all_of_piece(const Edge& e) const {
  constexpr std::size_t k_most = 3;
  const std::span<const Corner> at_a = input_.adjacency->at(e.a);
  const std::span<const Corner> at_b = input_.adjacency->at(e.b);
  if (at_a.size() != at_b.size() || at_a.size() > k_most) return false;
  const auto is_at = [](std::span<const Corner> fan, std::uint32_t v) {
    return std::any_of(fan.begin(), fan.end(),
                       [v](const Corner& c) { return c.next == v || c.prev == v; });
  };
  return std::all_of(at_a.begin(), at_a.end(), [&](const Corner& c) {
    return (c.next == e.b || is_at(at_b, c.next)) && (c.prev == e.b || is_at(at_b, c.prev));
  });
}

EdgeCost EdgeRanking::fine_cost_of(const Edge& e, bool is_by_end) const {
  const Vec3 half = (input_.positions[e.b] - input_.positions[e.a]) * 0.5;
  if (!is_by_end) return fine_cost(fine_[e.a], fine_[e.b], half);
  return cost_of_line_end(e, [&](std::uint32_t end) { return fine_cost_of_end(fine_[end], half); });
}

/// Counts the keys of the edges of one in `one_in` vertices into starts_.
std::uint64_t EdgeRanking::sample_costs(std::uint32_t one_in) {
  starts_.assign(bucket_of(k_any_cost) + 1, 0);
  std::uint64_t sampled = 0;
  const auto count = [&](const Edge&, const EdgeCost& cost) {
    const CostKey key = key_of(cost.ranking);
    // Edges of whole pieces say nothing about the others.
    if (key == 0 || key > k_greatest_finite) return;
    ++starts_[bucket_of(key)];
    ++sampled;
  };
  const auto vertices = static_cast<std::uint32_t>(input_.positions.size());
  for (std::uint32_t first = 0; vertices - first >= one_in; first += one_in) {
    const std::uint32_t vertex = first + scrambled(first) % one_in;
    list_edges_at(vertex, vertex);
    if (listed_count_ >= k_listed_at_once) cost_listed(count);
  }
  cost_listed(count);
  return sampled;
}

CostKey EdgeRanking::estimate_limit(double share, double most) {
  const auto vertices = static_cast<std::uint32_t>(input_.positions.size());
  std::uint32_t one_in = std::max(1U, vertices / k_sampled_vertices);
  std::uint64_t sampled = sample_costs(one_in);
  // Where most vertices are locked or off the seam, the sample may be too small.
  if (sampled < k_least_sample && one_in > 1) {
    one_in = 1;
    sampled = sample_costs(one_in);
  }
  const double wanted = std::min(share * static_cast<double>(sampled), most / one_in);
  std::uint64_t sum = 0;
  CostKey greatest = k_any_cost;
  for (std::uint32_t bucket = 0; bucket < starts_.size(); ++bucket) {
    sum += starts_[bucket];
    if (sum == 0) continue;
    const CostKey key = ((bucket + 1) << k_bucket_shift) - 1;
    if (static_cast<double>(sum) >= wanted || key >= greatest) return std::min(key, greatest);
    if (greatest == k_any_cost && static_cast<double>(sum) >= wanted / 2) {
      greatest = key + (k_greatest_jump << k_exponent_shift);
    }
  }
  return greatest;
}

std::span<const RankedEdge> EdgeRanking::cheapest(std::uint32_t first, std::uint32_t last,
                                                  const RankLimits& limits) {
  found_count_ = 0;
  const CostKey greatest = std::min(limits.key, k_greatest_finite);
  const auto find = [&](const Edge& e, const EdgeCost& cost) {
    const CostKey key = key_of(cost.ranking);
    found_[found_count_] = {e.a, e.b, key};
    const bool cheap = (key <= greatest) & (cost.least <= limits.max_cost);
    found_count_ += cheap ? 1 : 0;
  };
  const auto cost_all = [&] {
    if (found_.size() < found_count_ + listed_count_)
      found_.resize(2 * (found_count_ + listed_count_));
    cost_listed(find);
  };
  for (std::uint32_t v = first; v < last; ++v) {
    list_edges_at(v, v);
    if (listed_count_ >= k_listed_at_once) cost_all();
  }
  cost_all();
  sort_found();
  return sorted_;
}

void EdgeRanking::sort_found() {
  const std::span<const RankedEdge> found(found_.data(), found_count_);
  sorted_.resize(found.size());
  if (found.empty()) return;
  CostKey low = UINT32_MAX;
  CostKey high = 0;
  for (const RankedEdge& e : found) {
    low = std::min(low, e.key);
    high = std::max(high, e.key);
  }
  const std::uint32_t base = bucket_of(low);
  starts_.assign(bucket_of(high) - base + 2, 0);
  for (const RankedEdge& e : found) ++starts_[bucket_of(e.key) - base + 1];
  for (std::size_t i = 1; i < starts_.size(); ++i) starts_[i] += starts_[i - 1];
  for (const RankedEdge& e : found) sorted_[starts_[bucket_of(e.key) - base]++] = e;
}

}  // namespace meshfarm
