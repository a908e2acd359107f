// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/options.hpp"

#include <charconv>
#include <cmath>

#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/transport/addresses.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "cli/choice_words.hpp"
#include "cli/texture_words.hpp"
#include "cli/weight_words.hpp"

namespace meshfarm {
namespace {

std::uint16_t parse_port(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (error != std::errc{} || end != text.data() + text.size() || port == 0) {
    throw UsageError("--ports takes FIRST-LAST, two port numbers from 1 to 65535");
  }
  return port;
}

}  // namespace

void warn_of_unused(const GivenOptions& given, std::initializer_list<std::string_view> options,
                    std::string_view needed) {
  for (const std::string_view option : options) {
    if (!given.contains(option)) continue;
    log_warning("--" + std::string(option) + " changes nothing without " + std::string(needed));
  }
}

void TalkOptions::add(po::options_description& options) {
  add_quiet(options);
  options.add_options()("json", po::bool_switch(&json), "print the result as JSON");
}

void TalkOptions::add_quiet(po::options_description& options) {
  options.add_options()("quiet,q", po::bool_switch(&quiet),
                        "no progress: only the result, warnings and errors");
}

ProgressStyle TalkOptions::progress() const {
  return quiet ? ProgressStyle::none : progress_style_of_stderr();
}

void CutWords::add(po::options_description& options) {
  options.add_options()(
      "scheme", po::value(&scheme_word)->default_value(scheme_word)->value_name("cut|stream"),
      "cut: compact parts, each simplified in memory; stream: slabs along the "
      "longest axis, each swept through a bounded buffer")(
      "cut", po::value(&where)->default_value(where)->value_name("here|farm|auto"),
      "with --scheme cut: here: this host cuts; farm: the first jobs of a run cut, on all hosts; "
      "the input must be a binary PLY file of triangles that all hosts see; auto: farm if simplify "
      "keeps no parts, the mesh is large and there are enough workers")(
      "blocks", po::value(&blocks)->value_name("N"),
      "with --cut farm: number of blocks that vertices and triangles are each divided into, up to "
      "144 (0, the default: of about 300,000 each); the parts do not depend on it")(
      "sort", po::value(&sort)->default_value(sort)->value_name("here|farm"),
      "with --scheme stream: here: sort the slabs on this host; farm: the first jobs of a run sort "
      "them, on all hosts")(
      "parts", po::value(&cut.parts)->value_name("N"),
      "number of parts (0, the default: about one million triangles each, and at least 16 parts "
      "for a large mesh) or of streams (0, the default: 1.2 million triangles each)")(
      "weld", po::value(&weld)->default_value(weld)->value_name("auto|exact|off|LENGTH"),
      "exact: merge vertices at the same position, except where surfaces only touch; LENGTH: merge "
      "vertices up to this far apart, too, as in 0.01 or 0.001%; auto: as exact, but corners that "
      "miss each other since coordinates were rounded are merged; off: do not merge")(
      "attributes", po::value(&attributes)->default_value(attributes)->value_name("auto|none|LIST"),
      "auto: colours, normals and other numbers of the vertices, and materials or other labels of "
      "the triangles, if the formats can store them; none: positions only; LIST: only these, as in "
      "red,green,blue ('colours' and 'normals' stand for all of theirs)")(
      "uv", po::value(&uv)->default_value(uv)->value_name(k_uv_words), k_uv_help)(
      "threads", po::value(&cut.threads)->value_name("N"),
      "threads of the cut (0, the default: cores)")(
      "memory", po::value(&memory)->value_name("BYTES"),
      "memory of the cut, for example 2G: with --scheme stream for sorting (default: 512M), with "
      "--scheme cut for the parts that are made at once (default: no limit)")(
      "window",
      po::value(&cut.window_triangles)->default_value(cut.window_triangles)->value_name("N"),
      "with --scheme stream: triangles that a worker holds at once")(
      "scratch", po::value(&scratch)->value_name("FOLDER"),
      "where the cut keeps what does not fit into memory, best on a local disk (default: $TMPDIR "
      "if it is set and has room, otherwise the stage)");
}

void CutWords::check() {
  cut.scheme =
      chosen<Scheme>("--scheme", scheme_word, {{"cut", Scheme::cut}, {"stream", Scheme::stream}});
  check_weld();
  channels = parse_choice(attributes, "--attributes");
  parse_uv(uv);
  cut.sort = chosen<SortAt>("--sort", sort, {{"here", SortAt::here}, {"farm", SortAt::farm}});
  if (sort == "farm" && scheme_word != "stream") {
    throw UsageError("--sort farm needs --scheme stream: parts of a cut are not sorted");
  }
  if (where != "here" && where != "farm" && where != "auto") {
    throw UsageError("--cut is 'here', 'farm' or 'auto', not '" + where + "'");
  }
  if (blocks > k_most_cut_blocks / 2) throw UsageError("--blocks: from 1 to 144");
  if (where == "farm" && scheme_word != "cut") {
    throw UsageError("--cut farm needs --scheme cut; with --scheme stream use --sort farm");
  }
  if (where == "farm" && (cut.weld == Weld::off || weld_distance.value > 0)) {
    throw UsageError("--cut farm needs --weld exact");
  }
  if (cut.parts > 1'000'000) throw UsageError("--parts: at most 1,000,000");
  if (cut.window_triangles < 1000 || cut.window_triangles > 1'000'000'000) {
    throw UsageError("--window: from 1,000 to 1,000,000,000 triangles");
  }
  cut.scratch = scratch;
  if (memory.empty()) return;
  cut.memory_bytes = parse_size(memory, "--memory");
  if (cut.memory_bytes == 0) throw UsageError("--memory must be above 0");
}

void CutWords::check_weld() {
  cut.weld = weld == "off" ? Weld::off : Weld::exact;
  weld_distance = {};
  if (weld == "auto" || weld == "exact" || weld == "off") return;
  const std::optional<Length> length = length_in(weld);
  if (!length) {
    throw UsageError("--weld is 'auto', 'exact', 'off' or a length, as in 0.01 or 0.001%, not '" +
                     weld + "'");
  }
  weld_distance = *length;
}

void CutWords::check_given(const GivenOptions& given, bool auto_farms) const {
  if (!may_be_farmed() || (where == "auto" && !auto_farms))
    warn_of_unused(given, {"blocks"}, "--cut farm");
  if (cut.scheme != Scheme::stream) warn_of_unused(given, {"window"}, "--scheme stream");
}

std::vector<std::string> CutWords::words() const {
  std::vector<std::string> words = {"--scheme", scheme_word, "--sort", sort, "--weld", weld};
  if (cut.scheme == Scheme::stream) {
    words.insert(words.end(), {"--window", std::to_string(cut.window_triangles)});
  }
  if (where != "auto") words.insert(words.end(), {"--cut", where});
  if (may_be_farmed() && blocks != 0) {
    words.insert(words.end(), {"--blocks", std::to_string(blocks)});
  }
  if (!memory.empty()) words.insert(words.end(), {"--memory", memory});
  if (attributes != "auto") words.insert(words.end(), {"--attributes", attributes});
  if (uv != "auto") words.insert(words.end(), {"--uv", uv});
  if (cut.parts != 0) words.insert(words.end(), {"--parts", std::to_string(cut.parts)});
  if (!scratch.empty()) words.insert(words.end(), {"--scratch", scratch});
  if (cut.threads != 0) words.insert(words.end(), {"--threads", std::to_string(cut.threads)});
  return words;
}

void SecurityWords::add(po::options_description& options) {
  options.add_options()("key-file", po::value(&key_file)->value_name("FILE"),
                        "file with the keys of the run, made if it is missing; the same for all "
                        "processes of the run (default: in the stage)")(
      "insecure", po::bool_switch(&insecure),
      "use no encryption and no authentication; the same for all processes of the run")(
      "insecure-network", po::bool_switch(&insecure_network),
      "with --insecure: accept connections from other hosts")(
      "allow-soft", po::bool_switch(&allow_soft),
      "accept a soft NFS mount, on which writes fail when the server is slow");
}

void SecurityWords::check() {
  if (insecure && !key_file.empty()) throw UsageError("--insecure uses no --key-file");
  if (insecure_network && !insecure) throw UsageError("--insecure-network needs --insecure");
  security.authentication = insecure ? Authentication::none : Authentication::curve;
  security.insecure_exposure = insecure_network ? Exposure::network : Exposure::loopback_only;
  security.key_file = key_file;
}

std::vector<std::string> SecurityWords::words() const {
  std::vector<std::string> words;
  if (!key_file.empty()) words.insert(words.end(), {"--key-file", key_file});
  if (insecure) words.emplace_back("--insecure");
  if (insecure_network) words.emplace_back("--insecure-network");
  if (allow_soft) words.emplace_back("--allow-soft");
  return words;
}

void SecurityWords::check_mount(const std::filesystem::path& stage) const {
  const Mount mount = mount_of(stage);
  if (allow_soft || !mount.is_nfs() || !(mount.has("soft") || mount.has("softerr"))) return;
  throw DataError(stage.string() +
                  ": a soft NFS mount: when its server is slow, writes fail and files end empty; "
                  "mount it with hard ('meshfarm doctor' tells more), or --allow-soft");
}

void NetworkOptions::add(po::options_description& options) {
  options.add_options()("bind", po::value(&bind)->value_name("ADDRESS"),
                        "address or interface to listen on (default: this host's first network)")(
      "ports", po::value(&ports)->value_name("FIRST-LAST"),
      "ports to listen on, for firewalls (default: any that is free)");
  security.add(options);
}

void NetworkOptions::check() {
  if (bind.empty()) bind = network_address().value_or("127.0.0.1");
  security.check();
  check_exposure(security.security, bind);
  if (ports.empty()) return;
  const std::size_t dash = ports.find('-');
  if (dash == std::string::npos) throw UsageError("--ports takes FIRST-LAST");
  first_port = parse_port(std::string_view(ports).substr(0, dash));
  last_port = parse_port(std::string_view(ports).substr(dash + 1));
  if (first_port > last_port) throw UsageError("--ports: FIRST is above LAST");
}

std::vector<std::string> NetworkOptions::words() const {
  std::vector<std::string> words = {"--bind", bind};
  if (!ports.empty()) words.insert(words.end(), {"--ports", ports});
  const std::vector<std::string> more = security.words();
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

void ScheduleWords::add(po::options_description& described) {
  described.add_options()(
      "schedule", po::value(&schedule)->default_value(schedule)->value_name("dynamic|static"),
      "dynamic: each part goes to the worker that is expected to finish it first; static: parts "
      "are "
      "dealt out at the start, in sets of equal estimated time")(
      "expect-workers",
      po::value(&options.expect_workers)->default_value(options.expect_workers)->value_name("N"),
      "with --schedule static: wait for this many workers before dealing out parts")(
      "hang-seconds", po::value(&hang_s)->default_value(hang_s)->value_name("N"),
      "give a part to another worker after this many seconds without progress, but not before "
      "three times its estimated time");
}

void ScheduleWords::check() {
  options.schedule = chosen<Schedule>(
      "--schedule", schedule, {{"dynamic", Schedule::dynamic}, {"static", Schedule::fixed}});
  if (hang_s == 0 || hang_s > 86'400) throw UsageError("--hang-seconds: from 1 to 86400");
}

void ScheduleWords::check_given(const GivenOptions& given) const {
  if (options.schedule != Schedule::fixed) {
    warn_of_unused(given, {"expect-workers"}, "--schedule static");
  }
}

std::vector<std::string> ScheduleWords::words() const {
  std::vector<std::string> words = {"--schedule", schedule, "--hang-seconds",
                                    std::to_string(hang_s)};
  if (options.schedule == Schedule::fixed) {
    words.insert(words.end(), {"--expect-workers", std::to_string(options.expect_workers)});
  }
  return words;
}

void FullWords::add(po::options_description& options) {
  options.add_options()("no-wait", po::bool_switch(&no_wait),
                        "if the disk is full, exit with code 3 instead of waiting for room; the "
                        "same command continues later");
}

std::vector<std::string> FullWords::words() const {
  return no_wait ? std::vector<std::string>{"--no-wait"} : std::vector<std::string>{};
}

std::uint64_t parse_size(const std::string& text, std::string_view option) {
  double value = 0;
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, value);
  const std::string_view unit(end, static_cast<std::size_t>(last - end));
  constexpr std::string_view k_units = "KMGT";
  const std::size_t power = unit.empty() ? 0 : k_units.find(unit[0]) + 1;
  const bool known = unit.empty() || (unit.size() == 1 && power != 0);
  value = std::ldexp(value, 10 * static_cast<int>(power));
  if (error != std::errc{} || !known || !(value >= 0) || value > 0x1p60) {
    throw UsageError(std::string(option) + " takes a size as in 512M or 8G, not '" + text + "'");
  }
  return static_cast<std::uint64_t>(value);
}

}  // namespace meshfarm
