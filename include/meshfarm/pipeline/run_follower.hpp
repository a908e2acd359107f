// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include <meshfarm/report/trace.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// Keeps up with the newest run of a stage, whoever starts one: reads only what its trace got since
/// the last look. One thread.
class RunFollower {
 public:
  explicit RunFollower(Stage stage) : stage_(std::move(stage)) {}

  /// Brings the trace up to date; call it with the same one each time. It stays empty until a run
  /// begins. Throws IoError or DataError; a look after that starts anew.
  void look(std::optional<Trace>& trace);

 private:
  /// Of one run's trace.
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
