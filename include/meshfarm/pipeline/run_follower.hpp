// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include <meshfarm/report/trace.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// Follows the newest run of a stage, whoever starts it: reads only what was added to its trace
/// since the last look. For one thread.
class RunFollower {
 public:
  explicit RunFollower(Stage stage) : stage_(std::move(stage)) {}

  /// Brings the trace up to date; pass the same one each time. It stays empty until a run begins.
  /// Throws IoError or DataError; the next look then starts from the beginning.
  void look(std::optional<Trace>& trace);

 private:
  /// Reads one run's trace.
  struct Reader {
    std::uint32_t number = 0;
    TraceFeed feed;
    std::uint64_t offset = 0;
  };
  void read(Reader& reader, Trace& trace) const;

  Stage stage_;
  std::optional<Reader> reader_;
};

}  // namespace meshfarm
