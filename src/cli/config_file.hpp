// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>

#include <boost/program_options.hpp>

#include "cli/command.hpp"

namespace meshfarm {

/// The file of --config: one NAME = VALUE a line, by the names of the command line. The default one
/// says nothing.
class ConfigFile {
 public:
  ConfigFile() : parsed_(nullptr) {}
  /// Throws IoError, and UsageError that names the file and the line.
  ConfigFile(const std::string& path, const po::options_description& options);

  const po::parsed_options& parsed() const { return parsed_; }
  /// Fills what the command line left open. Throws as above.
  void store(po::variables_map& values) const;
  /// The error, after the file and the line if it names an option that stands there and was not
  /// given on the command line.
  std::string placed(const std::string& error, const GivenOptions& given) const;

 private:
  std::string place_of_line(std::size_t number) const;

  std::string path_;
  po::parsed_options parsed_;
  std::map<std::string, std::size_t, std::less<>> lines_;  // of the options, from 1
};

}  // namespace meshfarm
