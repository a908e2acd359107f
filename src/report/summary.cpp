// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <meshfarm/io/map_names.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

#include "report/summary_words.hpp"

namespace meshfarm {
namespace {

Json better_json(const RunSummary& s) {
  if (!s.better) return nullptr;
  return {{"triangles", s.better->triangles},
          {"error", to_json(s.better->error, s.manifest.box.diagonal())}};
}

Json input_json(const Manifest& m) {
  return {
      {"path", m.input},
      {"format", m.input_format},
      {"vertices", m.input_vertices},
      {"triangles", m.input_triangles},
      {"near_merges", {{"distance", m.near_merges.distance}, {"vertices", m.near_merges.vertices}}},
      {"coincident_vertices", m.coincident_vertices},
      {"channels", names_of(m.channels.channels)},
      {"labels", to_json(m.labels)},
      {"texture_coordinates", m.uvs},
      {"skipped", m.skipped}};
}

Json finish_json(const RunSummary& s) {
  Json pieces = Json::array();
  for (const ErrorOfPiece& each : s.pieces) {
    const double diagonal = s.manifest.box.diagonal();
    Json json = {{"first_part", each.first_part},
                 {"parts", each.parts},
                 {"triangles", each.triangles},
                 {"input_to_output", to_json(each.to_output, diagonal)},
                 {"output_to_input", to_json(each.to_input, diagonal)}};
    add_quantiles(each.to_output_quantiles, diagonal, json["input_to_output"]);
    add_quantiles(each.to_input_quantiles, diagonal, json["output_to_input"]);
    pieces.push_back(std::move(json));
  }
  return {{"by", s.finished_in_pieces > 0 ? "farm" : "sink"},
          {"why_here", s.why_finished_here},
          {"pieces", std::move(pieces)}};
}

/// The mode may allow changes although nothing changed.
bool is_kept(const RunSummary& s) {
  if (!s.topology) return !s.topology_simplified;
  const auto& [before, after, gone] = *s.topology;
  return before.components == after.components && before.euler == after.euler &&
         (before.border_edges == 0) == (after.border_edges == 0);
}

Json topology_json(const Topology& t) {
  const auto handles = handles_of(t);
  return {{"components", t.components},
          {"euler", t.euler},
          {"handles", handles ? Json(*handles) : Json(nullptr)},
          {"closed", t.border_edges + t.nonmanifold_edges == 0},
          {"border_edges", t.border_edges},
          {"nonmanifold_edges", t.nonmanifold_edges}};
}

/// The topology of the input after the parts have simplified it: whether there are borders is
/// preserved, but not their number of edges, and edges of more than two triangles are split where
/// possible.
Json input_topology_json(const Topology& cleaned) {
  Json json = topology_json(cleaned);
  if (cleaned.border_edges > 0) json["border_edges"] = nullptr;
  json["nonmanifold_edges"] = nullptr;
  return json;
}

Json topology_json(const RunSummary& s) {
  if (!s.topology) return nullptr;
  const auto& [before, after, gone] = *s.topology;
  return {{"input", input_topology_json(before)},
          {"output", topology_json(after)},
          {"pieces_gone", gone.components},
          {"area_gone", gone.area},
          {"area_of_all", gone.area_of_all}};
}

Json channels_json(const RunSummary& s) {
  Json json = Json::array();
  for (const ChannelError& channel : s.channels) {
    json.push_back({{"name", channel.name}, {"rms", channel.rms}});
  }
  return json;
}

std::string text_of_topology(const RunSummary& s) {
  const std::string advice = "; --topology keep keeps them";
  if (!s.topology) return "handles, holes or pieces were closed or removed" + advice;
  const auto& [before, after, gone] = *s.topology;
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
  if (gone.components > 0) {
    add(grouped(gone.components) + " of " + grouped(before.components) + " pieces removed (" +
        number(100 * gone.area / gone.area_of_all, "%.2g") + " % of the area)");
  }
  const std::uint64_t left = before.components - gone.components;
  if (after.components > left) {
    add(grouped(after.components - left) + " pieces pinched off");
  }
  const auto handles = handles_of(before);
  const auto handles_left = handles_of(after);
  if (handles && handles_left && *handles != *handles_left) {
    add("handles from " + grouped(static_cast<std::uint64_t>(*handles)) + " to " +
        grouped(static_cast<std::uint64_t>(*handles_left)));
  } else if (!handles || !handles_left) {
    add("holes and handles simplified: Euler characteristic from " + std::to_string(before.euler) +
        " to " + std::to_string(after.euler));
  }
  if (before.border_edges == 0 && after.border_edges > 0) add("small pieces opened into sheets");
  return text + advice;
}

const char* scheme_name(const Manifest& m) {
  return m.scheme == Scheme::stream ? "stream" : "cut";
}

const char* parts_name(const Manifest& m) {
  if (m.sorting) return "slabs to be sorted";
  return m.scheme == Scheme::stream ? "streams" : "parts";
}

void add_input(Lines& lines, const Manifest& m) {
  lines.add("input", m.input + " (" + m.input_format + ")");
  lines.add("",
            grouped(m.input_triangles) + " triangles, " + grouped(m.input_vertices) + " vertices" +
                (m.coincident_vertices != 0 ? ", " + grouped(m.coincident_vertices) + " coincident"
                                            : ""));
  if (m.near_merges.vertices > 0) {
    lines.add("", grouped(m.near_merges.vertices) + " moved onto others up to " +
                      number(m.near_merges.distance, "%.3g") + " away");
  }
  if (!m.skipped.empty()) lines.add("not kept", joined(m.skipped));
  if (m.dropped_not_finite > 0) {
    lines.add("dropped",
              grouped(m.dropped_not_finite) + " triangles with positions that are not finite");
  }
}

std::string bound_text(const RunSummary& s) {
  const double diagonal = s.manifest.box.diagonal();
  if (s.certified_error > 0) {
    return "certified: no point of either surface is farther from the other than " +
           number(s.certified_error / diagonal, "%.6g") + " of the diagonal";
  }
  return "sampled, not certified: " + number(s.max_error / diagonal, "%.6g") + " of the diagonal";
}

/// The maximum distance: proven, or only from samples.
Json bound_json(const RunSummary& s) {
  const double diagonal = s.manifest.box.diagonal();
  if (s.certified_error > 0) {
    return {{"kind", "certified"}, {"max", s.certified_error / diagonal}};
  }
  if (s.error.input_samples == 0) return nullptr;
  return {{"kind", "sampled"}, {"max", s.error.greater().max / diagonal}};
}

void add_error(Lines& lines, const MeasuredError& error, double diagonal) {
  lines.add("error", text_of(error.greater(), diagonal) +
                         "  of the diagonal, the greater of both directions");
  lines.add("", text_of(error.to_output, diagonal) + "  from " + grouped(error.input_samples) +
                    " points of the input to the output");
  lines.add("", text_of(error.to_input, diagonal) + "  from " + grouped(error.output_samples) +
                    " points of the output to the input");
  if (error.to_output_normals) {
    lines.add("", "facing: " + text_of(*error.to_output_normals) + ", from " +
                      grouped(error.normal_samples) + " points of the input");
  }
}

/// Kinds of pictures that the result's textures no longer have.
std::vector<std::string> maps_lost(const RunSummary& s) {
  using Way = TexturesMade::Way;
  if (!s.manifest.labels) return {};
  if (s.textures.way != Way::kept && s.textures.way != Way::baked) return {};
  return maps_left_out(*s.manifest.labels, [&](MapUse use) {
    return s.textures.way == Way::kept ? keeps_map(s.output, use) : use == MapUse::colour;
  });
}

Json textures_json(const RunSummary& s) {
  Json json = to_json(s.textures);
  if (json.is_object()) json["pictures_not_kept"] = maps_lost(s);
  return json;
}

void add_channels(Lines& lines, const RunSummary& s) {
  std::string kept;
  for (const ChannelError& channel : s.channels) {
    kept += (kept.empty() ? "" : ", ") + channel.name + " " + number(channel.rms, "%.3g");
  }
  if (!kept.empty()) lines.add("channels", kept + "  RMS from the input's vertices");
  if (s.labels) lines.add("labels", text_of(*s.labels));
  if (s.textures.way != TexturesMade::Way::none) lines.add("textures", text_of(s.textures));
  const bool is_baked = s.textures.way == TexturesMade::Way::baked;
  std::vector<std::string> lost = names_of(s.manifest.channels.channels);
  if (s.labels_too_fine) {
    const std::string& name = s.manifest.labels->name;
    lines.add("not kept", name + ": its lines hold about " + grouped(s.manifest.label_corners) +
                              " vertices in place; --attributes " + name + " keeps it");
  } else if (s.manifest.labels && !s.labels && !is_baked) {
    lost.push_back(s.manifest.labels->name);
  }
  if (s.labels && s.labels->materials != s.manifest.labels->materials) {
    lost.push_back("names and colours of " + s.labels->name + "s");
  }
  const std::vector<std::string> maps = maps_lost(s);
  if (is_baked && !maps.empty()) {
    lines.add("not kept", joined(maps) + ": only colours are made anew");
  } else {
    lost.insert(lost.end(), maps.begin(), maps.end());
  }
  std::erase_if(lost, [&](const std::string& name) {
    return std::any_of(s.channels.begin(), s.channels.end(),
                       [&](const ChannelError& channel) { return channel.name == name; });
  });
  const std::vector<std::string>& not_wanted = s.channels_not_wanted;
  std::erase_if(lost, [&](const std::string& name) {
    return std::find(not_wanted.begin(), not_wanted.end(), name) != not_wanted.end();
  });
  if (!not_wanted.empty()) lines.add("not kept", joined(not_wanted) + ": not asked for");
  if (!lost.empty()) {
    lines.add("not kept", joined(lost) + ": the output's format has no place for them");
  }
}

Json run_json(const RunSummary& s, const std::string& warning) {
  const Manifest& m = s.manifest;
  return {
      {"run", to_hex(s.run)},
      {"epoch", s.epoch},
      {"input", input_json(m)},
      {"output", {{"path", s.output}, {"triangles", s.triangles}, {"vertices", s.vertices}}},
      {"target", s.target},
      {"max_error", s.max_error > 0 ? Json(s.max_error / m.box.diagonal()) : Json(nullptr)},
      {"bound", bound_json(s)},
      {"exact", s.why_not_exact.empty()},
      {"why_not_exact", s.why_not_exact},
      {"topology", is_kept(s) ? "kept" : "simplified"},
      {"topology_change", topology_json(s)},
      {"turned", s.turned},
      {"error", s.error.input_samples == 0 ? Json(nullptr) : to_json(s.error, m.box.diagonal())},
      {"surface", s.result ? to_json(*s.result) : Json(nullptr)},
      {"facing_away",
       s.facing ? Json{{"found", s.facing->found}, {"mended", s.facing->mended}} : Json(nullptr)},
      {"channels", channels_json(s)},
      {"labels", to_json(s.labels)},
      {"textures", textures_json(s)},
      {"warning", warning.empty() ? Json(nullptr) : Json(warning)},
      {"better", better_json(s)},
      {"dropped",
       {{"degenerate", s.dropped_degenerate},
        {"duplicate", s.dropped_duplicate},
        {"not_finite", m.dropped_not_finite},
        {"components", s.dropped_components.components}}},
      {"scheme", scheme_name(m)},
      {"parts", m.parts.size()},
      {"boundary_triangles", m.boundary_triangles},
      {"stitched_triangles", s.stitched},
      {"fitted_vertices", s.fitted_vertices},
      {"finish", finish_json(s)},
      {"seconds",
       {{"cut", m.cut_seconds},
        {"farm", s.farm_seconds},
        {"stitch", s.stitch_seconds},
        {"finish", s.finish_seconds},
        {"measure", s.measure_seconds},
        {"write", s.write_seconds}}}};
}

std::string run_text(const RunSummary& s, const std::string& warning) {
  const Manifest& m = s.manifest;
  Lines lines;
  add_input(lines, m);
  if (s.dropped_degenerate + s.dropped_duplicate > 0) {
    lines.add("dropped", grouped(s.dropped_degenerate) + " degenerate and " +
                             grouped(s.dropped_duplicate) + " duplicate triangles");
  }
  if (s.turned > 0) {
    lines.add("turned", grouped(s.turned) + " triangles that faced another way than their piece");
  }
  if (s.dropped_components.components > 0) {
    lines.add("dropped", grouped(s.dropped_components.components) + " small components");
  }
  lines.add("output", s.output);
  lines.add("", grouped(s.triangles) + " triangles, " + grouped(s.vertices) + " vertices");
  if (!is_kept(s)) lines.add("", text_of_topology(s));
  if (!s.why_not_exact.empty() && s.triangles <= s.target) {
    lines.add("", grouped(s.target) + " were asked for: " + s.why_not_exact);
  }
  if (s.error.input_samples > 0) add_error(lines, s.error, m.box.diagonal());
  if (s.result) add_figures(lines, "surface", *s.result);
  if (s.facing && s.facing->found > 0) {
    lines.add("", grouped(s.facing->found) + " triangles faced away from the input, " +
                      grouped(s.facing->mended) + " of them mended");
  }
  if (s.max_error > 0) lines.add("bound", bound_text(s));
  add_channels(lines, s);
  if (!warning.empty()) lines.add("warning", warning);
  lines.add(parts_name(m), grouped(m.parts.size()) + ", stitched to " + grouped(s.stitched) +
                               " triangles before the finish");
  if (s.finished_in_pieces > 0) {
    lines.add("finish", "by jobs, in " + grouped(s.finished_in_pieces) +
                            (s.finished_in_pieces == 1 ? " piece" : " pieces"));
  } else if (!s.why_finished_here.empty()) {
    lines.add("finish", "by the sink: " + s.why_finished_here);
  }
  lines.add("time", std::string(scheme_name(m)) + " " + number(m.cut_seconds, "%.2f s") +
                        ", farm " + number(s.farm_seconds, "%.2f s") + ", stitch " +
                        number(s.stitch_seconds, "%.2f s") + ", finish " +
                        number(s.finish_seconds, "%.2f s") + ", measure " +
                        number(s.measure_seconds, "%.2f s") + ", write " +
                        number(s.write_seconds, "%.2f s"));
  return lines.text();
}

}  // namespace

std::string render(const Manifest& m, const std::string& stage, Format format) {
  if (format == Format::json) {
    const Json json = {{"stage", stage},
                       {"input", input_json(m)},
                       {"scheme", scheme_name(m)},
                       {"partitioner", m.partitioner},
                       {"parts", m.parts.size()},
                       {"cut", !m.cutting.has_value()},
                       {"sorted", !m.sorting.has_value()},
                       {"boundary_triangles", m.boundary_triangles},
                       {"dropped",
                        {{"degenerate", m.coincident_corners},
                         {"duplicate", m.dropped_duplicate},
                         {"not_finite", m.dropped_not_finite}}},
                       {"seconds", m.cut_seconds}};
    return dumped(json);
  }
  Lines lines;
  add_input(lines, m);
  lines.add("stage",
            stage + (m.cutting ? ": to be cut into " + grouped(m.cutting->parts) +
                                     " parts by the first jobs of a run"
                               : ": " + grouped(m.parts.size()) + " " + parts_name(m) + ", " +
                                     grouped(m.boundary_triangles) + " boundary triangles"));
  lines.add("time", number(m.cut_seconds, "%.2f s"));
  return lines.text();
}

std::string render(const RunSummary& s, Format format) {
  const std::string warning = warning_of(s);
  return format == Format::json ? dumped(run_json(s, warning)) : run_text(s, warning);
}

std::string warning_of(const RunSummary& s) {
  if (s.triangles == 0) return "the result has no triangles";
  std::string warning;
  if (s.triangles > s.target && !s.why_not_exact.empty()) {
    warning = grouped(s.target) + " triangles were asked for, " + grouped(s.triangles) +
              " are left: " + s.why_not_exact;
  }
  const double greatest = s.error.greater().max;
  const double bound = std::max(s.max_error, s.certified_error);
  if (bound > 0 && s.error.input_samples > 0 && greatest > bound) {
    const double diagonal = s.manifest.box.diagonal();
    warning += (warning.empty() ? "" : "; ") + std::string("the bound of ") +
               number(bound / diagonal, "%.3g") +
               " is not kept everywhere: " + number(greatest / diagonal, "%.6g") +
               " at a sampled point";
    // Not possible with --drop-components.
    const bool may_certify = !(s.certified_error > 0) && s.dropped_components.components == 0;
    if (may_certify) warning += "; --certify would keep it";
  }
  if (!s.better) return warning;
  const auto rms = [&](const MeasuredError& error) {
    return number(error.greater().rms / s.manifest.box.diagonal(), "%.2g");
  };
  return warning + (warning.empty() ? "" : "; ") + grouped(s.triangles) +
         " triangles cost an error of " + rms(s.error) + "; " + grouped(s.better->triangles) +
         " would have " + rms(s.better->error);
}

RunTimes parse_run_times(std::string_view text, std::string_view what) {
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) throw DataError(std::string(what) + ": is no JSON");
  return run_times_of(json, what);
}

RunTimes run_times_of(const Json& summary, std::string_view what) {
  try {
    const Json& seconds = summary.at("seconds");
    const Json& triangles = summary.at("output").at("triangles");
    if (!triangles.is_number_unsigned()) throw DataError("its triangles are no count");
    const auto at = [&](const char* name) { return seconds.at(name).get<double>(); };
    return {std::stoull(summary.at("run").get<std::string>(), nullptr, 16),
            summary.value("epoch", std::uint32_t{0}),
            triangles.get<std::uint64_t>(),
            at("cut"),
            at("farm"),
            at("stitch"),
            at("finish"),
            at("measure"),
            at("write")};
  } catch (const std::exception& error) {
    throw DataError(std::string(what) + ": no summary of a run: " + error.what());
  }
}

}  // namespace meshfarm
