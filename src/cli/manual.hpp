// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.hpp"

namespace meshfarm {

/// A command and the options declared by setup(), with --config and --help. The options are bound
/// to the command's members.
struct DescribedCommand {
  explicit DescribedCommand(std::unique_ptr<Command> named);
  std::unique_ptr<Command> command;
  po::options_description options;
  po::positional_options_description positional;
};

/// Option descriptions cannot be moved.
using DescribedCommands = std::vector<std::unique_ptr<DescribedCommand>>;

/// The options except positional arguments, which have no description: the synopsis shows them.
po::options_description described_only(const po::options_description& all);

/// The program's exit codes, for help and manual.
struct ExitCode {
  int code;
  const char* meaning;
};
const std::vector<ExitCode>& exit_codes();

/// The manual pages (man roff) of the program and of one command.
std::string man_page(const DescribedCommands& commands);
std::string man_page(const DescribedCommand& described);

/// A completion script for bash. For a value name like "cut|stream" it offers the option's words;
/// FILE, FOLDER and STAGE are completed as paths.
std::string bash_completion(const DescribedCommands& commands);

/// Writes FOLDER/man1/meshfarm*.1 and FOLDER/completions/meshfarm. Throws IoError.
void write_manual(const std::filesystem::path& folder);

}  // namespace meshfarm
