// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "simulation/simulated_storage.hpp"

#include <algorithm>

namespace meshfarm {
namespace {

/// A link carries one transfer after another: returns when this one ends.
SimulatedTime through(SimulatedTime& free, SimulatedTime now, std::uint64_t bytes,
                      double bytes_per_s) {
  if (bytes_per_s <= 0) return now;
  const double seconds = static_cast<double>(bytes) / bytes_per_s;
  free = std::max(free, now) + SimulatedTime(static_cast<std::int64_t>(seconds * 1e6));
  return free;
}

}  // namespace

SimulatedTime SimulatedFolder::transfer(std::uint32_t host, std::uint64_t bytes) {
  const SimulatedTime now = queue_.now();
  if (storage_.server_bytes_per_s > 0) {
    server_busy_s_ += static_cast<double>(bytes) / storage_.server_bytes_per_s;
  }
  const SimulatedTime served = through(server_free_, now, bytes, storage_.server_bytes_per_s);
  const SimulatedTime arrived = through(host_free_[host], now, bytes, storage_.host_bytes_per_s);
  return std::max({served, arrived, stalled_until_}) + storage_.delay;
}

SimulatedTime SimulatedFolder::read(std::uint32_t host, std::uint64_t bytes, const Extent& extent) {
  HostCache& cache = caches_[host];
  const std::uint64_t of_extent = extent.name == 0 ? 0 : std::min(bytes, extent.bytes);
  const std::uint64_t had = std::min(cache.has(extent.name), of_extent);
  if (had < of_extent) cache.keep({extent.name, of_extent}, storage_.cache_bytes);
  cache.keep({0, bytes - of_extent}, storage_.cache_bytes);
  return transfer(host, bytes - had);
}

SimulatedTime SimulatedFolder::write(std::uint32_t host, std::uint64_t bytes) {
  caches_[host].keep({0, bytes}, storage_.cache_bytes);
  return transfer(host, bytes);
}

std::uint64_t HostCache::has(std::uint64_t extent) const {
  const auto found = by_name_.find(extent);
  return found == by_name_.end() ? 0 : found->second;
}

void HostCache::keep(const Extent& bytes, std::uint64_t limit) {
  if (bytes.bytes == 0) return;
  kept_.push_back(bytes);
  bytes_ += bytes.bytes;
  if (bytes.name != 0) by_name_[bytes.name] = bytes.bytes;
  for (; bytes_ > limit; kept_.pop_front()) {
    bytes_ -= kept_.front().bytes;
    by_name_.erase(kept_.front().name);
  }
}

bool SimulatedFolder::publish(const std::string& name, Content content) {
  return files_.try_emplace(name, content).second;
}

bool SimulatedFolder::has_whole(const std::string& name) const {
  const auto found = files_.find(name);
  return found != files_.end() && found->second == Content::whole;
}

bool SimulatedFolder::seems_whole(const std::string& name) const {
  const auto found = files_.find(name);
  return found != files_.end() && found->second != Content::cut_short;
}

SimulatedTime SimulatedFolder::visibility_delay() {
  if (!faulty()) return SimulatedTime(0);
  // Measured on NFS v3 and v4.2: a name looked up too early stays invisible for 30 to 60 s.
  if (dice_.chance(faults_.unseen)) return SimulatedTime(30'000'000 + dice_.pick(30'000'000));
  if (dice_.chance(faults_.stale)) return SimulatedTime(dice_.pick(10'000'000));
  return SimulatedTime(0);
}

}  // namespace meshfarm
