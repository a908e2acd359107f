// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// For a point with value c, whose nearest triangle has the values x0, x1, x2 at its corners and
// shares s0, s1, s2 at the point, the square (s0 x0 + s1 x1 + s2 x2 - c)^2 is to be small. The sum
// of all squares is least where A x = b: A is made of the products si sj, b of si c, both summed
// per triangle. Vertices with few points would oscillate: each is also held, by a small part of its
// weight, to the mean of the values round it. Solved by conjugate gradients, which need few steps
// because A is nearly diagonal.
#include <algorithm>
#include <cmath>
#include <utility>

#include <meshfarm/geometry/channel_fit.hpp>
#include <meshfarm/util/parallel.hpp>

#include "geometry/bvh.hpp"
#include "geometry/random_unit.hpp"

namespace meshfarm {
namespace {

constexpr std::size_t k_samples_at_once = 1024;
/// There is half a vertex per triangle: more points than this add little.
constexpr double k_points_per_triangle = 12;
/// The share of its weight that holds a vertex to the mean of its surroundings.
constexpr double k_held = 0.02;
constexpr int k_steps = 20;
/// Of the initial squared residual: by then it is far below what eight bits can represent.
constexpr double k_done = 1e-12;
/// A triangle is near enough if its distance from the point is below this part of its size. Which
/// of several such triangles is chosen changes the point's shares little, and half of the time is
/// saved.
constexpr double k_near_value = 0.01;

/// Per triangle: the sums of s0 s0, s1 s1, s2 s2, s0 s1, s1 s2, s2 s0.
using Products = std::array<double, 6>;
using Corners = std::array<double, 3>;

double dot_of(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// A x = b for one channel.
class Solver {
 public:
  Solver(const Mesh& mesh, std::span<const Products> products)
      : triangles_(mesh.triangles),
        products_(products),
        weight_(mesh.positions.size(), 0),
        diagonal_(mesh.positions.size(), 0) {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const Products& p = products_[t];
      const Corners shares = {p[0] + p[3] + p[5], p[1] + p[3] + p[4], p[2] + p[4] + p[5]};
      for (std::size_t k = 0; k < 3; ++k) {
        weight_[triangles_[t][k]] += shares[k];
        diagonal_[triangles_[t][k]] += p[k];
      }
    }
    for (std::size_t v = 0; v < weight_.size(); ++v) diagonal_[v] += k_held * weight_[v];
  }

  std::vector<double> solve(std::span<const Corners> sums) const {
    std::vector<double> b = gathered(sums);
    std::vector<double> x = b;
    for (std::size_t v = 0; v < x.size(); ++v) {
      if (is_told(v)) x[v] /= weight_[v];
      b[v] += k_held * b[v];  // its weight times the mean
    }
    improve(x, b);
    fill(x);
    return x;
  }

 private:
  bool is_told(std::size_t vertex) const { return weight_[vertex] > 0; }

  std::vector<double> gathered(std::span<const Corners> sums) const {
    std::vector<double> all(weight_.size(), 0);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) all[triangles_[t][k]] += sums[t][k];
    }
    return all;
  }

