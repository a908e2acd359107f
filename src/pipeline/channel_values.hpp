// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/run_options.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// The values of a result's vertices, all channels of the first vertex first, and how far they are
/// from those of the input's vertices: the root mean square, per channel.
struct ChannelValues {
  std::vector<Channel> channels;
  std::vector<float> values;
  std::vector<double> rms;
};

struct ChannelFitting {
  std::vector<std::size_t> columns;  // of the staged channels
  Normals normals = Normals::blend;
  unsigned threads = 0;  // 0: one per core
};

/// Fits these staged channels of the input, at least one, to the result (geometry/channel_fit.hpp).
/// Recomputed normals are those of the result's triangles. `progress` is told the share that is
/// done. The outcome does not depend on the threads.
ChannelValues fit_channels(const Stage& stage, const Manifest& manifest, const Mesh& result,
                           const ChannelFitting& fitting,
                           const std::function<void(double done)>& progress);

}  // namespace meshfarm
