// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/options.hpp"

#include <charconv>
#include <cmath>

#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/transport/addresses.hpp>
#include <meshfarm/util/errors.hpp>

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

/// "0.5%": of the diagonal; "2.5": in the mesh's unit.
Length parse_length(const std::string& text, std::string_view option) {
  Length length;
  length.of_diagonal = text.ends_with('%');
  const char* last = text.data() + text.size() - (length.of_diagonal ? 1 : 0);
  const auto [end, error] = std::from_chars(text.data(), last, length.value);
  if (error != std::errc{} || end != last || !(length.value >= 0) || !std::isfinite(length.value)) {
    throw UsageError(std::string(option) +
                     " takes a length in the mesh's unit, or a share of the diagonal as in 0.5%");
  }
  if (length.of_diagonal) length.value /= 100;
  return length;
}

/// Pieces that are left out are far from all that stays.
void check_certify(const RunOptions& run) {
  if (!run.certify) return;
  if (!(run.error.value > 0)) throw UsageError("--certify proves a bound: it needs --error");
  if (run.drop_components.value > 0) {
    throw UsageError(
        "--certify proves the distance of the whole input: not with --drop-components");
  }
}

}  // namespace

void TalkOptions::add(po::options_description& options) {
  add_quiet(options);
  options.add_options()("json", po::bool_switch(&json), "print the result as JSON");
}

void TalkOptions::add_quiet(po::options_description& options) {
  options.add_options()("quiet,q", po::bool_switch(&quiet), "no progress, only errors");
}

ProgressStyle TalkOptions::progress() const {
  return quiet ? ProgressStyle::none : progress_style_of_stderr();
}

void TargetOptions::add(po::options_description& options) {
  options.add_options()("ratio", po::value(&run.ratio)->value_name("R"),
                        "share of the input's triangles to keep, for example 0.01")(
      "triangles", po::value(&run.triangles)->value_name("N"), "number of triangles to keep")(
      "error", po::value(&error)->value_name("LENGTH"),
      "keep as few triangles as stay within this distance of the input, measured at sampled "
      "points: "
      "in the mesh's unit, or as a share of the diagonal, for example 0.1%")(
      "certify", po::bool_switch(&run.certify),
      "with --error: prove the distance for every point of both surfaces; where that fails the "
      "result keeps more triangles")(
      "allocation",
      po::value(&allocation)->default_value(allocation)->value_name("threshold|uniform"),
      "threshold: the same cost threshold in all parts; uniform: the same ratio in all parts")(
      "finish", po::value(&finish)->default_value(finish)->value_name("auto|here|farm|boundary"),
      "the last pass, to the exact count: here: the sink stitches all and may change everything; "
      "farm: jobs do it piece by piece, and no process holds the whole result, where the other "
      "options allow it; auto: farm for results too large for one process; boundary: the sink, "
      "and only edges at seams")(
      "composition",
      po::value(&composition)->default_value(composition)->value_name("auto|tree|sink"),
      "how simplified parts are joined: tree: neighbours by jobs, a few at once; sink: all at once "
      "by the sink; auto: tree if there are many more triangles than wanted")(
      "topology", po::value(&topology)->default_value(topology)->value_name("auto|keep|simplify"),
      "handles, holes and pieces: keep: never close or remove any; simplify: do so where it costs "
      "least; auto: keep them as long as the target can be met at a fair error")(
      "crossings", po::value(&crossings)->default_value(crossings)->value_name("allow|avoid"),
      "thin walls: avoid: what would make triangles cross others comes last, or never with "
      "--error; "
      "allow: nobody looks")("preserve-border", po::bool_switch(&run.lines.preserve_border),
                             "leave the vertices on open borders as they are")(
      "crease-angle", po::value(&run.lines.crease_angle)->value_name("DEGREES"),
      "keep edges that are sharper than this in place: their vertices merge only along them")(
      "drop-components", po::value(&drop_components)->value_name("LENGTH"),
      "leave out pieces smaller than this: in the mesh's unit, or as a share of the diagonal, for "
      "example 0.5%")("weight", po::value(&weight)->value_name("NAME=W,..."), k_weight_help)(
      "normals", po::value(&normals)->default_value(normals)->value_name("blend|recompute|drop"),
      "the normals of the result, if the input has any: blend: as near to the input's as can be; "
      "recompute: those of the result's triangles; drop: none");
}

