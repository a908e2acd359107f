// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/result_facing.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/facing_repair.hpp>
#include <meshfarm/geometry/near_cells.hpp>
#include <meshfarm/pipeline/input_surface.hpp>

namespace meshfarm {
namespace {

/// Nearly all points of a surface are nearer to the other surface than half this multiple of the
/// RMS.
constexpr double k_reach = 8;
/// About this many triangles of the input are held at a time.
constexpr double k_held = 4'000'000;

class FacingMender {
 public:
  FacingMender(Mesh& result, const Stage& stage, const Manifest& manifest, unsigned threads)
      : result_(result), manifest_(manifest), threads_(threads), input_(stage, manifest, threads) {}

  FacingMended run(const ErrorMeter& meter) {
    const std::vector<std::uint32_t> opposed = find_opposed(meter);
    FacingRepair repair(result_, {.reach = reach_, .positions = manifest_.positions});
    FacingMended all;
    const std::size_t at_once = triangles_at_once();
    for (std::size_t first = 0; first < opposed.size(); first += at_once) {
      const auto some =
          std::span(opposed).subspan(first, std::min(at_once, opposed.size() - first));
      const FacingMended mended = repair.mend(some, input_near(some));
      all.found += mended.found;
      all.mended += mended.mended;
    }
    return all;
  }

 private:
  std::vector<std::uint32_t> find_opposed(const ErrorMeter& meter) {
    const DistanceMeter to_result(result_, threads_);
    reach_ = k_reach * meter.estimate_rms(to_result);
    if (!(reach_ > 0)) return {};
    return find_opposed_triangles(to_result.index(), reach_, threads_);
  }

  /// With its neighbourhood a triangle of the result stands for ten.
  std::size_t triangles_at_once() const {
    constexpr double k_round_about = 10;
    const double input_each = k_round_about * static_cast<double>(manifest_.triangles()) /
                              static_cast<double>(result_.triangles.size());
    return static_cast<std::size_t>(std::max(1.0, k_held / std::max(1.0, input_each)));
  }

  /// The input near all triangles at the vertices of these, in a deterministic order.
  Mesh input_near(std::span<const std::uint32_t> some) {
    std::vector<std::uint8_t> touched(result_.positions.size(), 0);
    for (const std::uint32_t i : some) {
      for (const std::uint32_t v : result_.triangles[i]) touched[v] = 1;
    }
    std::vector<Triangle> around;
    for (const Triangle& t : result_.triangles) {
      if ((touched[t[0]] | touched[t[1]] | touched[t[2]]) != 0) around.push_back(t);
    }
    const NearCells cells(result_.positions, around, 2 * reach_);
    std::vector<Mesh> of_parts(manifest_.parts.size() + 1);
    input_.show([&](const Box& box) { return cells.touch(box); },
                [&](const SurfacePiece& piece) { add_near(piece, cells, of_parts[piece.part]); });
    Mesh near;
    for (const Mesh& part : of_parts) {
      const auto first = static_cast<std::uint32_t>(near.positions.size());
      near.positions.insert(near.positions.end(), part.positions.begin(), part.positions.end());
      for (const auto& [a, b, c] : part.triangles) {
        near.triangles.push_back({first + a, first + b, first + c});
      }
    }
    return near;
  }

  static void add_near(const SurfacePiece& piece, const NearCells& cells, Mesh& near) {
    for (const std::uint32_t i : cells.touching(piece.positions, piece.triangles)) {
      const Triangle& t = piece.triangles[i];
      const auto first = static_cast<std::uint32_t>(near.positions.size());
      for (const std::uint32_t v : t) near.positions.push_back(piece.positions[v]);
      near.triangles.push_back({first, first + 1, first + 2});
    }
  }

  Mesh& result_;
  const Manifest& manifest_;
  double reach_ = 0;
  unsigned threads_;
  InputSurface input_;
};

}  // namespace

FacingMended mend_facing(Mesh& result, const ErrorMeter& meter, const Stage& stage,
                         const Manifest& manifest, unsigned threads) {
  if (result.triangles.empty()) return {};
  return FacingMender(result, stage, manifest, threads).run(meter);
}

}  // namespace meshfarm
