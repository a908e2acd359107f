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

/// Passes bytes to the process that called run_apart().
using SendBytes = std::function<void(std::string_view bytes)>;

/// Runs `work` in a copy of this process, which may take `most_bytes` more memory than this one
/// has, and passes what it sends to `take`, in order. Damaged bytes may crash a library or make it
/// request any amount of memory: only the copy is affected. What was taken must be discarded unless
/// the end is `done`. An Error thrown by `work` is rethrown here, as DataError. Throws IoError.
ApartEnd run_apart(const std::function<void(const SendBytes& send)>& work,
                   const std::function<void(std::string bytes)>& take,
                   std::optional<std::uint64_t> most_bytes);

}  // namespace meshfarm
