// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include <meshfarm/geometry/mesh.hpp>

#include "kept_positions.hpp"
#include "ply_positions.hpp"

namespace meshfarm {

/// Looks up single kept positions, which must outlive this.
class PositionLookup {
 public:
  explicit PositionLookup(const KeptPositions& kept) : kept_(kept) {
    if (!kept.is_in_memory()) in_scratch_ = PlyPositions::in_scratch(kept);
  }
  Vec3 at(std::uint64_t vertex) {
    return in_scratch_ ? in_scratch_->at(vertex) : kept_.in_memory()[vertex];
  }

 private:
  const KeptPositions& kept_;
  std::unique_ptr<PlyPositions> in_scratch_;
};

/// The vertices that a source has kept of a scan, for later scans and for single lookups.
class VertexStore {
 public:
  using Take = std::function<void(std::span<const Vec3>)>;
  /// `where_possible`: a full disk only costs another scan. `always`: it throws IoError.
  enum class Keep : std::uint8_t { no, where_possible, always };

  struct Filling {
    PositionType positions = PositionType::float32;
    std::uint64_t vertices = 0;
    Keep keep = Keep::no;
  };
  /// Calls `read`, passes on to `take` what it reads, and keeps that, unless `read` returns false:
  /// then these positions are not final.
  void fill(const Filling& filling, const Take& take, const std::function<bool(const Take&)>& read);

  bool is_filled() const { return kept_ != nullptr; }
  /// These require a filled store.
  void scan(const Take& take) const { kept_->scan(take); }
  Vec3 at(std::uint64_t vertex) {
    if (!lookup_) lookup_ = std::make_unique<PositionLookup>(*kept_);
    return lookup_->at(vertex);
  }

 private:
  std::unique_ptr<KeptPositions> kept_;
  std::unique_ptr<PositionLookup> lookup_;
};

}  // namespace meshfarm
