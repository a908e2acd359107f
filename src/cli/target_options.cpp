// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <charconv>
#include <cmath>
#include <optional>

#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/util/errors.hpp>

#include "cli/choice_words.hpp"
#include "cli/options.hpp"
#include "cli/texture_words.hpp"
#include "cli/weight_words.hpp"

namespace meshfarm {
namespace {

constexpr std::string_view k_here = "here";
constexpr std::string_view k_boundary = "boundary";

/// A percentage, as in "0.5%", or a plain number.
struct Number {
  double value = 0;
  bool is_percent = false;
};

/// Nothing if the text is no number, or negative.
std::optional<Number> parse_number(const std::string& text) {
  Number number;
  number.is_percent = text.ends_with('%');
  const char* last = text.data() + text.size() - (number.is_percent ? 1 : 0);
  const auto [end, error] = std::from_chars(text.data(), last, number.value);
  if (error != std::errc{} || end != last || !(number.value >= 0) || !std::isfinite(number.value)) {
    return std::nullopt;
  }
  if (number.is_percent) number.value /= 100;
  return number;
}

Length parse_length(const std::string& text, std::string_view option) {
  const std::optional<Length> length = length_in(text);
  if (!length) {
    throw UsageError(std::string(option) +
                     " takes a length in the mesh's unit, or a share of the diagonal as in 0.5%");
  }
  return *length;
}

double parse_ratio(const std::string& text) {
  const std::optional<Number> number = parse_number(text);
  if (!number || !(number->value > 0 && number->value <= 1)) {
    throw UsageError("--ratio takes a share above 0 and not above 1, as in 0.01 or 1%");
  }
  return number->value;
}

/// Components that are left out are far from the remaining surface: no bound holds for them.
void check_certify(const RunOptions& run) {
  if (!run.certify) return;
  if (!(run.error.value > 0)) throw UsageError("--certify proves a bound: it needs --error");
  if (run.drop_components.value > 0) {
    throw UsageError(
        "--certify proves the distance of the whole input: not with --drop-components");
  }
}

}  // namespace

std::optional<Length> length_in(const std::string& text) {
  const std::optional<Number> number = parse_number(text);
  if (!number) return std::nullopt;
  return Length{number->value, number->is_percent};
}

void TargetOptions::add(po::options_description& options) {
  options.add_options()(
      "ratio", po::value(&ratio)->value_name("R"),
      "share of the input's triangles to keep, above 0 and up to 1, for example 0.01 or 1%")(
      "triangles", po::value(&run.triangles)->value_name("N"), "number of triangles to keep")(
      "error", po::value(&error)->value_name("LENGTH"),
      "keep as few triangles as possible within this distance of the input, measured at sampled "
      "points: in the mesh's unit, or as a share of the diagonal, for example 0.1%")(
      "certify", po::bool_switch(&run.certify),
      "with --error: prove the distance for every point of both surfaces; where that fails the "
      "result keeps more triangles")(
      "allocation",
      po::value(&allocation)->default_value(allocation)->value_name("threshold|uniform"),
      "threshold: the same cost threshold in all parts; uniform: the same ratio in all parts")(
      "finish", po::value(&finish)->default_value(finish)->value_name("auto|here|farm|boundary"),
      "the last pass, to the exact count: here: the sink stitches all parts and may change any "
      "triangle; farm: jobs finish the result piece by piece, and no process holds all of it, if "
      "the other options allow that; auto: farm for results too large for one process; boundary: "
      "the sink, changing only edges at seams")(
      "composition",
      po::value(&composition)->default_value(composition)->value_name("auto|tree|sink"),
      "how simplified parts are joined: tree: jobs join a few neighbours at a time; sink: the sink "
      "joins all at once; auto: tree if there are many more triangles than wanted")(
      "fit", po::value(&fit)->default_value(fit)->value_name("auto|on|off"),
      "at the end, move the vertices so that the surface is nearer to points of the input: auto: "
      "for up to 125,000 triangles; on: for up to 2 million; not with --error, --crossings avoid, "
      "--drop-components or --finish boundary")(
      "topology", po::value(&topology)->default_value(topology)->value_name("auto|keep|simplify"),
      "handles, holes and pieces: keep: never close or remove any; simplify: do so where it costs "
      "least; auto: keep them as long as the target can be met at a fair error; with --crossings "
      "avoid, auto acts as simplify in the last pass")(
      "crossings", po::value(&crossings)->default_value(crossings)->value_name("allow|avoid"),
      "thin walls: avoid: collapses that make triangles cross come last, or never with --error; "
      "allow: crossings are not checked")("preserve-border",
                                          po::bool_switch(&run.lines.preserve_border),
                                          "leave the vertices on open borders as they are")(
      "crease-angle", po::value(&run.lines.crease_angle)->value_name("DEGREES"),
      "keep edges that are sharper than this in place: their vertices merge only along them (0, "
      "the default: none; below 180)")(
      "drop-components", po::value(&drop_components)->value_name("LENGTH"),
      "leave out pieces smaller than this: in the mesh's unit, or as a share of the diagonal, for "
      "example 0.5%")("weight", po::value(&weight)->value_name("NAME=W,..."), k_weight_help)(
      "normals", po::value(&normals)->default_value(normals)->value_name("blend|recompute|drop"),
      "the normals of the result, if the input has any: blend: as near to the input's as can be; "
      "recompute: those of the result's triangles; drop: none");
}

void TargetOptions::add_texture_size(po::options_description& options) {
  options.add_options()("texture-size", po::value(&run.texture_size)->value_name("PIXELS"),
                        "width and height of the picture that --uv bake makes, 64 to 16384 (0, the "
                        "default: chosen from the input's pictures)");
}

void TargetOptions::add_attributes(po::options_description& options) {
  add_texture_size(options);
  options.add_options()(
      "uv", po::value(&uv)->default_value(uv)->value_name("auto|keep|bake|drop"),
      "the stage's textures: keep: keep their charts and pictures; bake: make a new picture; drop: "
      "leave them out; auto: keep if the number of triangles can be met that way, else bake");
  options.add_options()(
      "attributes", po::value(&attributes)->default_value(attributes)->value_name("auto|none|LIST"),
      "channels and labels of the stage to keep in the result: auto: all that the output format "
      "can store; LIST: only these, as in red,green,blue ('colours' and 'normals' stand for all of "
      "theirs)");
}

void TargetOptions::check() {
  const int given =
      (ratio.empty() ? 0 : 1) + (run.triangles != 0 ? 1 : 0) + (error.empty() ? 0 : 1);
  if (given != 1) throw UsageError("give one of --ratio, --triangles and --error, above 0");
  if (!ratio.empty()) run.ratio = parse_ratio(ratio);
  if (!error.empty()) {
    run.error = parse_length(error, "--error");
    if (!(run.error.value > 0)) throw UsageError("--error must be above 0");
  }
  check_joining();
  check_surface();
  check_certify(run);
}

/// Options for how parts become one mesh.
void TargetOptions::check_joining() {
  run.allocation =
      chosen<Allocation>("--allocation", allocation,
                         {{"threshold", Allocation::threshold}, {"uniform", Allocation::uniform}});
  const std::string_view place =
      finish == "global" ? k_here : std::string_view(finish);  // its older name
  run.finish_place = chosen<FinishPlace>("--finish", place,
                                         {{"auto", FinishPlace::automatic},
                                          {k_here, FinishPlace::here},
                                          {"farm", FinishPlace::farm},
                                          {k_boundary, FinishPlace::here}});
  run.finish = finish == k_boundary ? Finish::boundary : Finish::global;
  run.fit = chosen<VertexFit>(
      "--fit", fit,
      {{"auto", VertexFit::automatic}, {"on", VertexFit::on}, {"off", VertexFit::off}});
  run.composition = chosen<Composition>(
      "--composition", composition,
      {{"auto", Composition::automatic}, {"tree", Composition::tree}, {"sink", Composition::sink}});
  if (run.composition == Composition::tree &&
      (!error.empty() || run.allocation == Allocation::uniform || run.finish == Finish::boundary)) {
    throw UsageError(
        "--composition tree uses one cost threshold for all parts: it cannot be combined with "
        "--error, --allocation uniform or --finish boundary");
  }
}

/// Options for the result's surface.
void TargetOptions::check_surface() {
  run.lines.topology = chosen<TopologyMode>("--topology", topology,
                                            {{"auto", TopologyMode::automatic},
                                             {"keep", TopologyMode::keep},
                                             {"simplify", TopologyMode::simplify}});
  run.lines.crossings = chosen<CrossingMode>(
      "--crossings", crossings, {{"allow", CrossingMode::allow}, {"avoid", CrossingMode::avoid}});
  if (!(run.lines.crease_angle >= 0 && run.lines.crease_angle < 180)) {
    throw UsageError("--crease-angle must be 0 (no creases) or more, and below 180 degrees");
  }
  if (!drop_components.empty()) {
    run.drop_components = parse_length(drop_components, "--drop-components");
  }
  run.normals = chosen<Normals>(
      "--normals", normals,
      {{"blend", Normals::blend}, {"recompute", Normals::recompute}, {"drop", Normals::drop}});
  run.channels = parse_choice(attributes, "--attributes");
  run.textures = parse_texture_mode(uv);
  if (run.texture_size != 0 && (run.texture_size < 64 || run.texture_size > 16'384)) {
    throw UsageError("--texture-size: from 64 to 16384 pixels");
  }
  parse_weights(weight, run);
  const std::string why = run.fit == VertexFit::on ? why_not_fitted(run) : "";
  if (!why.empty()) throw UsageError("--fit on cannot be combined with " + why);
}

void TargetOptions::check_given(const GivenOptions& given) const {
  if (run.textures == TextureMode::keep || run.textures == TextureMode::drop) {
    warn_of_unused(given, {"texture-size"}, "--uv bake, and an output for textures");
  }
}

std::vector<std::string> TargetOptions::words() const {
  std::vector<std::string> words = {"--allocation", allocation,      "--finish",
                                    finish,         "--composition", composition};
  words.insert(words.end(), {"--topology", topology});
  if (fit != "auto") words.insert(words.end(), {"--fit", fit});
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

}  // namespace meshfarm