  std::vector<double> times(std::span<const double> x) const {
    std::vector<double> product(x.size());
    for (std::size_t v = 0; v < x.size(); ++v) product[v] = k_held * weight_[v] * x[v];
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const auto& [a, b, c] = triangles_[t];
      const Products& p = products_[t];
      product[a] += p[0] * x[a] + p[3] * x[b] + p[5] * x[c];
      product[b] += p[3] * x[a] + p[1] * x[b] + p[4] * x[c];
      product[c] += p[5] * x[a] + p[4] * x[b] + p[2] * x[c];
    }
    return product;
  }

  /// Conjugate gradients, preconditioned by the diagonal.
  void improve(std::vector<double>& x, std::span<const double> b) const {
    std::vector<double> rest = times(x);
    for (std::size_t v = 0; v < x.size(); ++v) rest[v] = b[v] - rest[v];
    std::vector<double> scaled(x.size(), 0);
    std::vector<double> way(x.size(), 0);
    double before = 0;
    double enough = 0;
    for (int step = 0; step < k_steps; ++step) {
      for (std::size_t v = 0; v < x.size(); ++v) {
        scaled[v] = is_told(v) ? rest[v] / diagonal_[v] : 0;
      }
      const double now = dot_of(rest, scaled);
      if (step == 0) enough = k_done * now;
      if (!(now > enough)) return;
      const double turn = before > 0 ? now / before : 0;
      for (std::size_t v = 0; v < x.size(); ++v) way[v] = scaled[v] + turn * way[v];
      const std::vector<double> product = times(way);
      const double length = now / dot_of(way, product);
      if (!std::isfinite(length)) return;
      for (std::size_t v = 0; v < x.size(); ++v) {
        x[v] += length * way[v];
        rest[v] -= length * product[v];
      }
      before = now;
    }
  }

  /// Vertices without points take the mean of their neighbours, starting from the nearest vertices
  /// that have points. A piece without any points takes the mean of all.
  void fill(std::vector<double>& x) const {
    std::vector<std::uint8_t> known(x.size());
    for (std::size_t v = 0; v < x.size(); ++v) known[v] = is_told(v) ? 1 : 0;
    std::vector<double> sum(x.size(), 0);
    std::vector<std::uint32_t> count(x.size(), 0);
    for (bool any = true; std::exchange(any, false);) {
      for (const Triangle& t : triangles_) {
        for (const std::uint32_t from : t) {
          if (known[from] == 0) continue;
          for (const std::uint32_t to : t) {
            if (known[to] != 0) continue;
            sum[to] += x[from];
            ++count[to];
          }
        }
      }
      for (std::size_t v = 0; v < x.size(); ++v) {
        if (known[v] != 0 || count[v] == 0) continue;
        x[v] = sum[v] / count[v];
        known[v] = 1;
        any = true;
      }
    }
    double all = 0;
    std::uint64_t told = 0;
    for (std::size_t v = 0; v < x.size(); ++v) {
      all += known[v] != 0 ? x[v] : 0;
      told += known[v];
    }
    for (std::size_t v = 0; v < x.size(); ++v) {
      if (known[v] == 0) x[v] = told > 0 ? all / static_cast<double>(told) : 0;
    }
  }

  std::span<const Triangle> triangles_;
  std::span<const Products> products_;
  std::vector<double> weight_;  // of a vertex: the sum of its shares
  std::vector<double> diagonal_;
};

}  // namespace

std::array<double, 3> nearest_shares(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 normal = cross(b - a, c - a);
  const double all = squared_length(normal);
  const double of_b = dot(cross(p - a, c - a), normal);
  const double of_c = dot(cross(b - a, p - a), normal);
  const double of_a = all - of_b - of_c;
  if (all > 0 && std::min({of_a, of_b, of_c}) >= 0) return {of_a / all, of_b / all, of_c / all};
  // The point is beyond a side, or the triangle has no inside.
  const std::array<Vec3, 3> corners = {a, b, c};
  Corners best{};
  double least = HUGE_VAL;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const Vec3 side = corners[next] - corners[k];
    const double length = squared_length(side);
    const double share =
        length > 0 ? std::clamp(dot(p - corners[k], side) / length, 0.0, 1.0) : 0.0;
    const double squared = squared_length(corners[k] + side * share - p);
    if (squared >= least) continue;
    least = squared;
    best = {};
    best[k] = 1 - share;
    best[next] = share;
  }
  return best;
}

class ChannelFit::Impl {
 public:
  Impl(const Mesh& mesh, const ChannelFitOptions& options)
      : mesh_(mesh),
        channels_(options.channels),
        threads_(options.threads),
        share_(k_points_per_triangle * static_cast<double>(mesh.triangles.size()) /
               static_cast<double>(std::max<std::uint64_t>(1, options.points))),
        bvh_(mesh, options.threads),
        products_(mesh.triangles.size()),
        sums_(channels_, std::vector<Corners>(mesh.triangles.size())),
        squares_(channels_, 0) {}

