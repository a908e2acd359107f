// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <meshfarm/report/status.hpp>

namespace meshfarm {

/// The characters of bars.
enum class Letters : std::uint8_t { ascii, unicode };

struct ScreenSize {
  std::size_t columns = 80;
  std::size_t rows = 24;
};

struct ScreenLine {
  enum class Look : std::uint8_t { plain, strong, dim, warning };
  std::string text;  // UTF-8, no control characters, at most as wide as the screen
  Look look = Look::plain;
};

/// The status as lines that fit the screen: how far the run is, its stages, and what each worker
/// did and holds.
std::vector<ScreenLine> status_screen(const StatusFacts& facts, const ScreenSize& size,
                                      Letters letters);

/// The terminal codes that replace the last frame by these lines without flicker (ECMA-48: cursor
/// home, erase to the end of line, of page).
std::string frame_of(const std::vector<ScreenLine>& lines);

/// The status as one line, for a log.
std::string status_line(const StatusFacts& facts);

}  // namespace meshfarm
