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

/// What a stage was cut from, and how: a repeated command recognises its own stage by this.
struct CutRecord {
  std::uint64_t size = 0;       // of the input, in bytes
  std::int64_t changed_ns = 0;  // when the input was written last
  std::uint64_t sum = 0;        // of the input's head and tail
  std::string options;          // of the cut, those that affect its output
};

/// `farmed`: whether the farm is to cut. Throws IoError if the input cannot be read.
CutRecord record_of(const std::string& input, const CutWords& words, bool farmed = false);
/// The differences, for a message; empty if there are none.
std::string difference(const CutRecord& staged, const CutRecord& wanted);

void publish_record(const Stage& stage, const CutRecord& record);
/// Whether the stage holds a finished cut.
bool holds_cut(const std::filesystem::path& stage);
/// Whether the file is the unchanged input of the stage's cut.
bool is_of_input(const Stage& stage, const std::string& file);
/// Nothing if the stage has none, from an older version.
std::optional<CutRecord> read_record(const Stage& stage);

}  // namespace meshfarm
