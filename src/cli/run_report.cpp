// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/run_report.hpp"

#include <algorithm>
#include <cctype>
#include <fstream>

#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/pipeline/run_trace.hpp>
#include <meshfarm/report/run_page.hpp>
#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "cli/output_place.hpp"
#include "cli/report_scene.hpp"

namespace meshfarm {
namespace {

/// Quoted for a shell.
std::string quoted(const std::string& word) {
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("-_=+,./:@%").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string made = "'";
  for (const char c : word) made += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return made + "'";
}

/// The command line of this process, without the program's name.
std::vector<std::string> own_words() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> words;
  for (std::string word; std::getline(file, word, '\0');) words.push_back(word);
  if (!words.empty()) words.erase(words.begin());
  return words;
}

std::string command_of(const std::vector<std::string>& words) {
  std::string command = "meshfarm";
  for (const std::string& word : words) command += " " + quoted(word);
  return command;
}

/// The newest summary of a run, as JSON; may be empty.
std::string summary_of(const Stage& stage, std::uint64_t run) {
  const std::vector<std::uint32_t> numbers = stage.summaries();
  for (auto number = numbers.rbegin(); number != numbers.rend(); ++number) {
    const SummaryName name{*number};
    std::string text = stage.read(name);
    if (parse_run_times(text, stage.path(name).string()).run == run) return text;
  }
  return {};
}

/// Nothing if the file is not what the run made; `notes` then says why.
std::optional<Mesh> read_result(const RunResult& made, std::vector<std::string>& notes) {
  try {
    const auto source = open_mesh(made.path, {.channels = false, .labels = false});
    Mesh result = read_mesh(*source);
    if (result.triangles.empty()) {
      notes.emplace_back("There are no pictures: the result has no triangles.");
    } else if (result.triangles.size() == made.triangles) {
      return result;
    } else {
      notes.push_back("There are no pictures: " + made.path + " is not what the run made.");
    }
  } catch (const Error& error) {
    notes.push_back("There are no pictures: " + std::string(error.what()));
  }
  return std::nullopt;
}

}  // namespace

void add_report(po::options_description& options, std::string& page) {
  options.add_options()("report", po::value(&page)->value_name("FILE"),
                        "a page about the run, as HTML: input and result in pictures, errors, "
                        "figures, and where the time went");
}

void check_report(const std::string& page, const std::string& result, const std::string& stage) {
  check_place(page);
  check_not_over("--report", page, "the result", result);
  check_not_of_stage("--report", page, stage);
}

void write_run_report(const RunReport& report) {
  const Stage stage = Stage::open(report.stage);
  RunPage page;
  page.manifest = decode_manifest(stage.read(ManifestName{}), stage.path(ManifestName{}).string());
  page.trace = read_newest_trace(stage, report.epoch);
  page.summary = summary_of(stage, page.trace.head.run);
  if (report.made_by == MadeBy::this_command) page.command = command_of(own_words());
  if (!page.summary.empty()) {
    const RunResult made = parse_run_result(page.summary, "the run's summary");
    check_not_over("the page", report.page, "the result", made.path);
    if (page.command.empty()) {
      page.command = command_of(
          {"replay", report.stage, "-o", made.path, "--triangles", std::to_string(made.triangles)});
    }
    if (const std::optional<Mesh> result = read_result(made, page.notes)) {
      add_scene(page, stage, *result, {.up = report.up, .crossings = made.crossing_triangles});
    }
  }
  AtomicFile file(report.page);
  file.write(render_run_page(page));
  file.commit();
  log_info("wrote " + report.page);
}

}  // namespace meshfarm