void TargetOptions::add_texture_size(po::options_description& options) {
  options.add_options()("texture-size", po::value(&run.texture_size)->value_name("PIXELS"),
                        "sides of a picture that is made by --uv bake (default: by the input's)");
}

void TargetOptions::add_attributes(po::options_description& options) {
  add_texture_size(options);
  options.add_options()("uv", po::value(&uv)->default_value(uv)->value_name("auto|keep|bake|drop"),
                        "the stage's textures: keep: their charts and pictures stay; bake: a new "
                        "picture is made; drop: they are left out; auto: keep if the number of "
                        "triangles can be met so, else bake");
  options.add_options()(
      "attributes", po::value(&attributes)->default_value(attributes)->value_name("auto|none|LIST"),
      "which channels and labels of the stage the result has: auto: all that the output's format "
      "has "
      "a place for; LIST: these, as in red,green,blue ('colours' and 'normals' stand for theirs)");
}

void TargetOptions::check() {
  const int given =
      (run.ratio != 0 ? 1 : 0) + (run.triangles != 0 ? 1 : 0) + (error.empty() ? 0 : 1);
  if (given != 1) throw UsageError("give one of --ratio, --triangles and --error, above 0");
  if (run.ratio != 0 && !(run.ratio > 0 && run.ratio <= 1)) {
    throw UsageError("--ratio must be above 0 and not above 1");
  }
  if (!error.empty()) {
    run.error = parse_length(error, "--error");
    if (!(run.error.value > 0)) throw UsageError("--error must be above 0");
  }
  if (allocation != "threshold" && allocation != "uniform") {
    throw UsageError("--allocation is 'threshold' or 'uniform', not '" + allocation + "'");
  }
  if (finish != "auto" && finish != "here" && finish != "farm" && finish != "boundary" &&
      finish != "global") {
    throw UsageError("--finish is 'auto', 'here', 'farm' or 'boundary', not '" + finish + "'");
  }
  if (composition != "auto" && composition != "tree" && composition != "sink") {
    throw UsageError("--composition is 'auto', 'tree' or 'sink', not '" + composition + "'");
  }
  if (composition == "tree" &&
      (!error.empty() || allocation == "uniform" || finish == "boundary")) {
    throw UsageError(
        "--composition tree goes by the one cost threshold: not with --error, --allocation uniform "
        "or --finish boundary");
  }
  if (topology != "auto" && topology != "keep" && topology != "simplify") {
    throw UsageError("--topology is 'auto', 'keep' or 'simplify', not '" + topology + "'");
  }
  run.lines.topology = topology == "auto"   ? TopologyMode::automatic
                       : topology == "keep" ? TopologyMode::keep
                                            : TopologyMode::simplify;
  if (crossings != "allow" && crossings != "avoid") {
    throw UsageError("--crossings is 'allow' or 'avoid', not '" + crossings + "'");
  }
  run.lines.crossings = crossings == "avoid" ? CrossingMode::avoid : CrossingMode::allow;
  if (!(run.lines.crease_angle >= 0 && run.lines.crease_angle < 180)) {
    throw UsageError("--crease-angle must be 0 (no creases) or more, and below 180 degrees");
  }
  if (!drop_components.empty()) {
    run.drop_components = parse_length(drop_components, "--drop-components");
  }
  check_certify(run);
  if (normals != "blend" && normals != "recompute" && normals != "drop") {
    throw UsageError("--normals is 'blend', 'recompute' or 'drop', not '" + normals + "'");
  }
  run.normals = normals == "blend"       ? Normals::blend
                : normals == "recompute" ? Normals::recompute
                                         : Normals::drop;
  run.channels = parse_choice(attributes, "--attributes");
  run.textures = parse_texture_mode(uv);
  if (run.texture_size != 0 && (run.texture_size < 64 || run.texture_size > 16'384)) {
    throw UsageError("--texture-size: from 64 to 16384 pixels");
  }
  parse_weights(weight, run);
  run.allocation = allocation == "uniform" ? Allocation::uniform : Allocation::threshold;
  run.composition = composition == "auto"   ? Composition::automatic
                    : composition == "tree" ? Composition::tree
                                            : Composition::sink;
  run.finish = finish == "boundary" ? Finish::boundary : Finish::global;
  run.finish_place = finish == "auto"   ? FinishPlace::automatic
                     : finish == "farm" ? FinishPlace::farm
                                        : FinishPlace::here;  // 'global' is its older name
}

std::vector<std::string> TargetOptions::words() const {
  std::vector<std::string> words = {"--allocation", allocation,      "--finish",
                                    finish,         "--composition", composition};
  words.insert(words.end(), {"--topology", topology});
  if (crossings != "allow") words.insert(words.end(), {"--crossings", crossings});
  if (run.lines.preserve_border) words.emplace_back("--preserve-border");
  if (run.lines.crease_angle > 0) {
    words.insert(words.end(), {"--crease-angle", shortest(run.lines.crease_angle)});
  }
  if (const std::string weights = weight_words(run); !weights.empty()) {
    words.insert(words.end(), {"--weight", weights});
  }
  if (normals != "blend") words.insert(words.end(), {"--normals", normals});
  if (attributes != "auto") words.insert(words.end(), {"--attributes", attributes});
  if (uv != "auto") words.insert(words.end(), {"--uv", uv});
  if (run.texture_size != 0) {
    words.insert(words.end(), {"--texture-size", std::to_string(run.texture_size)});
  }
  if (!drop_components.empty()) {
    words.insert(words.end(), {"--drop-components", drop_components});
  }
  if (!error.empty()) {
    words.insert(words.end(), {"--error", error});
    if (run.certify) words.emplace_back("--certify");
  } else if (run.triangles != 0) {
    words.insert(words.end(), {"--triangles", std::to_string(run.triangles)});
  } else {
    words.insert(words.end(), {"--ratio", shortest(run.ratio)});
  }
  return words;
}

void CutWords::add(po::options_description& options) {
  options.add_options()(
      "scheme", po::value(&scheme_word)->default_value(scheme_word)->value_name("cut|stream"),
      "cut: compact parts, each simplified in memory; stream: slabs along the "
      "longest axis, each swept through a bounded buffer")(
      "cut", po::value(&where)->default_value(where)->value_name("here|farm|auto"),
      "with --scheme cut: here: this host cuts; farm: the first jobs of a run cut, on all hosts, "
      "of "
      "a binary PLY file of triangles that all hosts see; auto: farm, if simplify keeps no parts, "
      "the mesh is large, and there are workers enough")(
      "blocks", po::value(&blocks)->value_name("N"),
      "with --cut farm: blocks of vertices, and of triangles, up to 64 (default: of about 500,000 "
      "each); the parts do not depend on it")(
      "sort", po::value(&sort)->default_value(sort)->value_name("here|farm"),
      "with --scheme stream: here: sort the slabs on this host; farm: the first jobs of a run sort "
      "them, on all hosts")(
      "parts", po::value(&cut.parts)->value_name("N"),
      "number of parts (default: parts of about one million triangles, and at least 16 of a large "
      "mesh) or streams (default: 1.2 million triangles each)")(
      "weld", po::value(&weld)->default_value(weld)->value_name("exact|off"),
      "exact: merge vertices at the same position, except where surfaces only touch; off: do not "
      "merge")(
      "attributes", po::value(&attributes)->default_value(attributes)->value_name("auto|none|LIST"),
      "auto: colours, normals and other numbers that the vertices have, and materials or "
      "other labels of triangles, if the formats have a place for them; none: positions "
      "only; LIST: these, as in red,green,blue ('colours' and 'normals' stand for "
      "theirs)")("uv", po::value(&uv)->default_value(uv)->value_name(k_uv_words), k_uv_help)(
      "threads", po::value(&cut.threads)->value_name("N"), "threads of the cut (default: cores)")(
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
  if (scheme_word != "cut" && scheme_word != "stream") {
    throw UsageError("--scheme is 'cut' or 'stream', not '" + scheme_word + "'");
  }
  if (weld != "exact" && weld != "off") {
    throw UsageError("--weld is 'exact' or 'off', not '" + weld + "'");
  }
  channels = parse_choice(attributes, "--attributes");
  parse_uv(uv);
  if (sort != "here" && sort != "farm") {
    throw UsageError("--sort is 'here' or 'farm', not '" + sort + "'");
  }
  if (sort == "farm" && scheme_word != "stream") {
    throw UsageError("--sort farm goes with --scheme stream: parts of a cut are not sorted");
  }
  if (where != "here" && where != "farm" && where != "auto") {
    throw UsageError("--cut is 'here', 'farm' or 'auto', not '" + where + "'");
  }
  if (blocks > k_most_cut_blocks / 2) throw UsageError("--blocks: from 1 to 64");
  if (where == "farm" && scheme_word != "cut") {
    throw UsageError(
        "--cut farm goes with --scheme cut; with --scheme stream there is --sort farm");
  }
  if (where == "farm" && weld != "exact") throw UsageError("--cut farm goes with --weld exact");
  cut.scheme = scheme_word == "stream" ? Scheme::stream : Scheme::cut;
  cut.weld = weld == "off" ? Weld::off : Weld::exact;
  if (cut.parts > 1'000'000) throw UsageError("--parts: at most 1,000,000");
  if (cut.window_triangles < 1000 || cut.window_triangles > 1'000'000'000) {
    throw UsageError("--window: from 1,000 to 1,000,000,000 triangles");
  }
  cut.sort = sort == "farm" ? SortAt::farm : SortAt::here;
  cut.scratch = scratch;
  if (memory.empty()) return;
  cut.memory_bytes = parse_size(memory, "--memory");
  if (cut.memory_bytes == 0) throw UsageError("--memory must be above 0");
}

std::vector<std::string> CutWords::words() const {
  std::vector<std::string> words = {"--scheme", scheme_word, "--sort",  sort,
                                    "--weld",   weld,        "--window"};
  words.push_back(std::to_string(cut.window_triangles));
  if (where != "auto") words.insert(words.end(), {"--cut", where});
  if (blocks != 0) words.insert(words.end(), {"--blocks", std::to_string(blocks)});
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
  if (insecure_network && !insecure) throw UsageError("--insecure-network goes with --insecure");
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
      "with --schedule static: wait for so many workers before parts are dealt out")(
      "hang-seconds", po::value(&hang_s)->default_value(hang_s)->value_name("N"),
      "give a part to another worker after so many seconds without progress, but not before three "
      "times its estimated time");
}

void ScheduleWords::check() {
  if (schedule != "dynamic" && schedule != "static") {
    throw UsageError("--schedule is 'dynamic' or 'static', not '" + schedule + "'");
  }
  options.schedule = schedule == "static" ? Schedule::fixed : Schedule::dynamic;
  if (hang_s == 0 || hang_s > 86'400) throw UsageError("--hang-seconds: from 1 to 86400");
}

std::vector<std::string> ScheduleWords::words() const {
  return {"--schedule",       schedule,
          "--expect-workers", std::to_string(options.expect_workers),
          "--hang-seconds",   std::to_string(hang_s)};
}

void FullWords::add(po::options_description& options) {
  options.add_options()("no-wait", po::bool_switch(&no_wait),
                        "where the disk is full: end with 3, to be taken up again, instead of "
                        "waiting for room");
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
