// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

struct PoolWork {
  std::filesystem::path folder;
  /// How long to keep looking while no run has work; none: for ever.
  std::optional<std::chrono::seconds> wait;
  /// Serves a run to its end. Throws IncompleteError if that is not possible.
  std::function<void(const Stage&, std::uint64_t run)> serve;
};

/// Serves runs of the pool, one after another and the neediest first, until it is stopped.
void serve_pool(const PoolWork& work, const std::atomic<bool>& stop);

}  // namespace meshfarm
