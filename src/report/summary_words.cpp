// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "report/summary_words.hpp"

namespace meshfarm {
namespace {

std::vector<std::string> material_names(const LabelMeaning& labels) {
  std::vector<std::string> names;
  for (const Material& material : labels.materials) names.push_back(material.name);
  return names;
}

}  // namespace

std::vector<std::string> names_of(const std::vector<Channel>& channels) {
  std::vector<std::string> names;
  names.reserve(channels.size());
  for (const Channel& channel : channels) names.push_back(channel.name);
  return names;
}

Json to_json(const Box& box) {
  if (box.empty()) return nullptr;
  return {{"lo", {box.lo.x, box.lo.y, box.lo.z}}, {"hi", {box.hi.x, box.hi.y, box.hi.z}}};
}

Json to_json(const Topology& t) {
  const auto handles = handles_of(t);
  return {{"vertices", t.vertices},
          {"unused_vertices", t.vertices - t.used_vertices},
          {"triangles", t.triangles},
          {"components", t.components},
          {"euler", t.euler},
          {"handles", handles ? Json(*handles) : Json(nullptr)},
          {"border_edges", t.border_edges},
          {"nonmanifold_edges", t.nonmanifold_edges},
          {"orientation_conflicts", t.orientation_conflicts},
          {"degenerate", t.degenerate},
          {"zero_area", t.zero_area},
          {"duplicate", t.duplicate}};
}

Json to_json(const Distance& d, double diagonal) {
  return {{"rms", d.rms / diagonal}, {"mean", d.mean / diagonal}, {"max", d.max / diagonal}};
}

std::optional<std::int64_t> handles_of(const Topology& t) {
  if (t.border_edges + t.nonmanifold_edges > 0) return std::nullopt;
  return (2 * static_cast<std::int64_t>(t.components) - t.euler) / 2;
}

std::string counted(std::uint64_t count, std::string_view thing) {
  return grouped(count) + " " + std::string(thing) + (count == 1 ? "" : "s");
}

std::string text_of(const Topology& t) {
  const auto handles = handles_of(t);
  return counted(t.components, "component") + ", " + counted(t.border_edges, "border edge") + ", " +
         counted(t.nonmanifold_edges, "non-manifold edge") + ", " + grouped(t.degenerate) +
         " degenerate, " + grouped(t.zero_area) + " of zero area, " + grouped(t.duplicate) +
         " duplicate, Euler characteristic " + std::to_string(t.euler) +
         (handles ? ", " + std::to_string(*handles) + (*handles == 1 ? " handle" : " handles")
                  : "");
}

void add_topology(Lines& lines, const std::string& label, const Topology& welded,
                  const Topology& as_it_is) {
  const std::uint64_t merged = as_it_is.vertices - welded.vertices;
  if (merged == 0 && text_of(welded) == text_of(as_it_is)) {
    lines.add(label, text_of(welded));
    return;
  }
  lines.add(label,
            "welded (" + grouped(merged) + " coincident vertices merged): " + text_of(welded));
  lines.add("", "as it is: " + text_of(as_it_is));
}

std::string text_of(const Distance& d, double diagonal) {
  return "rms " + number(d.rms / diagonal, "%.3g") + "  mean " + number(d.mean / diagonal, "%.3g") +
         "  max " + number(d.max / diagonal, "%.3g");
}

Json to_json(const std::optional<NormalDeviation>& normals) {
  if (!normals) return nullptr;
  return {
      {"rms_degrees", normals->rms}, {"p95_degrees", normals->p95}, {"over_90", normals->over_90}};
}

void add_quantiles(const std::optional<DistanceQuantiles>& quantiles, double diagonal, Json& json) {
  json["p95"] = quantiles ? Json(quantiles->p95 / diagonal) : Json(nullptr);
  json["p99"] = quantiles ? Json(quantiles->p99 / diagonal) : Json(nullptr);
}

Json to_json(const MeasuredError& error, double diagonal) {
  Json json = to_json(error.greater(), diagonal);
  json["of"] = "the greater of both directions, fractions of the diagonal";
  json["input_to_output"] = to_json(error.to_output, diagonal);
  add_quantiles(error.to_output_quantiles, diagonal, json["input_to_output"]);
  json["input_to_output"]["samples"] = error.input_samples;
  json["input_to_output"]["normals"] = to_json(error.to_output_normals);
  if (error.to_output_normals) {
    json["input_to_output"]["normals"]["samples"] = error.normal_samples;
  }
  json["output_to_input"] = to_json(error.to_input, diagonal);
  add_quantiles(error.to_input_quantiles, diagonal, json["output_to_input"]);
  json["output_to_input"]["samples"] = error.output_samples;
  return json;
}

std::string text_of(const NormalDeviation& normals) {
  return "rms " + number(normals.rms, "%.3g") + "  95 % " + number(normals.p95, "%.3g") +
         " degrees, over 90 on " + number(100 * normals.over_90, "%.2g") + " % of the area";
}

std::string dumped(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string text_of(const LabelMeaning& labels) {
  constexpr std::size_t k_most_names = 16;
  if (labels.materials.empty()) return labels.name + ": numbers";
  std::vector<std::string> names = material_names(labels);
  if (names.size() > k_most_names) {
    names.resize(k_most_names);
    names.emplace_back("...");
  }
  return labels.name + ": " + grouped(labels.materials.size()) + " (" + joined(names) + ")";
}

std::string text_of(const TexturesMade& textures) {
  const std::string floor =
      "keeping their charts needs about " + grouped(textures.floor) + " triangles";
  switch (textures.way) {
    case TexturesMade::Way::kept:
      return "kept: " + grouped(textures.pictures) +
             (textures.pictures == 1 ? " picture" : " pictures") + "; " + floor;
    case TexturesMade::Way::baked:
      return "a new picture of " + grouped(textures.size) + " x " + grouped(textures.size) +
             " pixels, " + grouped(textures.charts) + " charts on " +
             number(100 * textures.charts_share, "%.0f %%") + " of it; " + floor;
    case TexturesMade::Way::dropped:
      return "not kept; " + floor;
    case TexturesMade::Way::none:
      break;
  }
  return "none";
}

Json to_json(const TexturesMade& textures) {
  if (textures.way == TexturesMade::Way::none) return nullptr;
  Json json = {{"floor", textures.floor}};
  if (textures.way == TexturesMade::Way::dropped) json["made"] = "dropped";
  if (textures.way == TexturesMade::Way::kept) {
    json["made"] = "kept";
    json["pictures"] = textures.pictures;
  }
  if (textures.way == TexturesMade::Way::baked) {
    json["made"] = "baked";
    json["size"] = textures.size;
    json["charts"] = textures.charts;
    json["charts_share"] = textures.charts_share;
  }
  return json;
}

Json to_json(const std::optional<LabelMeaning>& labels) {
  if (!labels) return nullptr;
  return {{"name", labels->name}, {"materials", material_names(*labels)}};
}

Json to_json(const SurfaceFigures& figures) {
  const auto& [shape, is_closed, edges, crossing, skipped] = figures;
  return {{"area", shape.area},
          {"volume", is_closed ? Json(shape.volume) : Json(nullptr)},
          {"border_length", edges ? Json(edges->border) : Json(nullptr)},
          {"feature_length", edges ? Json(edges->feature) : Json(nullptr)},
          {"smallest_angle_p1_degrees", shape.smallest_angle_p1},
          {"below_5_degrees", shape.share_below_5},
          {"crossing_triangles", crossing ? Json(*crossing) : Json(nullptr)},
          {"crossings_not_counted", skipped.empty() ? Json(nullptr) : Json(skipped)}};
}

void add_figures(Lines& lines, const std::string& label, const SurfaceFigures& figures) {
  const ShapeMeasures& shape = figures.shape;
  std::string sizes =
      "area " + number(shape.area, "%.6g") +
      (figures.is_closed ? ", volume " + number(shape.volume, "%.6g") : ", no volume: not closed");
  if (figures.edges) {
    sizes += ", border " + number(figures.edges->border, "%.4g") + " long, edges over " +
             number(k_feature_degrees, "%g") + " degrees " +
             number(figures.edges->feature, "%.4g") + " long";
  }
  lines.add(label, sizes);
  lines.add("", "smallest angles: 1 % of the triangles up to " +
                    number(shape.smallest_angle_p1, "%.3g") + " degrees, " +
                    number(100 * shape.share_below_5, "%.3g") + " % below 5 degrees");
  if (figures.crossing_triangles) {
    lines.add("", grouped(*figures.crossing_triangles) + " triangles cut or touch others");
  } else if (!figures.crossings_skipped.empty()) {
    lines.add("", "triangles that cut others not counted: " + figures.crossings_skipped);
  }
}

}  // namespace meshfarm
