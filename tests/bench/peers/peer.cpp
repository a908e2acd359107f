// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "peer.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <limits>
#include <utility>

#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/io/channel.hpp>
#include <meshfarm/io/mesh_sink.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/io/ply_writer.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm::bench {
namespace {

constexpr float k_range = 65535;  // of an appearance's components

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
    append_vertex(VertexView(raw), vertex, clean);
  }
  for (Triangle& t : clean.triangles) {
    for (std::uint32_t& vertex : t) vertex = index[vertex];
  }
  return clean;
}

Mesh read_coloured(MeshSource& source) {
  Mesh mesh = read_mesh(source);
  if (!has_appearances(source)) return mesh;
  scan_appearances(source, [&](const VertexView& batch) {
    mesh.appearances.insert(mesh.appearances.end(), batch.appearances.begin(),
                            batch.appearances.end());
  });
  return mesh;
}

void write_coloured(const std::string& path, const Mesh& mesh, PositionType positions) {
  std::vector<Channel> colours;
  for (const char* name : {"red", "green", "blue"}) {
    colours.push_back({name, ChannelType::uint8, ChannelRole::colour});
  }
  const auto sink =
      create_ply(path, {mesh.positions.size(), mesh.triangles.size(), positions, "", colours});
  std::vector<float> values;
  for (const Appearance& appearance : mesh.appearances) {
    for (const float level : colour_of(appearance)) values.push_back(level * 255);
  }
  sink->vertices(mesh.positions, values);
  sink->triangles(mesh.triangles);
  sink->commit();
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
  Task task{cleaned(read_coloured(*source)), 0, positions};
  task.target = share_of(task.mesh.triangles.size(), command.ratio);
  Outcome outcome{peer.tool, peer.version, {}, 0};
  const Mesh result = peer.simplify(std::move(task), outcome.watch);
  if (result.appearances.empty()) {
    write_ply(command.output, result, positions);
  } else {
    write_coloured(command.output, result, positions);
  }
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
  wall_s_ -= seconds(CLOCK_MONOTONIC);
  cpu_s_ -= seconds(CLOCK_PROCESS_CPUTIME_ID);
}

void Stopwatch::stop() {
  cpu_s_ += seconds(CLOCK_PROCESS_CPUTIME_ID);
  wall_s_ += seconds(CLOCK_MONOTONIC);
}

std::array<float, 3> colour_of(const Appearance& appearance) {
  return {static_cast<float>(appearance[0]) / k_range, static_cast<float>(appearance[1]) / k_range,
          static_cast<float>(appearance[2]) / k_range};
}

Appearance appearance_of(std::span<const float, 3> colour) {
  Appearance made{};
  for (std::size_t i = 0; i < colour.size(); ++i) {
    made[i] = static_cast<std::uint16_t>(std::lround(k_range * std::clamp(colour[i], 0.0F, 1.0F)));
  }
  return made;
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
