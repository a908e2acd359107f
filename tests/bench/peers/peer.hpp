// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include <meshfarm/geometry/mesh.hpp>

namespace meshfarm::bench {

/// CPU time of all threads of this process, and wall time, between start() and stop(); further
/// intervals are added.
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

/// The input of every peer: the same clean mesh, and the number of triangles wanted.
struct Task {
  /// Coincident vertices are merged, no triangle has two equal corners, every vertex is used. Has
  /// the colours of the input, if any; a peer that cannot take them returns none.
  Mesh mesh;
  std::uint64_t target = 0;
  PositionType positions = PositionType::float32;
};

struct Peer {
  std::string tool;
  std::string version;
  /// Converts the mesh to the peer's own form, simplifies it under the stopwatch, converts it back.
  Mesh (*simplify)(Task task, Stopwatch& watch) = nullptr;
};

/// INPUT.ply OUTPUT.ply RATIO: the same command line for every program here.
struct CommandLine {
  std::string input;
  std::string output;
  double ratio = 0;
};

struct Outcome {
  std::string tool;
  std::string version;
  Stopwatch watch;
  std::uint64_t triangles = 0;
};

/// The first three components of an appearance, from 0 to 1.
std::array<float, 3> colour_of(const Appearance& appearance);
Appearance appearance_of(std::span<const float, 3> colour);

/// The number of triangles wanted, by meshfarm's own rule.
std::uint64_t share_of(std::uint64_t triangles, double ratio);

/// The whole program: parses the command line, runs, prints the outcome as one JSON line, errors on
/// stderr. Returns the exit code.
int run_program(int argc, char** argv, const std::function<Outcome(const CommandLine&)>& run);

/// The program of a peer: reads and cleans, simplifies under the stopwatch, writes.
int run_peer(int argc, char** argv, const Peer& peer);

}  // namespace meshfarm::bench
