// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boost/program_options.hpp>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/farm/schedule.hpp>
#include <meshfarm/farm/when_full.hpp>
#include <meshfarm/pipeline/run_options.hpp>
#include <meshfarm/report/progress.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/transport/security.hpp>

#include "cli/command.hpp"

namespace meshfarm {

namespace po = boost::program_options;

// Option groups shared by commands: add() declares, the other functions convert the texts to values
// and throw UsageError. Defaults are in the members.

/// "0.5%": of the diagonal; "2.5": in the mesh's unit. Nothing for any other text.
std::optional<Length> length_in(const std::string& text);

/// Warns about each given option, which has no effect without `needed`.
void warn_of_unused(const GivenOptions& given, std::initializer_list<std::string_view> options,
                    std::string_view needed);

/// --quiet and --json.
struct TalkOptions {
  bool quiet = false;
  bool json = false;

  void add(po::options_description& options);
  void add_quiet(po::options_description& options);
  Format format() const { return json ? Format::json : Format::text; }
  ProgressStyle progress() const;
};

/// --ratio, --triangles, --error, --certify, --allocation, --finish, --composition, --fit,
/// --topology, --crossings, --preserve-border, --crease-angle, --drop-components, --weight,
/// --normals.
struct TargetOptions {
  RunOptions run;
  std::string attributes = "auto";
  std::string uv = "auto";
  std::string normals = "blend";
  std::string weight;
  std::string ratio;
  std::string error;
  std::string drop_components;
  std::string allocation = "threshold";
  std::string finish = "auto";
  std::string composition = "auto";
  std::string fit = "auto";
  std::string topology = "auto";
  std::string crossings = "allow";

  void add(po::options_description& options);
  /// --texture-size.
  void add_texture_size(po::options_description& options);
  /// --attributes, --uv and the above, for commands that take a stage: commands that cut leave out
  /// unwanted attributes.
  void add_attributes(po::options_description& options);
  void check();
  /// As Command::check_given().
  void check_given(const GivenOptions& given) const;
  /// The options as words for a command line.
  std::vector<std::string> words() const;

 private:
  void check_joining();
  void check_surface();
};

/// --scheme, --sort, --parts, --weld, --attributes, --uv, --threads, --memory, --window, --scratch.
struct CutWords {
  CutOptions cut;
  std::string scheme_word = "cut";
  std::string sort = "here";
  std::string where = "auto";  // where the cut is done
  std::uint32_t blocks = 0;    // number of blocks if the farm cuts
  std::string weld = "auto";
  Length weld_distance;  // up to which vertices are asked to be merged
  std::string attributes = "auto";
  std::string uv = "auto";
  ChannelChoice channels;
  std::string memory;
  std::string scratch;

  void add(po::options_description& options);
  void check();
  /// See Command::check_given(). `auto_farms`: whether --cut auto may use the farm.
  void check_given(const GivenOptions& given, bool auto_farms) const;
  /// Whether the first jobs of a run may cut.
  bool may_be_farmed() const { return where != "here" && cut.scheme != Scheme::stream; }
  /// The effective options as words for a command line.
  std::vector<std::string> words() const;

 private:
  void check_weld();
};

/// --key-file, --insecure, --insecure-network, --allow-soft.
struct SecurityWords {
  SecurityOptions security;
  std::string key_file;
  bool insecure = false;
  bool insecure_network = false;
  bool allow_soft = false;

  void add(po::options_description& options);
  void check();
  /// Throws DataError if the stage is on a soft NFS mount and that was not allowed.
  void check_mount(const std::filesystem::path& stage) const;
  std::vector<std::string> words() const;
};

/// --bind, --ports, and the options of SecurityWords.
struct NetworkOptions {
  std::string bind;
  std::string ports;
  std::uint16_t first_port = 0;
  std::uint16_t last_port = 0;
  SecurityWords security;
  bool this_host_only = false;  // all processes are started here, by one that supervises them

  void add(po::options_description& options);
  void check();
  std::vector<std::string> words() const;
};

/// --schedule, --expect-workers, --hang-seconds.
struct ScheduleWords {
  SchedulerOptions options;
  std::string schedule = "dynamic";
  std::uint32_t hang_s = 30;

  void add(po::options_description& described);
  void check();
  /// As Command::check_given().
  void check_given(const GivenOptions& given) const;
  std::vector<std::string> words() const;
};

/// --no-wait.
struct FullWords {
  bool no_wait = false;

  void add(po::options_description& options);
  WhenFull value() const { return no_wait ? WhenFull::end : WhenFull::wait; }
  std::vector<std::string> words() const;
};

/// "512M" or "8G" (powers of 1024) as bytes; `option` is for the message. Throws UsageError.
std::uint64_t parse_size(const std::string& text, std::string_view option);

}  // namespace meshfarm
