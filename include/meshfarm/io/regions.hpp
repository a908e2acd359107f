// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace meshfarm {

/// The parts from `first` up to, but without, `end`.
struct PartRange {
  std::uint32_t first = 0;
  std::uint32_t end = 0;
  friend bool operator==(const PartRange&, const PartRange&) = default;
};

/// The regions of a number of parts. All parts together are one region. A region of two or more
/// parts is divided into its first half, rounded down, and the rest, which are regions, too. The
/// parts are numbered so that each half of a region is contiguous. A region's number is that of the
/// first part of its second half, minus 1: so the regions within a region are consecutive.
class Regions {
 public:
  explicit Regions(std::uint32_t parts) : parts_(parts) {}
  /// At least 1.
  std::uint32_t count() const { return parts_ > 2 ? parts_ - 1 : 1; }
  /// The smallest region that holds both parts.
  std::uint32_t of(std::uint32_t a, std::uint32_t b) const;
  /// The regions that overlap the range from the first of these pieces to the last, and that do not
  /// lie within a single piece. Pieces are given in order; the regions are ascending.
  std::vector<std::uint32_t> touched_by(const std::vector<PartRange>& pieces) const;

 private:
  std::uint32_t parts_;
};

/// Groups of consecutive regions, of about equal size: what one job joins.
class RegionGroups {
 public:
  explicit RegionGroups(std::uint32_t parts);
  /// From 1 to 24.
  std::uint32_t count() const { return count_; }
  std::uint32_t first_region(std::uint32_t group) const;
  /// The group of a triangle between three parts, two of which may be the same.
  std::uint32_t of(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;

 private:
  Regions regions_;
  std::uint32_t count_;
};

}  // namespace meshfarm
