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

/// A share after staging.
struct StagedShare : WeldCounts {
  PartEntry entry;
  std::optional<PartEntry> sample;  // of a stream; without a name if it needs none
  BoundaryNumbers numbers;
  UvFacts uv_facts;
  std::uint64_t label_corners = 0;
};

/// The scheme-specific steps of a cut; everything else is common (cut.cpp).
class CutScheme {
 public:
  /// For messages.
  struct Words {
    std::string_view work;    // "the cut"
    std::string_view phases;  // prefix of the names of phases: "cut"
    std::string_view shares;  // the phase that makes the shares: "parts"
  };

  virtual ~CutScheme() = default;
  virtual Words words() const = 0;
  /// Looks at all vertices in the order they come in; null if not needed.
  virtual OrderProbe* probe() { return nullptr; }
  /// The map from vertices to shares, for the box and the input in the manifest, to which the
  /// scheme is added. The map is not settled yet.
  virtual std::unique_ptr<ShareMap> choose_map(Manifest& manifest) = 0;
  /// The memory to use for shares, given the memory that would hold the whole input.
  virtual std::uint64_t memory_for_shares(std::uint64_t all_bytes) const = 0;
  /// Threads that make shares; 0: one per core. `taken_bytes` are in use besides them.
  virtual unsigned threads(std::uint64_t triangles, std::uint32_t shares,
                           std::uint64_t taken_bytes) const = 0;
  /// Called from several threads: converts a share to its staged form, and publishes it.
  virtual StagedShare stage_share(MeshShare share, std::uint32_t number) const = 0;
  /// Puts the boundary triangles of a region in the order for the stage.
  virtual void order_boundary(SharedTriangles& triangles) const = 0;
};

/// These keep references to their arguments.
std::unique_ptr<CutScheme> make_part_scheme(const MeshSource& source, const Stage& stage,
                                            const CutOptions& options);
std::unique_ptr<CutScheme> make_stream_scheme(const MeshSource& source, const Stage& stage,
                                              const CutOptions& options);

}  // namespace meshfarm
