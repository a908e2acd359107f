// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/surface_sampler.hpp>
#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/stream/sweep.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr std::uint32_t k_none = std::numeric_limits<std::uint32_t>::max();

/// Triangles this many rings behind the front are final. Nearer ones are distorted by the locked
/// vertices of the front, and are simplified again with the next window.
constexpr std::uint32_t k_kept_rings = 6;

/// The role of a vertex in the buffer. All but free ones are locked.
enum class Role : std::uint8_t {
  free,
  open,      // on the front: more of its triangles may follow
  boundary,  // of the stream
  sent,      // at the edge of what was sent on
};

class Sweep {
 public:
  Sweep(StreamReader& reader, const SweepOptions& options, const SweepOutput& output)
      : reader_(reader),
        options_(options),
        output_(output),
        next_sent_(reader.info().boundary_vertices),
        sampler_(options.samples) {}

  SweptStream run() {
    StreamBlock block;
    while (reader_.next(block)) {
      if (!(options_.lines.appearance_scale.length > 0)) block.appearances.clear();
      block.columns.keep(options_.lines.columns);
      append(block);
      if (buffer_.triangles.size() >= options_.window_triangles && fresh_ >= least_fresh()) {
        simplify_window();
        send(settled());
      }
    }
    simplify_window();
    send(std::vector<std::uint8_t>(buffer_.triangles.size(), 1));
    if (options_.measure) {
      for (const SurfaceSampler::Sample& sample : sampler_.samples()) {
        result_.error = std::max(result_.error, sample.distance);
      }
    }
    result_.samples = sampler_.take();
    return std::move(result_);
  }

 private:
  /// Prevents simplifying again after every block when the front fills the buffer.
  std::uint64_t least_fresh() const { return options_.window_triangles / 4; }

  void append(const StreamBlock& block) {
    const std::uint64_t before = buffer_.triangles.size();
    std::size_t next_boundary = 0;
    for (std::uint32_t i = 0; i < block.positions.size(); ++i) {
      const bool is_boundary =
          next_boundary < block.boundary.size() && block.boundary[next_boundary].vertex() == i;
      local_.push_back(static_cast<std::uint32_t>(buffer_.positions.size()));
      append_vertex(VertexView(block.positions, block.appearances), i, buffer_);
      if (is_boundary) {
        add_role(Role::boundary, static_cast<std::uint32_t>(result_.boundary.positions.size()));
        append_vertex(VertexView(block.positions, block.appearances), i, result_.boundary);
        if (block.boundary[next_boundary++].last_use()) local_.back() = k_none;
      } else {
        add_role(Role::open, 0);
      }
    }
    for (const auto& [a, b, c] : block.triangles) {
      buffer_.triangles.push_back({local(a), local(b), local(c)});
      for (const StreamCorner corner : {a, b, c}) {
        if (corner.last_use()) finish(corner);
      }
    }
    buffer_.columns.append(block.columns);
    fresh_ += buffer_.triangles.size() - before;
    read_ += buffer_.triangles.size() - before;
    sampler_.add(buffer_.positions, std::span(buffer_.triangles).subspan(before));
  }

  void add_role(Role role, std::uint32_t id) {
    roles_.push_back(role);
    ids_.push_back(id);
  }

  std::uint32_t local(StreamCorner corner) const { return local_[corner.vertex() - first_local_]; }

  void finish(StreamCorner corner) {
    std::uint32_t& vertex = local_[corner.vertex() - first_local_];
    if (roles_[vertex] == Role::open) roles_[vertex] = Role::free;
    vertex = k_none;
  }

  void simplify_window() {
    forget_finished();
    const std::uint32_t locked = put_locked_first();
    const std::uint64_t before = buffer_.triangles.size();
    Simplifier simplifier(std::move(buffer_), {.locked_vertices = locked,
                                               .positions = reader_.info().positions,
                                               .lines = options_.lines});
    SimplifyGoal goal{.triangles = 0, .max_cost = options_.max_cost};
    if (options_.ratio > 0) goal = {.triangles = quota(before), .max_cost = HUGE_VAL};
    simplifier.reduce(goal, [&](std::uint64_t) { return tell(); });
    if (stopped_) throw IncompleteError("the job was given up");
    buffer_ = simplifier.mesh();
    result_.dropped_degenerate += simplifier.dropped_degenerate();
    result_.dropped_duplicate += simplifier.dropped_duplicate();
    result_.turned += simplifier.turned();
    roles_.resize(locked);
    roles_.resize(buffer_.positions.size(), Role::free);
    ids_.resize(buffer_.positions.size());
    fresh_ = 0;
  }

  bool tell() {
    stopped_ = options_.progress && !options_.progress(read_);
    return !stopped_;
  }

  /// With a ratio: old triangles were reduced before, the others are reduced by it.
  std::uint64_t quota(std::uint64_t triangles) const {
    return triangles - fresh_ +
           static_cast<std::uint64_t>(options_.ratio * static_cast<double>(fresh_));
  }

  /// Vertices of the stream before the first unfinished one are never looked up again.
  void forget_finished() {
    const auto first = std::find_if(local_.begin(), local_.end(),
                                    [](std::uint32_t vertex) { return vertex != k_none; });
    first_local_ += static_cast<std::uint32_t>(first - local_.begin());
    local_.erase(local_.begin(), first);
  }

  /// Moves locked vertices to the front, keeping the order otherwise. Returns their number.
  std::uint32_t put_locked_first() {
    std::vector<std::uint32_t> order;
    order.reserve(buffer_.positions.size());
    for (const bool wanted : {true, false}) {
      for (std::uint32_t v = 0; v < roles_.size(); ++v) {
        if ((roles_[v] != Role::free) == wanted) order.push_back(v);
      }
    }
    const auto free =
        static_cast<std::uint32_t>(std::count(roles_.begin(), roles_.end(), Role::free));
    renumber(order);
    return static_cast<std::uint32_t>(roles_.size()) - free;
  }