  void add(std::span<const Vec3> points, std::span<const float> values) {
    picked_points_.clear();
    picked_values_.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (random_unit(seen_++) >= share_) continue;
      const std::span<const float> of_point = values.subspan(i * channels_, channels_);
      picked_points_.push_back(points[i]);
      picked_values_.insert(picked_values_.end(), of_point.begin(), of_point.end());
    }
    add_all(picked_points_, picked_values_);
  }
  std::vector<float> values() const {
    const Solver solver(mesh_, products_);
    std::vector<float> values(mesh_.positions.size() * channels_);
    parallel_for(channels_, threads_, [&](std::uint64_t channel) {
      const std::vector<double> x = solver.solve(sums_[channel]);
      for (std::size_t v = 0; v < x.size(); ++v) {
        values[v * channels_ + channel] = static_cast<float>(x[v]);
      }
    });
    return values;
  }

  std::vector<double> rms(std::span<const float> values) const {
    std::vector<double> rms(channels_, 0);
    for (std::size_t channel = 0; channel < channels_ && points_ > 0; ++channel) {
      double sum = squares_[channel];
      for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
        Corners x{};
        for (std::size_t k = 0; k < 3; ++k) {
          x[k] = static_cast<double>(values[mesh_.triangles[t][k] * channels_ + channel]);
        }
        const Products& p = products_[t];
        const Corners& b = sums_[channel][t];
        sum += p[0] * x[0] * x[0] + p[1] * x[1] * x[1] + p[2] * x[2] * x[2] +
               2 * (p[3] * x[0] * x[1] + p[4] * x[1] * x[2] + p[5] * x[2] * x[0]) -
               2 * (b[0] * x[0] + b[1] * x[1] + b[2] * x[2]);
      }
      rms[channel] = std::sqrt(std::max(0.0, sum / static_cast<double>(points_)));
    }
    return rms;
  }

 private:
  struct Found {
    std::uint32_t triangle = 0;
    Corners shares{};
  };

  void add_all(std::span<const Vec3> points, std::span<const float> values) {
    found_.resize(points.size());
    const std::size_t chunks = (points.size() + k_samples_at_once - 1) / k_samples_at_once;
    parallel_for(chunks, threads_, [&](std::uint64_t chunk) {
      std::uint32_t guess = 0;
      const std::size_t end = std::min(points.size(), (chunk + 1) * k_samples_at_once);
      for (std::size_t i = chunk * k_samples_at_once; i < end; ++i) {
        guess = bvh_.nearest(points[i], guess, near_to(guess)).triangle;
        const auto& [a, b, c] = mesh_.triangles[guess];
        found_[i] = {guess, nearest_shares(points[i], mesh_.positions[a], mesh_.positions[b],
                                           mesh_.positions[c])};
      }
    });
    for (std::size_t i = 0; i < points.size(); ++i) {
      add(found_[i], values.subspan(i * channels_, channels_));
    }
    points_ += points.size();
  }

  /// The squared distance that is near enough.
  double near_to(std::uint32_t triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    const Vec3 normal =
        cross(mesh_.positions[b] - mesh_.positions[a], mesh_.positions[c] - mesh_.positions[a]);
    return k_near_value * k_near_value * length(normal);
  }

  void add(const Found& found, std::span<const float> values) {
    const Corners& s = found.shares;
    Products& p = products_[found.triangle];
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] += s[k] * s[k];
      p[k + 3] += s[k] * s[(k + 1) % 3];
    }
    for (std::size_t channel = 0; channel < channels_; ++channel) {
      const auto value = static_cast<double>(values[channel]);
      Corners& sums = sums_[channel][found.triangle];
      for (std::size_t k = 0; k < 3; ++k) sums[k] += s[k] * value;
      squares_[channel] += value * value;
    }
  }

  const Mesh& mesh_;
  std::size_t channels_;
  unsigned threads_;
  double share_;            // of the points that is used
  std::uint64_t seen_ = 0;  // points, used or not
  Bvh bvh_;
  std::vector<Products> products_;
  std::vector<std::vector<Corners>> sums_;  // of each channel: s0 c, s1 c, s2 c by triangle
  std::vector<double> squares_;             // of each channel: c c
  std::uint64_t points_ = 0;                // used
  std::vector<Vec3> picked_points_;
  std::vector<float> picked_values_;
  std::vector<Found> found_;
};

ChannelFit::ChannelFit(const Mesh& mesh, const ChannelFitOptions& options)
    : impl_(std::make_unique<Impl>(mesh, options)) {}
ChannelFit::~ChannelFit() = default;
ChannelFit::ChannelFit(ChannelFit&&) noexcept = default;

void ChannelFit::add(std::span<const Vec3> points, std::span<const float> values) {
  impl_->add(points, values);
}

std::vector<float> ChannelFit::values() const {
  return impl_->values();
}

std::vector<double> ChannelFit::rms(std::span<const float> values) const {
  return impl_->rms(values);
}

}  // namespace meshfarm
