// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <cstdio>
#include <iostream>
#include <new>
#include <sstream>

#include <sys/prctl.h>

#include <meshfarm/cli/command_line.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>
#include <meshfarm/util/memory.hpp>

#include "cli/command.hpp"
#include "cli/config_file.hpp"
#include "cli/manual.hpp"
#include "cli/version.hpp"

namespace meshfarm {
namespace {

constexpr int k_done = 0;
constexpr int k_failed = 1;
constexpr int k_wrong_usage = 2;
constexpr int k_incomplete = 3;

std::string list_of_commands() {
  std::ostringstream out;
  out << "meshfarm simplifies triangle meshes that do not fit into one computer's memory.\n\n"
         "  meshfarm COMMAND [OPTIONS]\n"
         "  meshfarm COMMAND --help           explains one command\n\n";
  for (const auto& command : all_commands()) {
    std::string name(command->name());
    name.resize(12, ' ');
    out << "  " << name << command->summary() << "\n";
  }
  out << "\nExit codes:\n";
  for (const ExitCode& exit : exit_codes())
    out << "  " << exit.code << "  " << exit.meaning << "\n";
  return out.str();
}

std::string help_of(const Command& command, const po::options_description& options) {
  std::ostringstream out;
  out << "meshfarm " << command.name() << (command.synopsis().empty() ? "" : " ")
      << command.synopsis() << "\n  " << command.summary() << "\n\n"
      << options;
  return out.str();
}

std::unique_ptr<Command> find_command(std::string_view name) {
  for (auto& command : all_commands()) {
    if (command->name() == name) return std::move(command);
  }
  throw UsageError("unknown command '" + std::string(name) +
                   "'; 'meshfarm help' lists the commands");
}

/// No option takes a negative number, and Boost would turn it into a huge unsigned one.
void refuse_negative_numbers(const po::basic_parsed_options<char>& parsed) {
  for (const auto& option : parsed.options) {
    for (const std::string& value : option.value) {
      const bool is_number = value.find_first_not_of("0123456789.eE+-") == std::string::npos;
      if (is_number && value.size() > 1 && value[0] == '-' && value[1] >= '0' && value[1] <= '9') {
        throw UsageError("--" + option.string_key + " takes no negative number: " + value);
      }
    }
  }
}

GivenOptions given_options(const po::basic_parsed_options<char>& parsed) {
  GivenOptions given;
  for (const auto& option : parsed.options) given.insert(option.string_key);
  return given;
}

/// Uses the name in --help: an option, or a place in the synopsis, which is its option in capitals.
UsageError missing(const po::required_option& error, const DescribedCommand& described) {
  std::string name = error.get_option_name();
  const std::string plain = name.substr(name.find_first_not_of('-'));
  if (described.options.find(plain, false).description().empty()) {
    name = plain;
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  }
  const Command& command = *described.command;
  return UsageError(name + " is missing: meshfarm " + std::string(command.name()) + " " +
                    std::string(command.synopsis()));
}

void take_values(const DescribedCommand& described, po::variables_map& values,
                 const ConfigFile& config, const GivenOptions& given) {
  try {
    refuse_negative_numbers(config.parsed());
    po::notify(values);
    described.command->check();
    described.command->check_given(given);
  } catch (const po::required_option& error) {
    throw missing(error, described);
  } catch (const UsageError& error) {
    throw UsageError(config.placed(error.what(), given));
  }
}

int run_command(std::unique_ptr<Command> named, const std::vector<std::string>& words) {
  const DescribedCommand described(std::move(named));
  Command& command = *described.command;
  const po::options_description& options = described.options;
  const auto parsed =
      po::command_line_parser(words).options(options).positional(described.positional).run();
  refuse_negative_numbers(parsed);
  po::variables_map values;
  po::store(parsed, values);
  if (values.count("help") != 0) {
    std::cout << help_of(command, described_only(options));
    return k_done;
  }
  ConfigFile config;
  if (values.count("config") != 0) config = {values["config"].as<std::string>(), options};
  config.store(values);
  const GivenOptions given = given_options(parsed);
  take_values(described, values, config, given);
  if (command.keeps_freed_memory()) keep_freed_memory();
  try {
    return command.run();
  } catch (const UsageError& error) {
    // Only if the message starts with it: an option named elsewhere may be the one to use instead.
    const bool is_of_option = std::string_view(error.what()).starts_with("--");
    throw UsageError(is_of_option ? config.placed(error.what(), given) : error.what());
  }
}

int dispatch(const std::vector<std::string>& words) {
  if (words.empty() || words[0] == "help" || words[0] == "--help" || words[0] == "-h") {
    if (words.size() > 1) return run_command(find_command(words[1]), {"--help"});
    (words.empty() ? std::cerr : std::cout) << list_of_commands();
    return words.empty() ? k_wrong_usage : k_done;
  }
  if (words[0] == "--version") {
    std::cout << "meshfarm " << k_version << "\n";
    return k_done;
  }
  if (words[0] == "--write-manual" && words.size() == 2) {  // for the build
    write_manual(words[1]);
    return k_done;
  }
  auto command = find_command(words[0]);
  set_log(words[0], LogLevel::info);
  return run_command(std::move(command), {words.begin() + 1, words.end()});
}

}  // namespace

int run_command_line(int argc, const char* const* argv) {
  // Workers are started through /proc/self/exe, and would be listed as "exe".
  ::prctl(PR_SET_NAME, "meshfarm");
  try {
    const int code = dispatch({argv + std::min(1, argc), argv + argc});
    std::cout.flush();
    if (!std::cout) throw Error("cannot write to standard output");
    return code;
  } catch (const UsageError& error) {
    log_error(error.what());
    return k_wrong_usage;
  } catch (const po::error& error) {
    log_error(error.what());
    return k_wrong_usage;
  } catch (const IncompleteError& error) {
    log_error(error.what());
    return k_incomplete;
  } catch (const std::bad_alloc&) {
    log_error("out of memory; more --parts make smaller parts");
    return k_failed;
  } catch (const std::exception& error) {
    log_error(error.what());
    return k_failed;
  }
}

}  // namespace meshfarm
