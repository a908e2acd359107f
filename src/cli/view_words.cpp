// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/view_words.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

struct NamedView {
  std::string_view name;
  double azimuth;
  double elevation;
};
constexpr std::array<NamedView, 7> k_named_views = {{{"front", 0, 0},
                                                     {"right", 90, 0},
                                                     {"back", 180, 0},
                                                     {"left", 270, 0},
                                                     {"top", 0, 90},
                                                     {"bottom", 0, -90},
                                                     {"iso", 45, 35.264}}};

struct NamedAxis {
  std::string_view name;
  Vec3 axis;
};
constexpr std::array<NamedAxis, 6> k_axes = {{{"x", {1, 0, 0}},
                                              {"y", {0, 1, 0}},
                                              {"z", {0, 0, 1}},
                                              {"-x", {-1, 0, 0}},
                                              {"-y", {0, -1, 0}},
                                              {"-z", {0, 0, -1}}}};

template <class Number>
std::optional<Number> whole_number(std::string_view text, Number made = {}) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), made);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return made;
}

/// "30,20"; nothing if it is not two numbers.
template <class Number>
std::optional<std::array<Number, 2>> pair_of(std::string_view text, char between) {
  const std::size_t at = text.find(between);
  if (at == std::string_view::npos) return std::nullopt;
  const std::optional<Number> first = whole_number<Number>(text.substr(0, at));
  const std::optional<Number> second = whole_number<Number>(text.substr(at + 1));
  if (!first || !second) return std::nullopt;
  return std::array<Number, 2>{*first, *second};
}

void parse_view(const std::string& word, View& view) {
  const auto named = std::find_if(k_named_views.begin(), k_named_views.end(),
                                  [&](const NamedView& each) { return each.name == word; });
  if (named != k_named_views.end()) {
    view.azimuth = named->azimuth;
    view.elevation = named->elevation;
    return;
  }
  const auto angles = pair_of<double>(word, ',');
  if (!angles || !(std::abs((*angles)[0]) <= 360) || !(std::abs((*angles)[1]) <= 90)) {
    throw UsageError(
        "--view is front, back, left, right, top, bottom, iso, or AZIMUTH,ELEVATION in degrees, "
        "within 360 and 90, not '" +
        word + "'");
  }
  view.azimuth = (*angles)[0];
  view.elevation = (*angles)[1];
}

void parse_colour_by(const std::string& word, RenderOptions& render) {
  static constexpr std::array<std::pair<std::string_view, ColourBy>, 9> k_words = {
      {{"auto", ColourBy::automatic},
       {"none", ColourBy::none},
       {"colour", ColourBy::colour},
       {"normal", ColourBy::normal},
       {"piece", ColourBy::piece},
       {"part", ColourBy::part},
       {"label", ColourBy::label},
       {"height", ColourBy::height},
       {"quality", ColourBy::quality}}};
  if (word.empty()) throw UsageError("--colour-by takes a word or a channel's name");
  const auto found = std::find_if(k_words.begin(), k_words.end(),
                                  [&](const auto& each) { return each.first == word; });
  render.colour_by = found == k_words.end() ? ColourBy::channel : found->second;
  render.channel = word;
}

/// "ff8000" or "white".
std::array<std::uint8_t, 3> parse_background(const std::string& word) {
  if (word == "white") return {255, 255, 255};
  if (word == "black") return {0, 0, 0};
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number, 16);
  if (word.size() != 6 || error != std::errc{} || end != word.data() + word.size()) {
    throw UsageError(
        "--background is white, black, transparent, or six hexadecimal digits as in f4f6f8, not '" +
        word + "'");
  }
  return {static_cast<std::uint8_t>(number >> 16), static_cast<std::uint8_t>(number >> 8),
          static_cast<std::uint8_t>(number)};
}

}  // namespace

