// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// meshfarm's kernel, plus the fit of the colours that ends a whole run.
#include <utility>
#include <vector>

#include <meshfarm/geometry/channel_fit.hpp>

#include "meshfarm_kernel.hpp"

namespace meshfarm::bench {
namespace {

constexpr std::size_t k_channels = 3;

std::vector<float> colours_of(const Mesh& mesh) {
  std::vector<float> values;
  values.reserve(k_channels * mesh.appearances.size());
  for (const Appearance& appearance : mesh.appearances) {
    for (const float level : colour_of(appearance)) values.push_back(level);
  }
  return values;
}

Mesh simplify_and_fit(Task task, Stopwatch& watch) {
  const std::vector<Vec3> points = task.mesh.positions;
  const std::vector<float> colours = colours_of(task.mesh);
  Mesh result = simplify_by_kernel(std::move(task), watch);
  if (result.appearances.empty()) return result;
  watch.start();
  ChannelFit fit(result, {k_channels, points.size(), 1});
  fit.add(points, colours);
  const std::vector<float> fitted = fit.values();
  watch.stop();
  for (std::size_t v = 0; v < result.appearances.size(); ++v) {
    result.appearances[v] =
        appearance_of(std::span(fitted).subspan(k_channels * v).first<k_channels>());
  }
  return result;
}

}  // namespace
}  // namespace meshfarm::bench

int main(int argc, char** argv) {
  using namespace meshfarm::bench;
  return run_peer(argc, argv, {"meshfarm kernel and fit", MESHFARM_VERSION, simplify_and_fit});
}
