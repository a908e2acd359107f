// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The inner loops on generated meshes, on one thread unless stated otherwise. Items are triangles,
// or vertices where stated.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <fcntl.h>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/io/ply_writer.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

namespace meshfarm::bench {
namespace {

Mesh torus(std::int64_t triangles) {
  return in_memory(BumpyTorus(static_cast<std::uint64_t>(triangles)));
}

/// A temporary folder, removed at the end.
class WorkFolder {
 public:
  WorkFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "meshfarm-bench-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw_errno("make a folder like", name);
    path_ = name;
  }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  ~WorkFolder() {
    std::error_code left_behind;
    std::filesystem::remove_all(path_, left_behind);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void count_items(benchmark::State& state, std::size_t items) {
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(items));
}

/// Waves in three colours, a few triangles long.
Appearance waves(Vec3 p) {
  const auto wave = [](double x) {
    return static_cast<std::uint16_t>(257 * static_cast<int>(127.5 + 127 * std::sin(60 * x)));
  };
  return {wave(p.x), wave(p.y), wave(p.z), 0};
}

/// Arguments: triangles, percentage of triangles kept, whether they are coloured.
void simplify(benchmark::State& state) {
  Mesh mesh = torus(state.range(0));
  SimplifyOptions options;
  if (state.range(2) != 0) {
    for (const Vec3& p : mesh.positions) mesh.appearances.push_back(waves(p));
    options.lines.appearance_scale.length = 0.01;
  }
  options.positions = PositionType::float32;
  SimplifyGoal goal;
  goal.triangles = mesh.triangles.size() * static_cast<std::uint64_t>(state.range(1)) / 100;
  for (auto _ : state) {
    state.PauseTiming();
    Mesh copy = mesh;
    state.ResumeTiming();
    Simplifier simplifier(std::move(copy), options);
    simplifier.reduce(goal);
    benchmark::DoNotOptimize(simplifier.triangles());
  }
  count_items(state, mesh.triangles.size());
}
BENCHMARK(simplify)
    ->ArgNames({"triangles", "percent", "coloured"})
    ->ArgsProduct({{50'000, 200'000, 1'000'000}, {10, 1}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

/// Vertices without twins, and six copies of each.
void weld_distinct(benchmark::State& state) {
  const Mesh mesh = torus(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(weld(mesh.positions).merged);
  count_items(state, mesh.positions.size());
}
BENCHMARK(weld_distinct)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void weld_soup(benchmark::State& state) {
  const Mesh mesh = torus(state.range(0));
  std::vector<Vec3> corners;
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t vertex : t) corners.push_back(mesh.positions[vertex]);
  }
  for (auto _ : state) benchmark::DoNotOptimize(weld(corners).merged);
  count_items(state, corners.size());
}
BENCHMARK(weld_soup)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void topology(benchmark::State& state) {
  const Mesh mesh = torus(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(measure_topology(mesh).edges);
  count_items(state, mesh.triangles.size());
}
BENCHMARK(topology)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void write_ascii(const std::filesystem::path& path, const Mesh& mesh) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " +
                     std::to_string(mesh.positions.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                     std::to_string(mesh.triangles.size()) +
                     "\nproperty list uchar int vertex_indices\nend_header\n";
  char line[100];
  for (const Vec3& p : mesh.positions) {
    std::snprintf(line, sizeof line, "%.9g %.9g %.9g\n", p.x, p.y, p.z);
    text += line;
  }
  for (const Triangle& t : mesh.triangles) {
    std::snprintf(line, sizeof line, "3 %u %u %u\n", t[0], t[1], t[2]);
    text += line;
  }
  const Fd fd(creat(path.c_str(), 0600));
  if (!fd) throw_errno("create", path);
  write_all(fd.get(), text, path);
}

void scan(benchmark::State& state, const std::filesystem::path& path) {
  const auto source = open_mesh(path);
  for (auto _ : state) {
    double sum = 0;
    source->scan_vertices([&](std::span<const Vec3> batch) { sum += batch.front().x; });
    source->scan_triangles(
        [&](std::span<const WideTriangle> batch) { sum += static_cast<double>(batch.size()); });
    benchmark::DoNotOptimize(sum);
  }
  count_items(state, source->info().faces);
  state.SetBytesProcessed(state.iterations() *
                          static_cast<std::int64_t>(std::filesystem::file_size(path)));
}

void scan_ply_binary(benchmark::State& state) {
  const WorkFolder folder;
  const auto path = folder.path() / "torus.ply";
  write_ply(path, torus(state.range(0)), PositionType::float32);
  scan(state, path);
}
BENCHMARK(scan_ply_binary)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

void scan_ply_ascii(benchmark::State& state) {
  const WorkFolder folder;
  const auto path = folder.path() / "torus.ply";
  write_ascii(path, torus(state.range(0)));
  scan(state, path);
}
BENCHMARK(scan_ply_ascii)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

/// Arguments: triangles, threads (0: one per core). CPU time is that of all threads.
void cut(benchmark::State& state) {
  const WorkFolder folder;
  const auto path = folder.path() / "torus.ply";
  write_ply(path, torus(state.range(0)), PositionType::float32);
  CutOptions options;
  options.threads = static_cast<unsigned>(state.range(1));
  std::uint64_t triangles = 0;
  for (auto _ : state) {
    const auto source = open_mesh(path);
    const Stage stage = Stage::create(folder.path() / "stage");
    triangles = cut_mesh(*source, stage, options).triangles();
    state.PauseTiming();
    remove_stage(stage.root());
    state.ResumeTiming();
  }
  count_items(state, triangles);
}
BENCHMARK(cut)
    ->ArgNames({"triangles", "threads"})
    ->ArgsProduct({{1'000'000, 4'000'000}, {1, 0}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace meshfarm::bench
