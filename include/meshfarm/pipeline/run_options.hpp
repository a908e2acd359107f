// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/geometry/vertex_fit.hpp>
#include <meshfarm/io/channel_choice.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/util/bytes.hpp>

namespace meshfarm {

/// How the triangles are distributed over the parts.
enum class Allocation : std::uint8_t {
  threshold,  // one cost threshold for all parts: flat parts end with fewer triangles
  uniform,    // the same ratio in every part (Xiong et al. 2008)
};

/// What the last pass over the stitched mesh may touch.
enum class Finish : std::uint8_t {
  global,    // everything, down to the exact count
  boundary,  // edges at boundary vertices only (Xiong et al. 2008, 3.3)
};

/// Who does the last pass, measures and holds the whole result.
enum class FinishPlace : std::uint8_t {
  automatic,  // the farm if the result is too large for one process to hold well
  here,       // the sink
  farm,       // jobs, each with a piece of the result, if the options allow it
};

/// How swept streams become one mesh.
enum class Composition : std::uint8_t {
  automatic,  // as a tree if that is worth its jobs
  tree,       // jobs of the farm join neighbours first
  sink,       // the sink joins all
};

/// Whether the vertices of the result are moved closer to the input (vertex_fit.hpp).
enum class VertexFit : std::uint8_t {
  automatic,  // if that takes little of the time
  on,
  off,
};

/// What to do with the input's normals.
enum class Normals : std::uint8_t {
  blend,      // fitted to the input's, like other channels
  recompute,  // those of the result's triangles, on the side of the input's normals
  drop,
};

/// What to do with the stage's texture coordinates and pictures.
enum class TextureMode : std::uint8_t {
  automatic,  // kept if the number of triangles can be reached that way, else baked
  keep,       // charts stay: vertices on their borders merge only along them
  bake,       // a new picture, with new texture coordinates
  drop,
};

/// A length in the mesh's unit, or as a fraction of the diagonal of its bounding box.
struct Length {
  double value = 0;
  bool of_diagonal = false;
  double in(const Box& box) const { return of_diagonal ? value * box.diagonal() : value; }
};

/// Default of RunOptions::colour_weight.
inline constexpr double k_colour_weight = 0.002;
/// Default of RunOptions::uv_weight. On a torus of 4,000 triangles the 99th percentile of the
/// texture coordinates' error fell to a fifth for 1 % more RMS; with three times the weight, to an
/// eighth for 6 %.
inline constexpr double k_uv_weight = 0.1;

/// What a run is asked to make from a stage.
struct RunOptions {
  double ratio = 0;  // of the input's triangles; used when triangles is 0
  std::uint64_t triangles = 0;
  Length error;  // where above 0: as few triangles as possible within this distance
  /// Whether that is proven for every point of both surfaces, not only measured.
  bool certify = false;
  Allocation allocation = Allocation::threshold;
  Finish finish = Finish::global;
  FinishPlace finish_place = FinishPlace::automatic;
  Composition composition = Composition::automatic;
  VertexFit fit = VertexFit::automatic;
  LineOptions lines;
  Length drop_components;  // components with a smaller diagonal are left out
  /// Black instead of white is as bad as moving the surface by this share of the bounding box's
  /// diagonal. 0: colours do not count.
  double colour_weight = k_colour_weight;
  /// If textures are kept: an offset on the texture that is a length on the surface is as bad as
  /// moving the surface by this share of the length. 0: it does not count.
  double uv_weight = k_uv_weight;
  ChannelChoice channels;  // of those that the stage has
  Normals normals = Normals::blend;
  TextureMode textures = TextureMode::automatic;
  std::uint32_t texture_size = 0;  // of a new picture, in pixels; 0: by the input's pictures
};

/// The number of triangles asked for. Throws UsageError if the options give neither a ratio in (0,
/// 1] nor a count.
std::uint64_t asked_triangles(const Manifest& manifest, const RunOptions& options);

/// The number of triangles for the result: more than asked for if it keeps textures and these need
/// more. Below that, whatever is left beside them would be removed at any cost. Throws as above.
std::uint64_t target_triangles(const Manifest& manifest, const RunOptions& options);

/// Which of the stage's channels the result is to have. Throws UsageError as io's chosen_columns().
std::vector<std::size_t> chosen_columns(const Manifest& manifest, const RunOptions& options);

/// Whether the stage's labels pin so many vertices that the number of triangles could not be
/// reached, or only by giving the labels up. They are dropped then, unless they are asked for by
/// name, or an error is given instead of a number.
bool are_labels_too_fine(const Manifest& manifest, const RunOptions& options);

/// The stage's labels, if the result is to have them.
std::optional<LabelMeaning> chosen_labels(const Manifest& manifest, const RunOptions& options);

/// What to do with the stage's texture coordinates: never automatic; drop if it has none.
TextureMode chosen_textures(const Manifest& manifest, const RunOptions& options);

/// About the smallest number of triangles of a result that keeps the stage's texture coordinates.
std::uint64_t texture_floor(const Manifest& manifest);

/// The run's lines, with the weights of the stage's colours and labels: 0 if none are chosen.
LineOptions lines_of(const Manifest& manifest, const RunOptions& options);

/// How the vertices of a result with these lines are fitted.
VertexFitOptions fit_options(const LineOptions& lines, PositionType positions,
                             std::uint32_t locked_vertices, unsigned threads);

/// How much memory appearances and labels add to a job on this many triangles: at most four copies.
std::uint64_t memory_of_channels(const LineOptions& lines, std::uint64_t triangles);

/// Encoding in a job's parameters: u8: 1 preserve border, 2 avoid crossings | crease angle f64 |
/// topology u8 | length of appearances f64 | steepest f64 | columns u8: 1 labels, 2 texture
/// coordinates; with these their weight f64.
void put(ByteWriter& out, const LineOptions& lines);
LineOptions get_lines(ByteReader& in);

/// Distinguishes runs on the same stage.
std::uint64_t run_key(const Manifest& manifest, const RunOptions& options);

}  // namespace meshfarm
