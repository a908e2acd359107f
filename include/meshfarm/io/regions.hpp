// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace meshfarm {

/// Parts from `first` to before `end`.
struct PartRange {
  std::uint32_t first = 0;
  std::uint32_t end = 0;
  friend bool operator==(const PartRange&, const PartRange&) = default;
};

/// The regions of so many parts. All parts are one region. A region of two parts or more consists
/// of its first half, rounded down, and the rest. The parts are numbered so that each half of a
/// region lies together. A region has the number of the first part of its second half, less 1: so
/// those within a region follow each other.
class Regions {
 public:
  explicit Regions(std::uint32_t parts) : parts_(parts) {}
  /// At least 1.
  std::uint32_t count() const { return parts_ > 2 ? parts_ - 1 : 1; }
  /// The lowest that holds both parts.
  std::uint32_t of(std::uint32_t a, std::uint32_t b) const;
  /// Those that have some of these parts, and others too; and those within the range that lie in
  /// none of its pieces, which are given in order. They ascend.
  std::vector<std::uint32_t> touched_by(const std::vector<PartRange>& pieces) const;

 private:
  std::uint32_t parts_;
};

/// Regions that follow each other, in groups of about as many: what one job joins.
class RegionGroups {
 public:
  explicit RegionGroups(std::uint32_t parts);
  /// From 1 to 24.
  std::uint32_t count() const { return count_; }
  std::uint32_t first_region(std::uint32_t group) const;
  /// That of a triangle between three parts, two of which may be the same.
  std::uint32_t of(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;

 private:
  Regions regions_;
  std::uint32_t count_;
};

}  // namespace meshfarm
