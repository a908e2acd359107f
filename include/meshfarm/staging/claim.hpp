// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace meshfarm {

/// Tells others, by a file that exists as long as this object, that this process works on something
/// that only one process may work on. It prevents accidents and is not a lock: safety must not
/// depend on it.
class Claim {
 public:
  /// Throws DataError naming the owner: `work` on which host, by which process. The claim of an
  /// owner that is known to be dead (its process ended, or its host rebooted) is taken over.
  Claim(std::filesystem::path file, std::string_view work);
  /// Releases the claim.
  ~Claim();
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

 private:
  std::filesystem::path file_;
};

/// "host H, process P" of the owner, as far as known; nothing if there is no claim, or its owner is
/// known to be dead.
std::optional<std::string> holder_of(const std::filesystem::path& file);

/// The file that claims work on an output file: a hidden file beside it.
std::filesystem::path claim_of(const std::filesystem::path& output);

}  // namespace meshfarm
