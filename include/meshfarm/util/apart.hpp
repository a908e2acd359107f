// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace meshfarm {

enum class ApartEnd : std::uint8_t { done, out_of_memory, died };

/// Hands bytes over to the process that called run_apart().
using SendBytes = std::function<void(std::string_view bytes)>;

/// Runs `work` in a copy of this process, which may take `most_bytes` of memory more than this one
/// has, and gives `take` what it sends, in that order. So a library that damaged bytes bring down,
/// or make it ask for any memory, takes nothing else with it. What was taken is of no use if the
/// end is not `done`. An Error that `work` throws is thrown here, as DataError. Throws IoError.
ApartEnd run_apart(const std::function<void(const SendBytes& send)>& work,
                   const std::function<void(std::string bytes)>& take,
                   std::optional<std::uint64_t> most_bytes);

}  // namespace meshfarm
