// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace meshfarm {

/// A host's performance parameter as in Xiong et al. 2008, 3.2.1: builds the structures for a
/// benchmark mesh and collapses it completely, repeatedly for about a quarter of a second. Returns
/// triangles per second of one thread, in wall-clock time: a busy or throttled host counts as the
/// slow host that it is.
std::uint64_t measure_speed();

/// The key of a measurement: program version, host, CPU model, limit of the control group.
/// Measurements with different keys are not comparable.
std::string speed_key(std::string_view program_version);

/// Where a user's measurements are cached, $XDG_CACHE_HOME/meshfarm or ~/.cache/meshfarm; empty if
/// the user has no home.
std::filesystem::path speed_folder();

/// The speed cached under the key; 0 if there is none.
std::uint64_t remembered_speed(const std::filesystem::path& folder, std::string_view key);
/// Caches the speed if possible: a full or read-only home is not an error.
void remember_speed(const std::filesystem::path& folder, std::string_view key, std::uint64_t speed);

/// Whether there is time to measure a host that was not measured before.
enum class Haste { none, great };

/// The speed cached in speed_folder(), else measured now and cached; in great haste a typical speed
/// instead.
std::uint64_t speed_of_this_host(std::string_view program_version, Haste haste = Haste::none);

}  // namespace meshfarm
