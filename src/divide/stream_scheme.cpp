// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Streams: Xiong, Jiang, Zhang, Shi, "Parallel Simplification of Large Meshes on PC Clusters",
// EGPGV 2008, 4.1. Each slab is sorted independently, on all cores, or staged unsorted and sorted
// by a job of the farm (pipeline/sort_job.hpp). Sorting uses distribution rather than merging runs:
// that, too, moves everything to disk and back once, but leaves nothing to merge.
#include <algorithm>
#include <utility>

#include <meshfarm/divide/slab.hpp>
#include <meshfarm/geometry/label_corners.hpp>
#include <meshfarm/io/slab_file.hpp>
#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/util/errors.hpp>

#include "divide/cut_scheme.hpp"
#include "divide/share_budget.hpp"
#include "divide/share_out.hpp"
#include "divide/sort_with_columns.hpp"

namespace meshfarm {
namespace {

class StreamScheme : public CutScheme {
 public:
  StreamScheme(const MeshSource& source, const Stage& stage, const CutOptions& options)
      : source_(source), stage_(stage), options_(options) {}

  Words words() const override {
    return {"the making of streams", "streams", sorts_here() ? "sort" : "stage"};
  }

  OrderProbe* probe() override { return &probe_; }

  std::unique_ptr<ShareMap> choose_map(Manifest& manifest) override {
    sorting_ = {probe_.choose(manifest.box), options_.weld};
    manifest.window_triangles = options_.window_triangles;
    if (!sorts_here()) manifest.sorting = sorting_;
    const std::uint64_t triangles = likely_triangles(source_.info());
    const std::uint64_t wanted =
        options_.parts != 0 ? options_.parts : default_parts(Scheme::stream, triangles);
    const ShareBudget budget{
        options_.sort_memory(),
        slab_bytes_per_triangle(has_appearances(source_), source_.info().columns())};
    return std::make_unique<SlabMap>(
        manifest.box, sorting_.order, budget.slabs(triangles, wanted),
        options_.weld == Weld::exact ? AtOnePoint::merge : AtOnePoint::deal);
  }

  /// The memory is used for sorting.
  std::uint64_t memory_for_shares(std::uint64_t) const override { return 0; }

  unsigned threads(std::uint64_t triangles, std::uint32_t shares,
                   std::uint64_t taken_bytes) const override {
    const ShareBudget budget{options_.sort_memory(), bytes_while_made(source_), taken_bytes};
    return budget.threads(triangles, shares, options_.threads);
  }

  StagedShare stage_share(MeshShare slab, std::uint32_t number) const override {
    StagedShare staged;
    staged.numbers = number_boundary(slab, sorting_);
    staged.label_corners =
        count_label_corners(slab.triangles, slab.columns.labels, slab.positions.size());
    sorts_here() ? stage_stream(sort_slab(std::move(slab), sorting_), number, staged)
                 : stage_slab(std::move(slab), number, staged);
    return staged;
  }

  /// Like the streams, the boundary must not depend on the order of the input.
  void order_boundary(SharedTriangles& shared) const override {
    for (std::size_t i = 0; i < shared.triangles.size(); ++i) {
      BoundaryTriangle& t = shared.triangles[i];
      const auto least = std::min_element(t.begin(), t.end());
      const auto turn = least - t.begin();
      std::rotate(t.begin(), least, t.end());
      if (shared.columns.uvs.empty()) continue;
      CornerUvs& uvs = shared.columns.uvs[i];
      std::rotate(uvs.begin(), uvs.begin() + turn, uvs.end());
    }
    sort_with_columns(shared.triangles, shared.columns);
  }

 private:
  bool sorts_here() const { return options_.sort == SortAt::here; }

  void stage_stream(SortedSlab slab, std::uint32_t number, StagedShare& staged) const {
    if (slab.boundary_vertices != staged.numbers.count()) {
      throw Error("a stream's boundary vertices are not those that were numbered");
    }
    static_cast<WeldCounts&>(staged) = slab;
    staged.sample = stage_sample(slab.stream, number);
    const Mesh& mesh = slab.stream.mesh;
    staged.entry = {{}, mesh.positions.size(), mesh.triangles.size(), slab.boundary_vertices};
    const std::string bytes = encode_stream(slab.stream);
    slab.stream = {};
    if (source_.info().uvs) staged.uv_facts = facts_of(bytes);
    staged.entry.file = stage_.publish(StreamName{number}, bytes);
  }

  /// No sample for a short stream: it can be simplified as a whole.
  PartEntry stage_sample(const StreamMesh& stream, std::uint32_t number) const {
    if (stream.mesh.triangles.size() <= options_.window_triangles) return {};
    const Part part = sample_slab(stream, sorting_.order, number);
    return {stage_.publish(PartName{number}, encode_part(part)), part.mesh.positions.size(),
            part.mesh.triangles.size(), part.boundary_vertices};
  }

  void stage_slab(MeshShare slab, std::uint32_t number, StagedShare& staged) const {
    slab.boundary = staged.numbers.places;
    staged.entry = {stage_.publish(SlabName{number}, encode_slab(slab)), slab.positions.size(),
                    slab.triangles.size(), staged.numbers.count()};
    // Texture facts must be known before the work, so the slab is sorted here anyway.
    if (!slab.columns.uvs.empty()) {
      staged.uv_facts = facts_of(encode_stream(sort_slab(std::move(slab), sorting_).stream));
    }
  }

  /// The facts of the stream as it will be read.
  static UvFacts facts_of(const std::string& stream) {
    StreamReader reader(fill_from(stream, "stream"), "stream");
    const Part part = read_stream(reader);
    return find_uv_facts(part.mesh, part.boundary_vertices);
  }

  const MeshSource& source_;
  const Stage& stage_;
  const CutOptions& options_;
  OrderProbe probe_;
  Sorting sorting_;
};

}  // namespace

std::unique_ptr<CutScheme> make_stream_scheme(const MeshSource& source, const Stage& stage,
                                              const CutOptions& options) {
  return std::make_unique<StreamScheme>(source, stage, options);
}

}  // namespace meshfarm
