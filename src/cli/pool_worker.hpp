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
  /// How long to look on while there is no run with work; none: for ever.
  std::optional<std::chrono::seconds> wait;
  /// Serves a run to its end. Throws IncompleteError where that cannot be.
  std::function<void(const Stage&, std::uint64_t run)> serve;
};

/// Serves one run of the pool after another, the one that needs it most first, until it is stopped.
void serve_pool(const PoolWork& work, const std::atomic<bool>& stop);

}  // namespace meshfarm