Vec3 parse_up(const std::string& word) {
  const auto named = std::find_if(k_axes.begin(), k_axes.end(),
                                  [&](const NamedAxis& each) { return each.name == word; });
  if (named == k_axes.end()) throw UsageError("--up is x, y, z, -x, -y or -z, not '" + word + "'");
  return named->axis;
}

void ViewWords::add(po::options_description& options) {
  options.add_options()("output,o", po::value(&output)->required()->value_name("FILE"),
                        "the picture to write, a .png")(
      "view",
      po::value(&view_)->default_value(view_)->value_name("front|back|left|right|top|bottom|iso"),
      "from where to look, or AZIMUTH,ELEVATION in degrees: 0,0 is the front, 90,0 the right, 0,90 "
      "the top")("up", po::value(&up_)->default_value(up_)->value_name("x|y|z|-x|-y|-z"),
                 "the mesh's axis that points up")(
      "projection",
      po::value(&projection_)->default_value(projection_)->value_name("perspective|orthographic"),
      "perspective: distant parts look smaller; orthographic: everything is at one scale")(
      "size", po::value(&size_)->default_value(size_)->value_name("WIDTHxHEIGHT"),
      "size of the picture in pixels")(
      "samples", po::value(&render.samples)->default_value(render.samples)->value_name("N"),
      "N x N samples make a pixel, 1 to 8: more make edges smoother, and take 8 bytes each")(
      "colour-by",
      po::value(&colour_by_)
          ->default_value(colour_by_)
          ->value_name("auto|none|colour|normal|piece|part|label|height|quality"),
      "auto: the mesh's colours, if it has any; normal: which way triangles face; piece: connected "
      "pieces; part: parts of a stage; label: materials or other labels of triangles; height: "
      "along the axis that points up; quality: the first number of the vertices that is not a "
      "colour or normal; or the name of such a number")(
      "range", po::value(&range_)->value_name("LOW:HIGH"),
      "with a number to colour by: values at the ends of the scale (default: the least and the "
      "greatest)")("wire", po::bool_switch(&render.wire), "draw the triangles' edges, too")(
      "background", po::value(&background_)->default_value(background_)->value_name("COLOUR"),
      "white, black, transparent, or six hexadecimal digits as in f4f6f8");
}

void ViewWords::check() {
  constexpr std::uint32_t k_most = 16'384;
  if (!output.ends_with(".png")) {
    throw UsageError("--output: the picture's name must end with .png, not '" + output + "'");
  }
  parse_view(view_, render.view);
  render.view.up = parse_up(up_);
  if (projection_ != "perspective" && projection_ != "orthographic") {
    throw UsageError("--projection is 'perspective' or 'orthographic', not '" + projection_ + "'");
  }
  render.view.projection =
      projection_ == "perspective" ? Projection::perspective : Projection::orthographic;
  const auto size = pair_of<std::uint32_t>(size_, 'x');
  if (!size || std::min((*size)[0], (*size)[1]) < 16 || std::max((*size)[0], (*size)[1]) > k_most) {
    throw UsageError("--size takes WIDTHxHEIGHT, from 16x16 to 16384x16384, not '" + size_ + "'");
  }
  render.width = (*size)[0];
  render.height = (*size)[1];
  if (render.samples < 1 || render.samples > 8) throw UsageError("--samples: from 1 to 8");
  parse_colour_by(colour_by_, render);
  render.transparent = background_ == "transparent";
  if (!render.transparent) render.background = parse_background(background_);
  if (range_.empty()) return;
  render.range = pair_of<double>(range_, ':');
  if (!render.range || !((*render.range)[0] < (*render.range)[1])) {
    throw UsageError("--range takes LOW:HIGH, two numbers, not '" + range_ + "'");
  }
  const bool is_number = render.colour_by == ColourBy::height ||
                         render.colour_by == ColourBy::quality ||
                         render.colour_by == ColourBy::channel;
  if (!is_number) {
    throw UsageError("--range needs --colour-by with a number: height, quality or a name");
  }
}

}  // namespace meshfarm
