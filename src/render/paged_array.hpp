// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/page_file.hpp"

namespace meshfarm {

/// Where to store arrays of any size.
struct ArrayRoom {
  std::filesystem::path folder;    // for scratch files
  std::uint64_t memory_bytes = 0;  // per array; larger ones go to scratch files
};

/// Items, initially zero, in memory or in a scratch file, which is then accessed through views.
template <class T>
class PagedArray {
 public:
  class View;

  /// Throws IoError.
  PagedArray(std::uint64_t count, const ArrayRoom& room) : size_(count), room_(room) {
    if (count * sizeof(T) <= room.memory_bytes) {
      items_.resize(count);
    } else {
      file_.emplace(room.folder);
    }
  }

  std::uint64_t size() const { return size_; }
  /// Several threads may write different items.
  void write(std::uint64_t first, std::span<const T> items) {
    if (items.empty()) return;
    if (file_) {
      file_->write(first * sizeof(T),
                   {reinterpret_cast<const char*>(items.data()), items.size_bytes()});
    } else {
      std::copy(items.begin(), items.end(), items_.begin() + static_cast<std::ptrdiff_t>(first));
    }
  }

 private:
  std::uint64_t size_;
  ArrayRoom room_;
  std::vector<T> items_;
  std::optional<PageFile> file_;
};

/// One thread's view of an array: caches recently used pages. Others may read the array meanwhile.
template <class T>
class PagedArray<T>::View {
 public:
  /// Takes the array's share of memory divided by the number of views.
  explicit View(PagedArray& array, unsigned views = 1) : array_(array) {
    if (!array.file_) return;
    const std::uint64_t pages = array.room_.memory_bytes / views / (k_items * sizeof(T));
    slots_.resize(std::bit_floor(std::max(pages, k_least_pages)));  // a page's slot is found often
    items_ = std::make_unique_for_overwrite<T[]>(slots_.size() * k_items);
  }

  T get(std::uint64_t i) { return array_.file_ ? page_of(i)[i % k_items] : array_.items_[i]; }
  void set(std::uint64_t i, T item) {
    if (!array_.file_) {
      array_.items_[i] = item;
      return;
    }
    page_of(i)[i % k_items] = item;
    slots_[slot_of(i / k_items)].is_changed = true;
  }
  /// Writes what was set; other views do not see it before.
  void flush() {
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) write_back(slot);
  }

 private:
  static constexpr std::uint64_t k_items = 512;  // per page
  static constexpr std::uint64_t k_least_pages = 16;
  struct Slot {
    std::uint64_t page = UINT64_MAX;
    bool is_changed = false;
  };

  std::size_t slot_of(std::uint64_t page) const { return page & (slots_.size() - 1); }
  T* page_of(std::uint64_t i) {
    const std::uint64_t page = i / k_items;
    const std::size_t slot = slot_of(page);
    if (slots_[slot].page != page) {
      write_back(slot);
      slots_[slot].page = UINT64_MAX;  // in case the read fails
      const std::span<T> items = items_of(slot);
      array_.file_->read(page * k_items * sizeof(T),
                         {reinterpret_cast<char*>(items.data()), items.size_bytes()});
      slots_[slot].page = page;
    }
    return items_.get() + slot * k_items;
  }
  std::span<T> items_of(std::size_t slot) { return {items_.get() + slot * k_items, k_items}; }
  void write_back(std::size_t slot) {
    if (!slots_[slot].is_changed) return;
    array_.write(slots_[slot].page * k_items, items_of(slot));
    slots_[slot].is_changed = false;
  }

  PagedArray& array_;
  std::vector<Slot> slots_;
  std::unique_ptr<T[]> items_;
};

}  // namespace meshfarm
