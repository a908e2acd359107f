// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/mesh_sink.hpp>
#include <meshfarm/pipeline/run_options.hpp>

#include "cli/command.hpp"

namespace meshfarm {

namespace po = boost::program_options;

/// --plain.
struct OutputWords {
  bool plain = false;

  void add(po::options_description& options);
  Packing packing() const { return plain ? Packing::plain : Packing::compressed; }
  /// See Command::check_given(); for a command that writes `output`.
  void check_given(const GivenOptions& given, const std::string& output) const;
  /// The options as words for a command line.
  std::vector<std::string> words() const;
};

/// Throws UsageError, before the farm's work, if its result will exceed the limits of the output's
/// format. A result has about half as many vertices as triangles.
void check_output_fits(const std::string& output, const Manifest& manifest, const RunOptions& run);

}  // namespace meshfarm
