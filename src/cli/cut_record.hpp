// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <meshfarm/staging/stage.hpp>

#include "cli/options.hpp"

namespace meshfarm {

/// What a stage was cut from, and how: by this the same command knows its own stage again.
struct CutRecord {
  std::uint64_t size = 0;       // of the input, in bytes
  std::int64_t changed_ns = 0;  // when the input was written last
  std::uint64_t sum = 0;        // of its head and tail
  std::string options;          // of the cut, as far as they matter to what is cut
};

/// `farmed`: whether the farm is to cut. Throws IoError if the input cannot be read.
CutRecord record_of(const std::string& input, const CutWords& words, bool farmed = false);
/// In what they differ, for a message; empty if they are the same.
std::string difference(const CutRecord& staged, const CutRecord& wanted);

void publish_record(const Stage& stage, const CutRecord& record);
/// Whether the stage holds a finished cut.
bool holds_cut(const std::filesystem::path& stage);
/// Whether the file is the one that the stage was cut from, as it was then.
bool is_of_input(const Stage& stage, const std::string& file);
/// Nothing if the stage has none: it was made by an older version.
std::optional<CutRecord> read_record(const Stage& stage);

}  // namespace meshfarm
