// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace meshfarm {

/// Tells others, by a file that is there as long as the object is, that this process works on
/// something that two must not work on at once. It keeps honest people apart and is no lock: what
/// must be safe does not lean on it.
class Claim {
 public:
  /// Throws DataError that names who has it: `work` on which host, by which process. A claim whose
  /// owner is known to be dead (its process, or its host since) is taken over.
  Claim(std::filesystem::path file, std::string_view work);
  /// Gives it back.
  ~Claim();
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

 private:
  std::filesystem::path file_;
};

/// "host H, process P" of who has the claim, as far as is known; nothing if there is none, or its
/// owner is known to be dead.
std::optional<std::string> holder_of(const std::filesystem::path& file);

/// Where work on an output file is claimed: a hidden file beside it.
std::filesystem::path claim_of(const std::filesystem::path& output);

}  // namespace meshfarm
