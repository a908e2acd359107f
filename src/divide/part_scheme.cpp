// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Compact parts: Xiong, Jiang, Zhang, Shi, "Parallel Simplification of Large Meshes on PC
// Clusters", EGPGV 2008, 3.1.
#include <algorithm>
#include <utility>

#include <meshfarm/geometry/label_corners.hpp>

#include "divide/cell_graph.hpp"
#include "divide/cell_map.hpp"
#include "divide/cut_scheme.hpp"
#include "divide/part_builder.hpp"
#include "divide/share_budget.hpp"
#include "divide/share_out.hpp"

namespace meshfarm {
namespace {

/// A mesh that fits into this much memory is cut without scratch files.
constexpr std::uint64_t k_memory_bytes = std::uint64_t{256} << 20;

class PartScheme : public CutScheme {
 public:
  PartScheme(const MeshSource& source, const Stage& stage, const CutOptions& options)
      : source_(source), stage_(stage), options_(options) {}

  Words words() const override { return {"the cut", "cut", "parts"}; }

  std::unique_ptr<ShareMap> choose_map(Manifest& manifest) override {
    manifest.partitioner = partitioner_name();
    const std::uint32_t wanted = options_.parts != 0
                                     ? options_.parts
                                     : default_parts(Scheme::cut, likely_triangles(source_.info()));
    return std::make_unique<CellMap>(manifest.box,
                                     CellMapOptions{wanted, options_.weld, options_.threads});
  }

  std::uint64_t memory_for_shares(std::uint64_t all_bytes) const override {
    const std::uint64_t most =
        has_limit() ? std::min(k_memory_bytes, options_.memory_bytes / 4) : k_memory_bytes;
    return all_bytes <= most ? all_bytes : 0;
  }

  unsigned threads(std::uint64_t triangles, std::uint32_t shares,
                   std::uint64_t taken_bytes) const override {
    if (!has_limit()) return options_.threads;
    const ShareBudget budget{options_.memory_bytes, bytes_while_made(source_), taken_bytes};
    return budget.threads(triangles, shares, options_.threads);
  }

  StagedShare stage_share(MeshShare share, std::uint32_t number) const override {
    const std::uint64_t shared = share.triangles.size();
    BuiltPart built = build_part(std::move(share), options_.weld);
    Mesh& mesh = built.part.mesh;
    StagedShare staged;
    static_cast<WeldCounts&>(staged) = built;
    staged.numbers = std::move(built.boundary);
    staged.label_corners =
        count_label_corners(mesh.triangles, mesh.columns.labels, mesh.positions.size());
    staged.uv_facts = find_uv_facts(mesh, built.part.boundary_vertices);
    staged.entry = {{},
                    mesh.positions.size(),
                    mesh.triangles.size(),
                    built.part.boundary_vertices,
                    shared,
                    static_cast<std::uint32_t>(staged.numbers.places.size())};
    const std::string bytes = encode_part(built.part);
    mesh = {};
    staged.entry.file = stage_.publish(PartName{number}, bytes);
    return staged;
  }

  /// The order of the input.
  void order_boundary(SharedTriangles&) const override {}

 private:
  bool has_limit() const { return options_.memory_bytes > 0; }

  const MeshSource& source_;
  const Stage& stage_;
  const CutOptions& options_;
};

}  // namespace

std::unique_ptr<CutScheme> make_part_scheme(const MeshSource& source, const Stage& stage,
                                            const CutOptions& options) {
  return std::make_unique<PartScheme>(source, stage, options);
}

}  // namespace meshfarm
