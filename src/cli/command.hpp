// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <boost/program_options.hpp>

namespace meshfarm {

namespace po = boost::program_options;

/// The long names of the options given on the command line. Options from a config file are not
/// included: they may be meant for other commands.
using GivenOptions = std::set<std::string, std::less<>>;

/// A command of the program. The members that options are bound to hold the defaults.
class Command {
 public:
  virtual ~Command() = default;
  virtual std::string_view name() const = 0;
  virtual std::string_view synopsis() const = 0;  // after the name: "INPUT -o OUTPUT"
  virtual std::string_view summary() const = 0;   // one line for the list of commands
  /// Declares the options; no work.
  virtual void setup(po::options_description& options,
                     po::positional_options_description& positional) = 0;
  /// Checks the parsed options; throws UsageError; no work.
  virtual void check() {}
  /// Warns of given options that have no effect; throws UsageError if they request what this
  /// command cannot do. Called after check().
  virtual void check_given(const GivenOptions& /*given*/) const {}
  /// Whether freed memory is kept for all threads (keep_freed_memory()). False if each thread
  /// allocates often and shares nothing: the threads would wait for each other.
  virtual bool keeps_freed_memory() const { return true; }
  /// Executes the command and returns the exit code.
  virtual int run() = 0;
};

/// All commands, in the order in which `help` lists them.
std::vector<std::unique_ptr<Command>> all_commands();

std::unique_ptr<Command> make_simplify_command();
std::unique_ptr<Command> make_batch_command();
std::unique_ptr<Command> make_cut_command();
std::unique_ptr<Command> make_run_command();
std::unique_ptr<Command> make_replay_command();
std::unique_ptr<Command> make_worker_command();
std::unique_ptr<Command> make_ventilator_command();
std::unique_ptr<Command> make_sink_command();
std::unique_ptr<Command> make_generate_command();
std::unique_ptr<Command> make_benchmark_command();
std::unique_ptr<Command> make_info_command();
std::unique_ptr<Command> make_compare_command();
std::unique_ptr<Command> make_convert_command();
std::unique_ptr<Command> make_render_command();
std::unique_ptr<Command> make_doctor_command();
std::unique_ptr<Command> make_simulate_command();
std::unique_ptr<Command> make_status_command();
std::unique_ptr<Command> make_report_command();
std::unique_ptr<Command> make_clean_command();

}  // namespace meshfarm
