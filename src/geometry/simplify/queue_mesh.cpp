// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// How the queue inspects its mesh, keeps it tidy, and hands it out.
#include <algorithm>
#include <array>

#include <meshfarm/geometry/vertices.hpp>

#include "geometry/simplify/simplify_queue.hpp"
#include "geometry/simplify/vertex_flags.hpp"

namespace meshfarm {
namespace {

// Sides of a ribbon that meet at less than 120 degrees meet at its end.
constexpr double k_cos_of_end = -0.5;
// Weight of an end's position, per area around it. What a ribbon loses at an end it loses again and
// again, and planes see only the last time: with 0, curved hair at 20 % has 1.9 times the error.
// With 1 and 3 the results are alike; more costs the middle of the ribbon more than the end gains.
constexpr double k_weight_of_end = 2;
// Pieces of four triangles are shrunk to no less than this share to fit in.
constexpr double k_smallest_share = 0.1;

/// Appends the columns of a triangle, beginning at this corner.
void append_turned(const TriangleColumnsView& from, CornerId id, TriangleColumns& to) {
  to.append(from, id / 3);
  if (to.uvs.empty()) return;
  const CornerId next = next_corner(id);
  to.uvs.back() = {uv_of(from.uvs, id), uv_of(from.uvs, next), uv_of(from.uvs, next_corner(next))};
}

}  // namespace

bool CollapseQueue::may_lose_one() const {
  for (std::uint32_t v = 0; v < target_.size(); ++v) {
    if (meshfarm::may_lose_one(mesh_.flags[v]) && !is_gone(v)) return true;
  }
  return false;
}

/// Records the planes of complex vertices and the ends of ribbons, if there are any.
void CollapseQueue::remember() {
  past_.clear();
  for (std::uint32_t v = 0; v < target_.size(); ++v) {
    const PastPlanes past = (mesh_.flags[v] & k_complex) != 0 ? planes_at(v) : end_at(v);
    if (past.empty()) continue;
    past_.resize(target_.size());
    past_[v] = past;
  }
}

PastPlanes CollapseQueue::planes_at(std::uint32_t vertex) const {
  PastPlanes past;
  const Vec3 at = mesh_.positions[vertex];
  for (const Corner& c : mesh_.adjacency.at(vertex)) {
    const Vec3 normal = cross(mesh_.positions[c.next] - at, mesh_.positions[c.prev] - at);
    const double twice_area = length(normal);
    if (twice_area > 0) past.a.add(normal, 0.5 / twice_area);
  }
  return past;
}

/// The end of a ribbon, where its sides meet: its position and weight. Empty elsewhere.
PastPlanes CollapseQueue::end_at(std::uint32_t vertex) const {
  const auto is_on_border = [&](std::uint32_t v) { return is_on_plain_border(mesh_.flags[v]); };
  const auto is_of_ribbon = [&](std::uint32_t v) {
    const std::span<const Corner> fan = mesh_.adjacency.at(v);
    return is_on_border(v) && std::all_of(fan.begin(), fan.end(), [&](const Corner& c) {
             return is_on_border(c.next) && is_on_border(c.prev);
           });
  };
  // The corner of a sheet may have only triangles at its border, so the neighbours are checked,
  // too.
  const std::span<const Corner> fan = mesh_.adjacency.at(vertex);
  if (!is_of_ribbon(vertex) || !std::all_of(fan.begin(), fan.end(), [&](const Corner& c) {
        return is_of_ribbon(c.next) && is_of_ribbon(c.prev);
      })) {
    return {};
  }
  const Vec3 at = mesh_.positions[vertex];
  double twice_area = 0;
  for (const Corner& c : fan) {
    twice_area += length(cross(mesh_.positions[c.next] - at, mesh_.positions[c.prev] - at));
  }
  std::array<Vec3, 2> sides;
  std::size_t count = 0;
  for_border_edges(fan, [&](const Corner&, std::uint32_t neighbour) {
    if (count < sides.size()) sides[count] = mesh_.positions[neighbour] - at;
    ++count;
  });
  const bool is_end = count == sides.size() &&
                      dot(sides[0], sides[1]) > k_cos_of_end * length(sides[0]) * length(sides[1]);
  return is_end ? PastPlanes::here(k_weight_of_end * 0.5 * twice_area) : PastPlanes{};
}

/// After a collapse that may have changed fans: drops triangles that have become equal, and splits
/// vertices that hold several fans.
void CollapseQueue::tidy(std::uint32_t merged) {
  tidied_.assign(general_.changed().begin(), general_.changed().end());
  for (const auto& [next, prev] : general_.vanishing()) {
    mesh_.adjacency.remove(merged, {next, prev});
    mesh_.adjacency.remove(next, {prev, merged});
    mesh_.adjacency.remove(prev, {merged, next});
    tidied_.push_back(next);
    tidied_.push_back(prev);
  }
  tidied_.push_back(merged);
  std::sort(tidied_.begin(), tidied_.end());
  tidied_.erase(std::unique(tidied_.begin(), tidied_.end()), tidied_.end());
  const std::size_t before = tidied_.size();
  for (std::size_t i = 0; i < before; ++i) tidy_star(tidied_[i]);
  if (pieces_ != nullptr && tidied_.size() > before) {
    pieces_->find_at(tidied_, mesh_.adjacency, mesh_.positions, mesh_.flags);
  }
  for (const std::uint32_t v : tidied_) stale_[v] = 1;
  for (const std::uint32_t v : tidied_) {
    if (v != merged) look_again(v);
  }
}

void CollapseQueue::tidy_star(std::uint32_t vertex) {
  if ((mesh_.flags[vertex] & k_fixed) != 0 || mesh_.adjacency.count(vertex) == 0) return;
  const std::uint32_t fans = splitter_.split(mesh_.adjacency.at(vertex));
  // Fans that touch are cut apart only where the topology may change.
  if (fans == 1 || !mesh_.any_topology) {
    classify(vertex);
    return;
  }
  const auto first_copy = static_cast<std::uint32_t>(target_.size());
  const CornerFan star = mesh_.adjacency.fan_at(vertex);
  const std::vector<Corner> all(star.corners.begin(), star.corners.end());
  const std::vector<CornerId> ids(star.ids.begin(), star.ids.end());
  const std::vector<std::uint32_t> fan(splitter_.fans().begin(), splitter_.fans().end());
  for (std::uint32_t f = 0; f < fans; ++f) {
    joined_.clear();
    joined_ids_.clear();
    const std::uint32_t v = f == 0 ? vertex : add_copy(vertex);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (fan[i] != f) continue;
      const auto [next, prev] = all[i];
      join({all, ids}, i);
      if (f == 0) continue;
      mesh_.adjacency.replace(next, Corner{prev, vertex}, Corner{prev, v});
      mesh_.adjacency.replace(prev, Corner{vertex, next}, Corner{v, next});
    }
    mesh_.adjacency.assign(v, {joined_, joined_ids_});
    classify(v);
  }
  if (guard_ != nullptr) guard_->split(vertex, first_copy);
  if (crossings_ != nullptr) crossings_->split(vertex, first_copy);
}