  /// Keeps only the vertices in `order`, in that order, and all triangles.
  void renumber(const std::vector<std::uint32_t>& order) {
    std::vector<std::uint32_t> number(buffer_.positions.size(), k_none);
    Mesh ordered;
    ordered.positions.reserve(order.size());
    std::vector<Role> roles;
    std::vector<std::uint32_t> ids;
    for (const std::uint32_t v : order) {
      number[v] = static_cast<std::uint32_t>(ordered.positions.size());
      append_vertex(VertexView(buffer_), v, ordered);
      roles.push_back(roles_[v]);
      ids.push_back(ids_[v]);
    }
    renumber_corners(buffer_.triangles, number);
    for (std::uint32_t& v : local_) v = v == k_none ? k_none : number[v];
    buffer_.positions = std::move(ordered.positions);
    buffer_.appearances = std::move(ordered.appearances);
    roles_ = std::move(roles);
    ids_ = std::move(ids);
  }

  /// Flags the triangles that are far enough behind the front.
  std::vector<std::uint8_t> settled() const {
    std::vector<std::uint32_t> ring(buffer_.positions.size(), k_none);
    for (std::size_t v = 0; v < ring.size(); ++v) {
      if (roles_[v] == Role::open) ring[v] = 0;
    }
    std::vector<std::uint8_t> is_settled(buffer_.triangles.size(), 1);
    for (std::uint32_t distance = 0; distance < k_kept_rings; ++distance) {
      for (std::size_t i = 0; i < is_settled.size(); ++i) {
        const Triangle& t = buffer_.triangles[i];
        if (std::min({ring[t[0]], ring[t[1]], ring[t[2]]}) != distance) continue;
        is_settled[i] = 0;
        for (const std::uint32_t v : t) ring[v] = std::min(ring[v], distance + 1);
      }
    }
    return is_settled;
  }

  /// Sends the flagged triangles to the output. Vertices that other triangles need stay, locked.
  void send(const std::vector<std::uint8_t>& flags) {
    if (options_.measure) measure(flags);
    Mesh piece;  // in the numbering of the result
    std::size_t kept = 0;
    for (std::size_t i = 0; i < flags.size(); ++i) {
      Triangle& t = buffer_.triangles[i];
      if (flags[i] == 0) {
        buffer_.columns.move(i, kept);
        buffer_.triangles[kept++] = t;
        continue;
      }
      piece.columns.append(buffer_.columns, i);
      const bool is_free = std::none_of(
          t.begin(), t.end(), [&](std::uint32_t v) { return roles_[v] == Role::boundary; });
      result_.free_triangles += is_free ? 1 : 0;
      piece.triangles.push_back({sent(t[0], piece), sent(t[1], piece), sent(t[2], piece)});
    }
    output_(VertexView(piece), piece.triangles, piece.columns);
    buffer_.triangles.resize(kept);
    buffer_.columns.resize(kept);
    drop_unused();
  }

  /// The distance of a point to the result is the smallest to any piece sent. Pieces far from a
  /// point that has met its own piece before do not matter.
  void measure(const std::vector<std::uint8_t>& flags) {
    Mesh piece;
    for (std::size_t i = 0; i < flags.size(); ++i) {
      if (flags[i] != 0) piece.triangles.push_back(buffer_.triangles[i]);
    }
    if (piece.triangles.empty()) return;
    piece.positions = buffer_.positions;
    const DistanceMeter meter(piece, 1);
    for (SurfaceSampler::Sample& sample : sampler_.samples()) {
      if (sample.distance == 0) continue;
      sample.distance = std::min(sample.distance, meter.measure({&sample.point, 1}).max);
    }
  }

  /// The vertex's number in the result; adds the vertex if it is not there yet.
  std::uint32_t sent(std::uint32_t vertex, Mesh& fresh) {
    if (roles_[vertex] == Role::free) {
      roles_[vertex] = Role::sent;
      ids_[vertex] = next_sent_++;
      append_vertex(VertexView(buffer_), vertex, fresh);
    }
    return ids_[vertex];
  }

  void drop_unused() {
    std::vector<std::uint8_t> used(buffer_.positions.size(), 0);
    for (const Triangle& t : buffer_.triangles) {
      for (const std::uint32_t v : t) used[v] = 1;
    }
    for (const std::uint32_t v : local_) {
      if (v != k_none) used[v] = 1;
    }
    std::vector<std::uint32_t> order;
    for (std::uint32_t v = 0; v < used.size(); ++v) {
      if (used[v] != 0) order.push_back(v);
    }
    renumber(order);
  }

  StreamReader& reader_;
  const SweepOptions& options_;
  const SweepOutput& output_;
  SweptStream result_;
  std::uint32_t next_sent_;  // next number in the result
  Mesh buffer_;
  std::vector<Role> roles_;         // of the buffer's vertices
  std::vector<std::uint32_t> ids_;  // of boundary and sent vertices: number in the result
  /// Places in the buffer of the stream's vertices from first_local_ on; k_none once no more
  /// triangles use the vertex.
  std::vector<std::uint32_t> local_;
  std::uint32_t first_local_ = 0;
  std::uint64_t read_ = 0;   // triangles
  std::uint64_t fresh_ = 0;  // triangles read since the last window
  SurfaceSampler sampler_;   // its distances are to what was sent so far
  bool stopped_ = false;
};

}  // namespace

SweptStream sweep(StreamReader& reader, const SweepOptions& options, const SweepOutput& output) {
  return Sweep(reader, options, output).run();
}

}  // namespace meshfarm
