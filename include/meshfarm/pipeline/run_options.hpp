// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/util/bytes.hpp>

namespace meshfarm {

/// How the parts' triangles are shared out.
enum class Allocation : std::uint8_t {
  threshold,  // one cost threshold for all parts: flat parts end with fewer triangles
  uniform,    // the same ratio in every part (Xiong et al. 2008)
};

/// What the last pass over the stitched mesh may touch.
enum class Finish : std::uint8_t {
  global,    // everything, down to the exact count
  boundary,  // edges at boundary vertices only (Xiong et al. 2008, 3.3)
};

/// How swept streams become one mesh.
enum class Composition : std::uint8_t {
  automatic,  // as a tree where that is worth its rounds
  tree,       // neighbours are joined by jobs of the farm first
  sink,       // the sink joins all
};

/// A length in the mesh's unit, or as a fraction of the diagonal of its bounding box.
struct Length {
  double value = 0;
  bool of_diagonal = false;
  double in(const Box& box) const { return of_diagonal ? value * box.diagonal() : value; }
};

/// What a run is asked to make of a stage.
struct RunOptions {
  double ratio = 0;  // of the input's triangles; used when triangles is 0
  std::uint64_t triangles = 0;
  Length error;  // where above 0: as few triangles as keep this distance
  Allocation allocation = Allocation::threshold;
  Finish finish = Finish::global;
  Composition composition = Composition::automatic;
  LineOptions lines;
  Length drop_components;  // components with a smaller diagonal are left out
};

/// The number of triangles that the result shall have. Throws UsageError if the options name
/// neither a ratio in (0, 1] nor a count.
std::uint64_t target_triangles(const Manifest& manifest, const RunOptions& options);

/// As they stand in a job's parameters: preserve border u8 | crease angle f64 |
/// topology u8.
void put(ByteWriter& out, const LineOptions& lines);
LineOptions get_lines(ByteReader& in);

/// Tells one run from another on the same stage.
std::uint64_t run_key(const Manifest& manifest, const RunOptions& options);

}  // namespace meshfarm
