// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "peer.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <limits>
#include <utility>

#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/io/ply_writer.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm::bench {
namespace {

double seconds(clockid_t clock) {
  timespec now{};
  if (clock_gettime(clock, &now) != 0) throw_errno("read the clock", "");
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Mesh cleaned(const Mesh& raw) {
  constexpr std::uint32_t k_unused = std::numeric_limits<std::uint32_t>::max();
  const WeldResult twins = weld(raw.positions);
  std::vector<std::uint32_t> index(raw.positions.size(), k_unused);
  Mesh clean;
  clean.triangles.reserve(raw.triangles.size());
  for (const Triangle& corners : raw.triangles) {
    Triangle t{};
    for (std::size_t i = 0; i < 3; ++i) t[i] = twins.first[corners[i]];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    clean.triangles.push_back(t);
    for (const std::uint32_t vertex : t) index[vertex] = 0;
  }
  for (std::size_t vertex = 0; vertex < index.size(); ++vertex) {
    if (index[vertex] == k_unused) continue;
    index[vertex] = static_cast<std::uint32_t>(clean.positions.size());
    clean.positions.push_back(raw.positions[vertex]);
  }
  for (Triangle& t : clean.triangles) {
    for (std::uint32_t& vertex : t) vertex = index[vertex];
  }
  return clean;
}

double parse_ratio(const char* text) {
  char* end = nullptr;
  const double ratio = std::strtod(text, &end);
  if (end == text || *end != '\0' || !(ratio > 0 && ratio <= 1)) {
    throw UsageError("RATIO: above 0 and up to 1");
  }
  return ratio;
}

CommandLine parse(int argc, char** argv) {
  if (argc != 4) throw UsageError("usage: INPUT.ply OUTPUT.ply RATIO");
  return {argv[1], argv[2], parse_ratio(argv[3])};
}

Outcome simplify_file(const Peer& peer, const CommandLine& command) {
  const auto source = open_mesh(command.input);
  const PositionType positions = source->info().positions;
  Task task{cleaned(read_mesh(*source)), 0, positions};
  task.target = share_of(task.mesh.triangles.size(), command.ratio);
  Outcome outcome{peer.tool, peer.version, {}, 0};
  const Mesh result = peer.simplify(std::move(task), outcome.watch);
  write_ply(command.output, result, positions);
  outcome.triangles = result.triangles.size();
  return outcome;
}

void print(const Outcome& outcome) {
  std::printf(
      "{\"tool\": \"%s\", \"version\": \"%s\", \"cpu_s\": %.4f, \"wall_s\": %.4f, "
      "\"triangles\": %llu}\n",
      outcome.tool.c_str(), outcome.version.c_str(), outcome.watch.cpu_s(), outcome.watch.wall_s(),
      static_cast<unsigned long long>(outcome.triangles));
}

}  // namespace

void Stopwatch::start() {
  wall_s_ = -seconds(CLOCK_MONOTONIC);
  cpu_s_ = -seconds(CLOCK_PROCESS_CPUTIME_ID);
}

void Stopwatch::stop() {
  cpu_s_ += seconds(CLOCK_PROCESS_CPUTIME_ID);
  wall_s_ += seconds(CLOCK_MONOTONIC);
}

std::uint64_t share_of(std::uint64_t triangles, double ratio) {
  return static_cast<std::uint64_t>(std::llround(ratio * static_cast<double>(triangles)));
}

int run_program(int argc, char** argv, const std::function<Outcome(const CommandLine&)>& run) {
  try {
    print(run(parse(argc, argv)));
    return 0;
  } catch (const UsageError& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
    return 1;
  }
}

int run_peer(int argc, char** argv, const Peer& peer) {
  return run_program(argc, argv,
                     [&](const CommandLine& command) { return simplify_file(peer, command); });
}

}  // namespace meshfarm::bench
