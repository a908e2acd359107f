// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/divide/weld_counts.hpp>
#include <meshfarm/geometry/uv_facts.hpp>

#include "divide/boundary_numbers.hpp"
#include "divide/mesh_shares.hpp"
#include "divide/seam_numbers.hpp"
#include "divide/share_map.hpp"
#include "divide/slab_map.hpp"

namespace meshfarm {

/// What a share has become in the stage.
struct StagedShare : WeldCounts {
  PartEntry entry;
  std::optional<PartEntry> sample;  // of a stream: without a name if it needs none
  BoundaryNumbers numbers;
  UvFacts uv_facts;
  std::uint64_t label_corners = 0;
};

/// What one way of dividing has of its own; all else is the cut's (cut.cpp).
class CutScheme {
 public:
  /// For people.
  struct Words {
    std::string_view work;    // "the cut"
    std::string_view phases;  // what the names of phases begin with: "cut"
    std::string_view shares;  // the phase that makes the shares: "parts"
  };

  virtual ~CutScheme() = default;
  virtual Words words() const = 0;
  /// What has to look at all vertices in the order they come in, if anything.
  virtual OrderProbe* probe() { return nullptr; }
  /// Which vertices go together, of a box and an input that the manifest tells of, which now tells
  /// of the scheme too. Not settled.
  virtual std::unique_ptr<ShareMap> choose_map(Manifest& manifest) = 0;
  /// What of so much memory that would hold the whole input may be used.
  virtual std::uint64_t memory_for_shares(std::uint64_t all_bytes) const = 0;
  /// That make shares; 0: one a core. `taken_bytes` are in use beside them.
  virtual unsigned threads(std::uint64_t triangles, std::uint32_t shares,
                           std::uint64_t taken_bytes) const = 0;
  /// From several threads: makes of a share what the stage holds, and publishes it.
  virtual StagedShare stage_share(MeshShare share, std::uint32_t number) const = 0;
  /// Puts the boundary triangles of a region in the order in which they are staged.
  virtual void order_boundary(SharedTriangles& triangles) const = 0;
};

/// These refer to what they are given.
std::unique_ptr<CutScheme> make_part_scheme(const MeshSource& source, const Stage& stage,
                                            const CutOptions& options);
std::unique_ptr<CutScheme> make_stream_scheme(const MeshSource& source, const Stage& stage,
                                              const CutOptions& options);

}  // namespace meshfarm
