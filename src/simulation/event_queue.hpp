// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

#include <meshfarm/simulation/simulated_faults.hpp>

namespace meshfarm {

/// Holds a future event: a callable that stays in place until it is discarded. There are millions
/// of them, so those of usual size need no allocation.
class PlannedEvent {
 public:
  PlannedEvent() = default;
  PlannedEvent(const PlannedEvent&) = delete;
  PlannedEvent& operator=(const PlannedEvent&) = delete;
  ~PlannedEvent() { forget(); }

  /// Stores an event in an empty place.
  template <class Event>
  void keep(Event event) {
    if constexpr (sizeof(Event) > k_room || alignof(Event) > alignof(std::max_align_t)) {
      keep([large = std::make_unique<Event>(std::move(event))] { (*large)(); });
    } else {
      ::new (static_cast<void*>(room_)) Event(std::move(event));
      happen_ = [](void* kept) { (*static_cast<Event*>(kept))(); };
      forget_ = [](void* kept) { static_cast<Event*>(kept)->~Event(); };
    }
  }
  void happen() { happen_(room_); }
  void forget() {
    if (forget_ != nullptr) std::exchange(forget_, nullptr)(room_);
  }

 private:
  static constexpr std::size_t k_room = 112;  // a message's way to the ventilator takes 88

  alignas(std::max_align_t) std::byte room_[k_room];
  void (*happen_)(void*) = nullptr;
  void (*forget_)(void*) = nullptr;
};

/// Events of a simulation, ordered by time and, at the same time, by when they were planned.
class EventQueue {
 public:
  SimulatedTime now() const { return now_; }
  bool empty() const { return heap_.empty(); }
  std::uint64_t count() const { return count_; }

  /// Plans an event; a time in the past means now.
  template <class Event>
  void at(SimulatedTime time, Event event) {
    PlannedEvent* place = nullptr;
    if (free_.empty()) {
      place = &places_.emplace_back();
    } else {
      place = free_.back();
      free_.pop_back();
    }
    place->keep(std::move(event));
    heap_.push_back({std::max(time, now_), planned_++, place});
    std::push_heap(heap_.begin(), heap_.end(), Later{});
  }
  template <class Event>
  void in(SimulatedTime delay, Event event) {
    at(now_ + delay, std::move(event));
  }

  /// Advances the clock to the next event and executes it.
  void step() {
    std::pop_heap(heap_.begin(), heap_.end(), Later{});
    const Entry next = heap_.back();
    heap_.pop_back();
    now_ = next.time;
    ++count_;
    next.place->happen();
    next.place->forget();
    free_.push_back(next.place);
  }

 private:
  struct Entry {
    SimulatedTime time;
    std::uint64_t order;
    PlannedEvent* place;
  };
  struct Later {
    bool operator()(const Entry& a, const Entry& b) const {
      return a.time != b.time ? a.time > b.time : a.order > b.order;
    }
  };

  SimulatedTime now_{0};
  std::uint64_t planned_ = 0;
  std::uint64_t count_ = 0;
  std::vector<Entry> heap_;
  std::deque<PlannedEvent> places_;  // never move: an event may plan others
  std::vector<PlannedEvent*> free_;
};

}  // namespace meshfarm
