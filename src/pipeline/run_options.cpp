// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <meshfarm/pipeline/algorithm.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/finished_pieces.hpp>
#include <meshfarm/pipeline/run_options.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// At the default weight sharp colour edges cost the shape up to a third of its error. Greater
/// weights are for users to whom colours matter more than that: they keep such edges as well.
double steepest_of(double colour_weight) {
  const double relative = colour_weight / RunOptions{}.colour_weight;
  return AppearanceScale{}.steepest * relative * std::sqrt(relative);
}

bool has_pictures(const LabelMeaning& labels) {
  return std::any_of(labels.materials.begin(), labels.materials.end(),
                     [](const Material& material) { return !material.maps.empty(); });
}

/// Whether there is anything that a new picture could show.
bool has_colour_pictures(const Manifest& manifest) {
  if (!manifest.labels) return false;
  const std::vector<Material>& materials = manifest.labels->materials;
  return std::any_of(materials.begin(), materials.end(), [](const Material& material) {
    return std::any_of(material.maps.begin(), material.maps.end(),
                       [](const MaterialMap& map) { return map.use == MapUse::colour; });
  });
}

constexpr std::uint8_t k_border = 1;     // is preserved
constexpr std::uint8_t k_crossings = 2;  // are avoided

// Columns that the lines keep.
constexpr std::uint8_t k_labels = 1;
constexpr std::uint8_t k_uvs = 2;

}  // namespace

std::uint64_t asked_triangles(const Manifest& manifest, const RunOptions& options) {
  if (options.triangles != 0) return options.triangles;
  if (options.error.value > 0) return 0;  // as few as the error allows
  if (!(options.ratio > 0 && options.ratio <= 1)) {
    throw UsageError(
        "give the size of the result: --ratio above 0 and up to 1, --triangles, or --error");
  }
  // A ratio of the proper triangles of the input: the same number however the mesh is divided.
  const std::uint64_t left_out =
      std::min(manifest.input_triangles, manifest.dropped_not_finite + manifest.coincident_corners);
  const double wanted = options.ratio * static_cast<double>(manifest.input_triangles - left_out);
  return static_cast<std::uint64_t>(std::llround(wanted));
}

std::uint64_t target_triangles(const Manifest& manifest, const RunOptions& options) {
  const std::uint64_t asked = asked_triangles(manifest, options);
  const bool keeps = options.textures == TextureMode::keep && chooses_uvs(options.channels);
  return keeps && manifest.uvs && asked > 0 ? std::max(asked, texture_floor(manifest)) : asked;
}

std::vector<std::size_t> chosen_columns(const Manifest& manifest, const RunOptions& options) {
  const std::vector<Channel>& channels = manifest.channels.channels;
  std::vector<std::size_t> columns = chosen_columns(options.channels, channels, manifest.labels);
  if (options.normals == Normals::drop) {
    std::erase_if(columns, [&](std::size_t i) { return channels[i].role == ChannelRole::normal; });
  }
  return columns;
}

bool are_labels_too_fine(const Manifest& manifest, const RunOptions& options) {
  // A closed surface has twice as many triangles as vertices. The labels are too fine if they pin
  // more than a third of the result's vertices.
  constexpr std::uint64_t k_triangles_per_corner = 6;
  if (!manifest.labels || !options.channels.all || options.error.value > 0) return false;
  return k_triangles_per_corner * manifest.label_corners > target_triangles(manifest, options);
}

std::optional<LabelMeaning> chosen_labels(const Manifest& manifest, const RunOptions& options) {
  if (!manifest.labels) return std::nullopt;
  const TextureMode textures = chosen_textures(manifest, options);
  if (has_pictures(*manifest.labels)) {
    if (textures == TextureMode::keep) return manifest.labels;
    if (textures == TextureMode::bake) return std::nullopt;  // one picture has all their colours
  }
  if (!chooses_labels(options.channels, *manifest.labels)) return std::nullopt;
  if (are_labels_too_fine(manifest, options)) return std::nullopt;
  return manifest.labels;
}

std::uint64_t texture_floor(const Manifest& manifest) {
  return told_uv_floor(manifest.uv_floor);
}

TextureMode chosen_textures(const Manifest& manifest, const RunOptions& options) {
  if (!manifest.uvs || !chooses_uvs(options.channels)) return TextureMode::drop;
  TextureMode chosen = options.textures;
  if (chosen == TextureMode::automatic) {
    const bool is_met =
        options.error.value > 0 || texture_floor(manifest) <= asked_triangles(manifest, options);
    chosen = is_met ? TextureMode::keep : TextureMode::bake;
  }
  const bool bakes_nothing = chosen == TextureMode::bake && !has_colour_pictures(manifest);
  return bakes_nothing ? TextureMode::drop : chosen;
}

