// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <ctime>
#include <string>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm::bench {

/// CPU time of all threads of this process, and wall time, between start() and stop().
class Stopwatch {
 public:
  void start();
  void stop();
  double cpu_s() const { return cpu_s_; }
  double wall_s() const { return wall_s_; }

 private:
  double cpu_s_ = 0;
  double wall_s_ = 0;
};

/// What every peer is given: the same clean mesh, and how many triangles are wanted of it.
struct Task {
  /// Coincident vertices are one, no triangle has two equal corners, every vertex is used.
  Mesh mesh;
  std::uint64_t target = 0;
  PositionType positions = PositionType::float32;
};

struct Peer {
  std::string tool;
  std::string version;
  /// Brings the mesh into the peer's own form, simplifies it under the stopwatch, brings it back.
  Mesh (*simplify)(Task task, Stopwatch& watch) = nullptr;
};

/// The whole program `peer_NAME INPUT.ply OUTPUT.ply RATIO`: reads and cleans, simplifies, writes,
/// prints one JSON line. Returns the exit code.
int run_peer(int argc, char** argv, const Peer& peer);

}  // namespace meshfarm::bench