void CollapseQueue::list_ring(std::uint32_t vertex) {
  ring_.clear();
  for (const Corner& c : mesh_.adjacency.at(vertex)) {
    ring_.push_back(c.next);
    ring_.push_back(c.prev);
  }
  std::sort(ring_.begin(), ring_.end());
  ring_.erase(std::unique(ring_.begin(), ring_.end()), ring_.end());
}

/// Moves the triangles of b to a; those that have both go.
void CollapseQueue::join_stars(std::uint32_t a, std::uint32_t b) {
  list_ring(b);
  for (const std::uint32_t v : ring_) {
    if (v != a) mesh_.adjacency.replace(v, b, a);
  }
  joined_.clear();
  joined_ids_.clear();
  for (const std::uint32_t end : {a, b}) {
    const std::uint32_t other = end == a ? b : a;
    const CornerFan fan = mesh_.adjacency.fan_at(end);
    for (std::size_t i = 0; i < fan.corners.size(); ++i) {
      const Corner& c = fan.corners[i];
      if (c.next != other && c.prev != other) join(fan, i);
    }
  }
  mesh_.adjacency.assign(b, {});
  mesh_.adjacency.assign(a, {joined_, joined_ids_});
}

void CollapseQueue::join(const CornerFan& fan, std::size_t place) {
  joined_.push_back(fan.corners[place]);
  if (!fan.ids.empty()) joined_ids_.push_back(fan.ids[place]);
}

void CollapseQueue::classify(std::uint32_t vertex) {
  splitter_.split(mesh_.adjacency.at(vertex));
  std::uint8_t& flags = mesh_.flags[vertex];
  flags &= static_cast<std::uint8_t>(~(k_border | k_complex));
  if (splitter_.kind() == FanSplitter::Kind::open) flags |= k_border;
  if (splitter_.kind() == FanSplitter::Kind::complex) flags |= k_complex;
}