LineOptions lines_of(const Manifest& manifest, const RunOptions& options) {
  LineOptions lines = options.lines;
  lines.columns.labels = chosen_labels(manifest, options).has_value();
  lines.columns.uvs = chosen_textures(manifest, options) == TextureMode::keep;
  if (lines.columns.uvs) lines.uv_scale = options.uv_weight * manifest.uv_side;
  const double length = options.colour_weight * manifest.box.diagonal();
  const std::vector<Channel> chosen =
      channels_at(manifest.channels.channels, chosen_columns(manifest, options));
  const bool has_colours = !AppearanceColumns(chosen).empty();
  if (!has_colours || !(length > 0 && std::isfinite(length))) return lines;
  lines.appearance_scale.length = length;
  lines.appearance_scale.steepest = steepest_of(options.colour_weight);
  return lines;
}

VertexFitOptions fit_options(const LineOptions& lines, PositionType positions,
                             std::uint32_t locked_vertices, unsigned threads) {
  return {.positions = positions,
          .locked_vertices = locked_vertices,
          .keeps_borders = lines.preserve_border,
          .crease_angle = lines.crease_angle,
          .threads = threads};
}

std::uint64_t memory_of_channels(const LineOptions& lines, std::uint64_t triangles) {
  constexpr std::uint64_t k_copies = 4;
  const std::uint64_t of_vertices =
      lines.appearance_scale.length > 0 ? k_copies * sizeof(Appearance) / 2 : 0;
  // Also those at the corners of the triangles.
  const std::uint64_t of_triangles = (k_copies + 3) * lines.columns.bytes();
  return (of_vertices + of_triangles) * triangles;
}

void put(ByteWriter& out, const LineOptions& lines) {
  out.put(static_cast<std::uint8_t>((lines.preserve_border ? k_border : 0) |
                                    (lines.crossings == CrossingMode::avoid ? k_crossings : 0)));
  out.put(lines.crease_angle);
  out.put(lines.topology);
  out.put(lines.appearance_scale.length);
  out.put(lines.appearance_scale.steepest);
  out.put(static_cast<std::uint8_t>((lines.columns.labels ? k_labels : 0) |
                                    (lines.columns.uvs ? k_uvs : 0)));
  if (lines.columns.uvs) out.put(lines.uv_scale);
}

LineOptions get_lines(ByteReader& in) {
  LineOptions lines;
  const auto kept = in.get<std::uint8_t>();
  if (kept > (k_border | k_crossings)) in.fail("impossible options of borders and crossings");
  lines.preserve_border = (kept & k_border) != 0;
  lines.crossings = (kept & k_crossings) != 0 ? CrossingMode::avoid : CrossingMode::allow;
  lines.crease_angle = in.get<double>();
  if (!(lines.crease_angle >= 0 && lines.crease_angle < 180)) in.fail("impossible crease angle");
  lines.topology = in.get<TopologyMode>();
  if (lines.topology > TopologyMode::keep_while_fair) in.fail("unknown way with the topology");
  AppearanceScale& scale = lines.appearance_scale;
  scale.length = in.get<double>();
  scale.steepest = in.get<double>();
  const auto is_weight = [](double x) { return x >= 0 && std::isfinite(x); };
  if (!is_weight(scale.length) || !is_weight(scale.steepest)) {
    in.fail("impossible weight of appearances");
  }
  const auto columns = in.get<std::uint8_t>();
  if (columns > (k_labels | k_uvs)) in.fail("impossible columns of triangles");
  lines.columns = {(columns & k_labels) != 0, (columns & k_uvs) != 0};
  if (lines.columns.uvs) lines.uv_scale = in.get<double>();
  if (!is_weight(lines.uv_scale)) in.fail("impossible weight of texture coordinates");
  return lines;
}

std::uint64_t run_key(const Manifest& manifest, const RunOptions& options) {
  ByteWriter out;
  out.put(k_algorithm_version);
  out.put(checksum(encode_manifest(manifest)));
  // A ratio and a count that give the same number are the same run, if nothing of the input was
  // left out. But not if slabs are still to be sorted or parts to be cut: degenerate triangles are
  // dropped then, and the ratio applies to what is left.
  out.put(target_triangles(manifest, options));
  if (manifest.sorting || manifest.cutting) out.put(options.ratio);
  out.put(options.allocation);
  out.put(options.finish);
  out.put(options.composition);
  out.put(sample_counts(manifest, options).fitting);
  put(out, lines_of(manifest, options));
  out.put(options.drop_components.in(manifest.box));
  out.put(options.error.in(manifest.box));
  // Only included if something is to be proven, so that other keys are those of older versions.
  if (options.certify) out.put(std::uint8_t{1});
  // Only included if some are not kept unchanged, so that other keys are those of older versions.
  if (!options.channels.all || options.normals != Normals::blend) {
    out.put(options.normals);
    for (const std::size_t column : chosen_columns(manifest, options)) {
      out.put(static_cast<std::uint64_t>(column));
    }
  }
  if (manifest.uvs) {
    out.put(chosen_textures(manifest, options));
    out.put(options.texture_size);
  }
  // Older versions had only one way to finish.
  if (why_finish_here(manifest, options).empty()) out.put(FinishPlace::farm);
  const std::uint64_t key = checksum(out.bytes());
  return key == 0 ? 1 : key;  // 0 means "any run" to the farm
}

}  // namespace meshfarm
