// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "render/colours.hpp"

namespace meshfarm {

/// The samples of a picture, each with the depth and colour of the nearest surface. Several threads
/// may draw: of two colours at equal depth the greater one stays, so that the order does not
/// matter.
class Canvas {
 public:
  struct Size {
    std::uint32_t width = 0;  // pixels
    std::uint32_t height = 0;
    std::uint32_t side = 2;  // each pixel has side * side samples

    std::uint64_t samples() const { return std::uint64_t{side} * side * width * height; }
    std::uint32_t samples_wide() const { return side * width; }
    std::uint32_t samples_high() const { return side * height; }
  };
  static std::uint64_t memory_for(const Size& size) {
    return sizeof(std::uint64_t) * size.samples();
  }

  explicit Canvas(const Size& size) : size_(size), samples_(size.samples()) {}
  const Size& size() const { return size_; }

  /// Bits of a sample: depth (40), colour (24). All zero: empty.
  class Sample {
   public:
    Sample() = default;
    explicit Sample(std::uint64_t bits) : bits_(bits) {}
    /// Depth from 0 (far) to 1 (near).
    Sample(double depth, const Srgb& colour)
        : bits_((1 + static_cast<std::uint64_t>(depth * k_deepest)) << 24 | packed(colour)) {}
    bool empty() const { return bits_ == 0; }
    double depth() const { return static_cast<double>((bits_ >> 24) - 1) / k_deepest; }
    Srgb colour() const { return unpacked(static_cast<std::uint32_t>(bits_ & 0xffffff)); }
    std::uint64_t bits() const { return bits_; }

   private:
    static constexpr double k_deepest = 1099511627774.0;  // 2^40 - 2
    std::uint64_t bits_ = 0;
  };

  std::uint64_t place(std::uint32_t x, std::uint32_t y) const {
    return std::uint64_t{y} * size_.samples_wide() + x;
  }
  Sample at(std::uint64_t place) const { return Sample(samples_[place]); }

  /// Whether something at this depth would be visible, ignoring concurrent drawing.
  bool shows(std::uint64_t place, double depth) const {
    return load(place) <= Sample(depth, {255, 255, 255}).bits();
  }
  void draw(std::uint64_t place, Sample sample) {
    const std::atomic_ref<std::uint64_t> kept(samples_[place]);
    std::uint64_t old = kept.load(std::memory_order_relaxed);
    while (old < sample.bits() &&
           !kept.compare_exchange_weak(old, sample.bits(), std::memory_order_relaxed)) {
    }
  }

 private:
  std::uint64_t load(std::uint64_t place) const {
    auto& bits = const_cast<std::uint64_t&>(samples_[place]);  // atomic_ref does not take const
    return std::atomic_ref<std::uint64_t>(bits).load(std::memory_order_relaxed);
  }

  Size size_;
  std::vector<std::uint64_t> samples_;
};

}  // namespace meshfarm
