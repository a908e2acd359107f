// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace meshfarm {

/// A host's performance parameter as in Xiong et al. 2008, 3.2.1: builds the structures for a
/// benchmark mesh and collapses it away, again and again for about a quarter of a second. Returns
/// triangles a second of one thread, as the clock on the wall has it: a busy or throttled host
/// counts as the slow host that it is.
std::uint64_t measure_speed();

/// What tells one measurement from another that would not be the same: program version, host, CPU
/// model, limit of the control group.
std::string speed_key(std::string_view program_version);

/// Where a user's measurements are remembered, $XDG_CACHE_HOME/meshfarm or ~/.cache/meshfarm;
/// empty if the user has no home.
std::filesystem::path speed_folder();

/// The speed remembered under the key; 0 if there is none.
std::uint64_t remembered_speed(const std::filesystem::path& folder, std::string_view key);
/// Remembers it, if it can: a full or read-only home is no reason not to work.
void remember_speed(const std::filesystem::path& folder, std::string_view key, std::uint64_t speed);

/// Whether the time is there to measure a host that was not measured before.
enum class Haste { none, great };

/// The speed remembered in speed_folder(), or else measured now and remembered; in great haste a
/// usual speed instead.
std::uint64_t speed_of_this_host(std::string_view program_version, Haste haste = Haste::none);

}  // namespace meshfarm
