// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <boost/program_options.hpp>

#include <meshfarm/geometry/vec.hpp>

namespace meshfarm {

namespace po = boost::program_options;

/// Adds --report.
void add_report(po::options_description& options, std::string& page);

/// Throws Error if --report names a file that cannot be written, the result, or a file or the input
/// of the stage.
void check_report(const std::string& page, const std::string& result, const std::string& stage);

/// Who made the run: the page shows the command, or else how to replay the stage.
enum class MadeBy : std::uint8_t { this_command, another };

struct RunReport {
  std::string stage;
  std::string page;  // the file to write
  MadeBy made_by = MadeBy::another;
  std::optional<std::uint32_t> epoch = {};  // of the run; default: the last
  std::optional<Vec3> up = {};              // the axis that points up; else by the input's shape
};

/// Writes the page of a run: about its stage, and its result if that is still what the run made.
/// Throws IoError, or DataError if no run was traced.
void write_run_report(const RunReport& report);

}  // namespace meshfarm
