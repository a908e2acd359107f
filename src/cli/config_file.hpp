// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include <boost/program_options.hpp>

#include "cli/command.hpp"

namespace meshfarm {

/// The file given by --config: one NAME = VALUE per line, with the command line's option names. The
/// default-constructed file is empty.
class ConfigFile {
 public:
  ConfigFile() : parsed_(nullptr) {}
  /// Throws IoError, and UsageError that names the file and the line.
  ConfigFile(const std::string& path, const po::options_description& options);

  const po::parsed_options& parsed() const { return parsed_; }
  /// Sets options that the command line did not set. Throws as above.
  void store(po::variables_map& values) const;
  /// The error, preceded by the file and line if it names an option that is set there and not on
  /// the command line.
  std::string placed(const std::string& error, const GivenOptions& given) const;

 private:
  std::string place_of_line(std::size_t number) const;

  std::string path_;
  po::parsed_options parsed_;
  std::map<std::string, std::size_t, std::less<>> lines_;  // per option, from 1
};

}  // namespace meshfarm
