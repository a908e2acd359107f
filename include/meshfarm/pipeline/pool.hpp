// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace meshfarm {

/// A run of one of a pool's stages whose ventilator may be alive.
struct PoolRun {
  std::filesystem::path stage;
  std::uint64_t run = 0;
  std::uint32_t epoch = 0;
  std::uint64_t workers = 0;    // that work on it
  std::uint64_t triangles = 0;  // left to do, about
  bool operator==(const PoolRun&) const = default;
};

/// The runs of all stages in the folder, or linked there, that have work for one more worker.
/// Stages that cannot be read are left out.
std::vector<PoolRun> runs_of_pool(const std::filesystem::path& folder);

/// The run with the fewest workers for its work.
std::optional<PoolRun> neediest(std::span<const PoolRun> runs);

}  // namespace meshfarm
