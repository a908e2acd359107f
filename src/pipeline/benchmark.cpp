// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A cached speed is a file speed-KEYHASH of two lines: the key, and triangles per second. The name
// has the key's hash, so hosts that share a home do not overwrite each other's.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include <unistd.h>

#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/pipeline/benchmark.hpp>
#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/control_groups.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm {
namespace {

constexpr std::uint64_t k_triangles = 40'000;
constexpr std::chrono::milliseconds k_duration{250};
constexpr std::uint64_t k_usual_speed = 3'000'000;

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 1);
  }
  return "unknown";
}

std::string this_host() {
  char name[256] = {};
  return ::gethostname(name, sizeof name - 1) == 0 ? name : "unknown";
}

std::filesystem::path file_of(const std::filesystem::path& folder, std::string_view key) {
  return folder / ("speed-" + to_hex(checksum(key)));
}

}  // namespace

std::uint64_t measure_speed() {
  using Clock = std::chrono::steady_clock;
  const Mesh mesh = in_memory(BumpyTorus(k_triangles));
  const auto collapse_away = [&] { Simplifier(mesh, {}).reduce({.triangles = 0}); };
  collapse_away();  // warms caches and memory, which later rounds find warm
  std::uint64_t rounds = 0;
  const auto start = Clock::now();
  Clock::duration took{0};
  for (; took < k_duration; took = Clock::now() - start) {
    collapse_away();
    ++rounds;
  }
  const double seconds = std::chrono::duration<double>(took).count();
  return static_cast<std::uint64_t>(static_cast<double>(rounds * mesh.triangles.size()) / seconds);
}

std::string speed_key(std::string_view program_version) {
  char limit[32];
  std::snprintf(limit, sizeof limit, "%.2f", group_cores().value_or(0));
  return std::string(program_version) + " | " + this_host() + " |" + cpu_model() + " | " + limit;
}

std::filesystem::path speed_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && *cache == '/') return std::filesystem::path(cache) / "meshfarm";
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home != '/') return {};
  return std::filesystem::path(home) / ".cache" / "meshfarm";
}

std::uint64_t remembered_speed(const std::filesystem::path& folder, std::string_view key) {
  std::ifstream file(file_of(folder, key));
  std::string of;
  std::uint64_t speed = 0;
  if (!std::getline(file, of) || of != key || !(file >> speed)) return 0;
  return speed;
}

void remember_speed(const std::filesystem::path& folder, std::string_view key,
                    std::uint64_t speed) {
  if (folder.empty()) return;
  try {
    std::filesystem::create_directories(folder);
    AtomicFile file(file_of(folder, key));
    file.write(std::string(key) + "\n" + std::to_string(speed) + "\n");
    file.commit();
  } catch (const std::exception& error) {
    log_debug("the benchmark is not remembered: " + std::string(error.what()));
  }
}

std::uint64_t speed_of_this_host(std::string_view program_version, Haste haste) {
  const std::string key = speed_key(program_version);
  const std::filesystem::path folder = speed_folder();
  std::uint64_t speed = remembered_speed(folder, key);
  if (speed == 0 && haste == Haste::great) return k_usual_speed;
  if (speed == 0) {
    speed = measure_speed();
    remember_speed(folder, key, speed);
  }
  return speed;
}

}  // namespace meshfarm
