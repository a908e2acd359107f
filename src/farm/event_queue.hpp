// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <meshfarm/farm/simulation.hpp>

namespace meshfarm {

/// Events of a simulation, in the order of their time and, at one time, of their planning.
class EventQueue {
 public:
  using Event = std::function<void()>;

  SimulatedTime now() const { return now_; }
  bool empty() const { return heap_.empty(); }
  std::uint64_t count() const { return count_; }

  /// Plans an event; a time that has passed means now.
  void at(SimulatedTime time, Event event) {
    std::uint32_t slot = 0;
    if (free_.empty()) {
      slot = static_cast<std::uint32_t>(slots_.size());
      slots_.push_back(std::move(event));
    } else {
      slot = free_.back();
      free_.pop_back();
      slots_[slot] = std::move(event);
    }
    heap_.push_back({std::max(time, now_), planned_++, slot});
    std::push_heap(heap_.begin(), heap_.end(), later);
  }
  void in(SimulatedTime delay, Event event) { at(now_ + delay, std::move(event)); }

  /// Moves the clock to the next event and lets it happen.
  void step() {
    std::pop_heap(heap_.begin(), heap_.end(), later);
    const Entry next = heap_.back();
    heap_.pop_back();
    now_ = next.time;
    ++count_;
    const Event event = std::exchange(slots_[next.slot], nullptr);
    free_.push_back(next.slot);
    event();
  }

 private:
  struct Entry {
    SimulatedTime time;
    std::uint64_t order;
    std::uint32_t slot;
  };
  static bool later(const Entry& a, const Entry& b) {
    return a.time != b.time ? a.time > b.time : a.order > b.order;
  }

  SimulatedTime now_{0};
  std::uint64_t planned_ = 0;
  std::uint64_t count_ = 0;
  std::vector<Entry> heap_;
  std::vector<Event> slots_;
  std::vector<std::uint32_t> free_;
};

}  // namespace meshfarm
