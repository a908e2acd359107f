// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>

#include <meshfarm/report/summary.hpp>

#include "report/summary_words.hpp"

namespace meshfarm {
namespace {

/// Equal values may differ by rounding after interpolation at a point.
bool are_equal(const ValueError& colours) {
  constexpr double k_rounding = 1e-9;  // less than the precision of floats
  return colours.max < k_rounding;
}

/// The peak signal-to-noise ratio, for errors as fractions of the full range.
double psnr_of(const ValueError& error) {
  return -20 * std::log10(error.rms);
}

std::string text_of(const ValueError& error, ChannelRole role) {
  if (error.samples == 0) return "no point where both have a value";
  const std::string max = "  max " + number(error.max, "%.3g");
  switch (role) {
    case ChannelRole::colour:
      if (are_equal(error)) return "exact";
      return "PSNR " + number(psnr_of(error), "%.2f") + " dB  rms " + number(error.rms, "%.3g") +
             max + " of the full range";
    case ChannelRole::normal:
      return "mean " + number(error.mean, "%.3g") + max + " degrees";
    case ChannelRole::quality:
      break;
  }
  return "rms " + number(error.rms, "%.3g") + max;
}

Json to_json(const ValueError& error, ChannelRole role) {
  Json json = {{"samples", error.samples}};
  if (error.samples == 0) return json;
  switch (role) {
    case ChannelRole::colour:
      json["psnr"] = are_equal(error) ? Json(nullptr) : Json(psnr_of(error));
      json["rms"] = error.rms;
      break;
    case ChannelRole::normal:
      json["mean_degrees"] = error.mean;
      json["max_degrees"] = error.max;
      return json;
    case ChannelRole::quality:
      json["rms"] = error.rms;
      break;
  }
  json["max"] = error.max;
  return json;
}

Json to_json(const SurfaceError& error, double diagonal) {
  Json json = to_json(error.distance, diagonal);
  json["p95"] = error.quantiles.p95 / diagonal;
  json["p99"] = error.quantiles.p99 / diagonal;
  json["normals"] = to_json(error.normals);
  return json;
}

/// The change from A to B, in percent of A; nothing if A is 0.
std::optional<double> change(double a, double b) {
  if (a == 0) return std::nullopt;
  return 100 * (b - a) / std::abs(a);
}

std::optional<double> area_change(const Comparison& c) {
  return change(c.figures_a.shape.area, c.figures_b.shape.area);
}

std::optional<double> volume_change(const Comparison& c) {
  if (!c.figures_a.is_closed || !c.figures_b.is_closed) return std::nullopt;
  return change(c.figures_a.shape.volume, c.figures_b.shape.volume);
}

Json to_json(const std::optional<double>& number) {
  return number ? Json(*number) : Json(nullptr);
}

std::string text_of(const SurfaceError& error, double diagonal) {
  const auto share = [&](double distance) { return number(distance / diagonal, "%.3g"); };
  return "rms " + share(error.distance.rms) + "  mean " + share(error.distance.mean) + "  95 % " +
         share(error.quantiles.p95) + "  99 % " + share(error.quantiles.p99) + "  max " +
         share(error.distance.max);
}

Json to_json(const DistanceBounds& bounds, double diagonal) {
  return {{"at_least", bounds.lower / diagonal}, {"at_most", bounds.upper / diagonal}};
}

/// The larger of both directions: the Hausdorff distance.
Json certified_json(const Comparison& c) {
  if (!c.certified) return nullptr;
  const auto& [there, back] = *c.certified;
  const DistanceBounds greater{std::max(there.lower, back.lower),
                               std::max(there.upper, back.upper)};
  return {{"a_to_b", to_json(there, c.diagonal)},
          {"b_to_a", to_json(back, c.diagonal)},
          {"greater", to_json(greater, c.diagonal)}};
}

void add_certified(Lines& lines, const Comparison& c) {
  if (!c.certified) return;
  const auto add = [&](const char* name, const DistanceBounds& bounds) {
    lines.add(name, "max from " + number(bounds.lower / c.diagonal, "%.4g") + " to " +
                        number(bounds.upper / c.diagonal, "%.4g") + ", of all points");
  };
  add("certified A to B", c.certified->a_to_b);
  add("certified B to A", c.certified->b_to_a);
}

void add_changes(Lines& lines, const Comparison& c) {
  std::string text;
  if (const auto area = area_change(c)) text = "area " + number(*area, "%+.3g") + " %";
  if (const auto volume = volume_change(c)) text += ", volume " + number(*volume, "%+.3g") + " %";
  if (!text.empty()) lines.add("B against A", text);
}

Json channels_json(const Comparison& c) {
  Json json = Json::array();
  for (const ChannelDifference& channel : c.channels) {
    json.push_back({{"name", channel.name},
                    {"a_to_b", to_json(channel.a_to_b, channel.role)},
                    {"b_to_a", to_json(channel.b_to_a, channel.role)}});
  }
  return json;
}

std::string share_text(double share) {
  if (share == 0) return "the same everywhere";
  return "another one on " + number(100 * share, "%.3g") + " % of the area";
}

Json labels_json(const Comparison& c) {
  if (!c.labels) return nullptr;
  return {{"name_a", c.labels->name_a},
          {"name_b", c.labels->name_b},
          {"other_a_to_b", c.labels->a_to_b},
          {"other_b_to_a", c.labels->b_to_a}};
}

void add_labels(Lines& lines, const Comparison& c) {
  if (!c.labels_skipped.empty()) lines.add("labels", "not compared: " + c.labels_skipped);
  if (!c.labels) return;
  lines.add("labels A to B", share_text(c.labels->a_to_b));
  lines.add("labels B to A", share_text(c.labels->b_to_a));
}

void add_channels(Lines& lines, const Comparison& c) {
  for (const ChannelDifference& channel : c.channels) {
    lines.add(channel.name + " A to B", text_of(channel.a_to_b, channel.role));
    lines.add(channel.name + " B to A", text_of(channel.b_to_a, channel.role));
  }
  if (!c.channels_skipped.empty()) lines.add("channels", "not compared: " + c.channels_skipped);
  if (!c.channels_only_a.empty()) lines.add("only A has", joined(c.channels_only_a));
  if (!c.channels_only_b.empty()) lines.add("only B has", joined(c.channels_only_b));
}

}  // namespace

std::string render(const Comparison& c, Format format) {
  if (format == Format::json) {
    const Json skipped = c.channels_skipped.empty() ? Json(nullptr) : Json(c.channels_skipped);
    const Json not_measured = c.not_measured.empty() ? Json(nullptr) : Json(c.not_measured);
    const Json labels_skipped = c.labels_skipped.empty() ? Json(nullptr) : Json(c.labels_skipped);
    const Json map = c.map ? Json{{"path", c.map->path}, {"greatest", c.map->most}} : Json(nullptr);
    const Json json = {{"a", c.path_a},
                       {"b", c.path_b},
                       {"diagonal", c.diagonal},
                       {"a_to_b", to_json(c.a_to_b, c.diagonal)},
                       {"b_to_a", to_json(c.b_to_a, c.diagonal)},
                       {"certified", certified_json(c)},
                       {"surface_a", to_json(c.figures_a)},
                       {"surface_b", to_json(c.figures_b)},
                       {"area_change_percent", to_json(area_change(c))},
                       {"volume_change_percent", to_json(volume_change(c))},
                       {"not_measured", not_measured},
                       {"channels", channels_json(c)},
                       {"channels_not_compared", skipped},
                       {"channels_only_a", c.channels_only_a},
                       {"channels_only_b", c.channels_only_b},
                       {"labels", labels_json(c)},
                       {"labels_not_compared", labels_skipped},
                       {"map", map},
                       {"topology_a", to_json(c.welded_a)},
                       {"topology_b", to_json(c.welded_b)},
                       {"topology_not_welded_a", to_json(c.as_it_is_a)},
                       {"topology_not_welded_b", to_json(c.as_it_is_b)}};
    return dumped(json);
  }
  Lines lines;
  lines.add("A", c.path_a + ", " + grouped(c.welded_a.triangles) + " triangles");
  add_topology(lines, "", c.welded_a, c.as_it_is_a);
  add_figures(lines, "", c.figures_a);
  lines.add("B", c.path_b + ", " + grouped(c.welded_b.triangles) + " triangles");
  add_topology(lines, "", c.welded_b, c.as_it_is_b);
  add_figures(lines, "", c.figures_b);
  add_changes(lines, c);
  lines.add("A to B", text_of(c.a_to_b, c.diagonal));
  lines.add("B to A", text_of(c.b_to_a, c.diagonal));
  add_certified(lines, c);
  lines.add("unit", "A's diagonal, " + number(c.diagonal, "%.9g"));
  if (c.a_to_b.normals) lines.add("facing A to B", text_of(*c.a_to_b.normals));
  if (c.b_to_a.normals) lines.add("facing B to A", text_of(*c.b_to_a.normals));
  if (!c.not_measured.empty()) {
    lines.add("not measured", "normals, lengths of edges, crossings: " + c.not_measured);
  }
  add_channels(lines, c);
  add_labels(lines, c);
  if (c.map) {
    lines.add("map", c.map->path + ", vertices of B by their distance from A, up to " +
                         number(c.map->most, "%.6g") + " in the meshes' unit");
  }
  return lines.text();
}

}  // namespace meshfarm
