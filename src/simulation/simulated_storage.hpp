// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <unordered_map>
#include <vector>

#include <meshfarm/simulation/simulation.hpp>
#include <meshfarm/staging/patience.hpp>

#include "simulation/dice.hpp"
#include "simulation/event_queue.hpp"

namespace meshfarm {

/// A host's cached bytes of extents: the last bytes that it read and wrote, up to a limit.
class HostCache {
 public:
  /// The number of cached bytes of the extent.
  std::uint64_t has(std::uint64_t extent) const;
  /// This many bytes were read or written, of an extent or of none.
  void keep(const Extent& bytes, std::uint64_t limit);

 private:
  std::deque<Extent> kept_;  // oldest first
  std::uint64_t bytes_ = 0;
  std::unordered_map<std::uint64_t, std::uint64_t> by_name_;
};

/// The shared folder: how long transfers take, and what readers see.
class SimulatedFolder {
 public:
  SimulatedFolder(const SimulationOptions& options, std::uint32_t hosts, Dice& dice,
                  const EventQueue& queue)
      : storage_(options.storage),
        faults_(options.faults),
        dice_(dice),
        queue_(queue),
        host_free_(hosts),
        caches_(hosts),
        sick_until_(hosts) {}

  /// When this many bytes, requested now by that host, have arrived.
  SimulatedTime transfer(std::uint32_t host, std::uint64_t bytes);
  /// The same for a job's reads, some of which the host may have cached; and for its writes.
  SimulatedTime read(std::uint32_t host, std::uint64_t bytes, const Extent& extent);
  SimulatedTime write(std::uint32_t host, std::uint64_t bytes);

  /// Gives a finished file its name. False if the name was taken: two writers shared it.
  enum class Content : std::uint8_t { whole, damaged, cut_short };
  bool publish(const std::string& name, Content content);
  /// Damages a finished file that was whole.
  void damage(const std::string& name, Content content) { files_.at(name) = content; }
  bool has_whole(const std::string& name) const;
  /// As far as its size shows.
  bool seems_whole(const std::string& name) const;

  /// The extra time to open and read a reported name: a name looked up too early stays invisible,
  /// an old state stays visible.
  SimulatedTime visibility_delay();

  /// How long a reader retries what it cannot read.
  static inline const SimulatedTime k_patience = ReadPatience{}.missing;
  /// From when on that host can read the files that are reported to it.
  SimulatedTime readable(std::uint32_t host) const {
    return std::max(sick_until_[host], queue_.now());
  }
  void sicken(std::uint32_t host, SimulatedTime until) { sick_until_[host] = until; }
  void stall(SimulatedTime until) { stalled_until_ = until; }
  void fill(SimulatedTime until) { full_until_ = until; }
  bool full() const { return queue_.now() < full_until_; }
  double server_busy_s() const { return server_busy_s_; }
  bool stalled() const { return queue_.now() < stalled_until_; }

 private:
  bool faulty() const { return queue_.now() < faults_.end; }

  const SimulatedStorage& storage_;
  const SimulatedFaults& faults_;
  Dice& dice_;
  const EventQueue& queue_;
  SimulatedTime server_free_{0};
  double server_busy_s_ = 0;
  std::vector<SimulatedTime> host_free_;
  std::vector<HostCache> caches_;          // by host
  std::vector<SimulatedTime> sick_until_;  // by host
  SimulatedTime stalled_until_{0};
  SimulatedTime full_until_{0};
  std::unordered_map<std::string, Content> files_;
};

}  // namespace meshfarm
