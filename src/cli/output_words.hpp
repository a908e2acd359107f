// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include <meshfarm/io/mesh_sink.hpp>

namespace meshfarm {

namespace po = boost::program_options;

/// --plain.
struct OutputWords {
  bool plain = false;

  void add(po::options_description& options);
  Packing packing() const { return plain ? Packing::plain : Packing::compressed; }
  /// The same as words for a command line.
  std::vector<std::string> words() const;
};

}  // namespace meshfarm