std::uint32_t CollapseQueue::add_copy(std::uint32_t vertex) {
  ++pinches_;
  const std::uint32_t copy = mesh_.adjacency.add_vertex();
  const Vec3 position = mesh_.positions[vertex];
  const std::uint8_t flags = mesh_.flags[vertex];
  mesh_.positions.push_back(position);
  mesh_.flags.push_back(flags);
  if (!mesh_.appearances.empty()) {
    const Appearance appearance = mesh_.appearances[vertex];
    mesh_.appearances.push_back(appearance);
  }
  target_.push_back(copy);
  if (!past_.empty()) past_.emplace_back();
  if (!piece_ends_.empty()) piece_ends_.emplace_back();
  refused_.push_back(0);
  looks_.push_back(0);
  stale_.push_back(1);
  ranking_.move_to(mesh_.positions, mesh_.flags, mesh_.appearances);
  judge_.move_to(state());
  general_.move_to(state());
  if (guard_ != nullptr) guard_->move_to(state());
  if (crossings_ != nullptr) crossings_->move_to(state());
  if (pieces_ != nullptr) pieces_->add_vertex();
  tidied_.push_back(copy);
  return copy;
}

/// Moves a piece. If it has four triangles and they would cross others, they become smaller
/// instead: they face the same way then.
bool CollapseQueue::move(const SmallPieces::Places& places) {
  const std::size_t size = places.vertices.size();
  const auto is_there = [&](std::size_t i) {
    return mesh_.positions[places.vertices[i]] == places.positions[i];
  };
  std::size_t there = 0;
  while (there < size && is_there(there)) ++there;
  if (there == size) return false;
  std::vector<Vec3> to = places.positions;
  bool moves = crossings_->moves(places.vertices, to);
  for (double share = 0.5; !moves && size == 4 && share > k_smallest_share; share *= 0.5) {
    const Vec3 middle =
        (places.positions[0] + places.positions[1] + places.positions[2] + places.positions[3]) *
        0.25;
    for (std::size_t i = 0; i < size; ++i) {
      to[i] = rounded(middle + (places.positions[i] - middle) * share, mesh_.type);
    }
    moves = crossings_->moves(places.vertices, to);
  }
  if (!moves) return false;
  for (std::size_t i = 0; i < size; ++i) {
    const std::uint32_t v = places.vertices[i];
    mesh_.positions[v] = to[i];
    stale_[v] = 1;
    refused_[v] = 1;  // will be judged again
  }
  return true;
}

void CollapseQueue::restore_pieces() {
  if (pieces_ == nullptr || pieces_->empty()) return;
  std::vector<Triangle> triangles;
  for (std::uint32_t v = 0; v < target_.size(); ++v) {
    if (!pieces_->has(v)) continue;
    for (const auto& [next, prev] : mesh_.adjacency.at(v)) {
      if (v < next && v < prev) triangles.push_back({v, next, prev});
    }
  }
  for (const auto& places : pieces_->restored(triangles, mesh_.positions, mesh_.type)) {
    if (!move(places)) continue;
    for (const std::uint32_t v : places.vertices) look_again(v);
  }
}

void CollapseQueue::copy_to(Mesh& mesh, std::vector<std::uint8_t>& flags,
                            std::uint32_t locked) const {
  clear_vertices(mesh);
  mesh.triangles.clear();
  mesh.columns.clear();
  flags.clear();
  std::vector<std::uint32_t> number(target_.size());
  for (std::uint32_t v = 0; v < target_.size(); ++v) {
    if (v >= locked && mesh_.adjacency.count(v) == 0) continue;
    number[v] = static_cast<std::uint32_t>(mesh.positions.size());
    append_vertex({mesh_.positions, mesh_.appearances}, v, mesh);
    flags.push_back(mesh_.flags[v]);
  }
  mesh.triangles.reserve(triangles_);
  for (std::uint32_t v = 0; v < target_.size(); ++v) {
    const CornerFan fan = mesh_.adjacency.fan_at(v);
    for (std::size_t i = 0; i < fan.corners.size(); ++i) {
      const Corner& c = fan.corners[i];
      if (c.next < v || c.prev < v) continue;
      mesh.triangles.push_back({number[v], number[c.next], number[c.prev]});
      if (!fan.ids.empty()) append_turned(mesh_.adjacency.columns(), fan.ids[i], mesh.columns);
    }
  }
}

}  // namespace meshfarm
