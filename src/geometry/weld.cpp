// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <array>
#include <bit>
#include <cassert>
#include <limits>

#include <meshfarm/geometry/place_hash.hpp>
#include <meshfarm/geometry/weld.hpp>

namespace meshfarm {
namespace {

constexpr std::uint32_t k_empty = std::numeric_limits<std::uint32_t>::max();
// This many slots are prefetched: the table does not fit into the nearer caches.
constexpr std::size_t k_ahead = 16;

/// Open addressing with linear probing, never more than half full.
class Table {
 public:
  explicit Table(std::size_t entries)
      : shift_(64 - static_cast<int>(std::bit_width(entries * 2 + 1))),
        slots_(std::size_t{1} << (64 - shift_), k_empty) {}
  std::size_t home(std::uint64_t hash) const { return hash >> shift_; }
  void prefetch(std::size_t slot) const { __builtin_prefetch(&slots_[slot], 1); }
  std::size_t next(std::size_t slot) const { return (slot + 1) & (slots_.size() - 1); }
  std::uint32_t& operator[](std::size_t slot) { return slots_[slot]; }

 private:
  int shift_;
  std::vector<std::uint32_t> slots_;
};

}  // namespace

WeldResult weld(std::span<const Vec3> positions) {
  assert(positions.size() < k_empty);
  WeldResult result;
  result.first.resize(positions.size());
  Table table(positions.size());
  std::array<std::size_t, k_ahead> homes{};
  const auto look_ahead = [&](std::size_t i) {
    if (i >= positions.size()) return;
    homes[i % k_ahead] = table.home(hash_of(PlaceKey(positions[i])));
    table.prefetch(homes[i % k_ahead]);
  };
  for (std::size_t i = 0; i < k_ahead; ++i) look_ahead(i);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    std::size_t slot = homes[i % k_ahead];
    look_ahead(i + k_ahead);
    const PlaceKey key(positions[i]);
    while (table[slot] != k_empty && PlaceKey(positions[table[slot]]) != key)
      slot = table.next(slot);
    // Vertices come in order, so the one in the table is the lowest of its twins.
    if (table[slot] == k_empty) {
      table[slot] = static_cast<std::uint32_t>(i);
    } else {
      ++result.merged;
    }
    result.first[i] = table[slot];
  }
  return result;
}

}  // namespace meshfarm
