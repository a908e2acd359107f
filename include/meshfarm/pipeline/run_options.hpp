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

/// How the parts' triangles are shared out.
enum class Allocation : std::uint8_t {
  threshold,  // one cost threshold for all parts: flat parts end with fewer triangles
  uniform,    // the same ratio in every part (Xiong et al. 2008)
};

/// What the last pass over the stitched mesh may touch.
enum class Finish : std::uint8_t {
  global,    // everything, down to the exact count
  boundary,  // edges at boundary vertices only (Xiong et al. 2008, 3.3)
};

/// Who does the last pass, measures and knows the whole result.
enum class FinishPlace : std::uint8_t {
  automatic,  // the farm where the result is too large for one process to hold well
  here,       // the sink
  farm,       // jobs, each with a piece of the result, where the options have a way for it
};

/// How swept streams become one mesh.
enum class Composition : std::uint8_t {
  automatic,  // as a tree where that is worth its jobs
  tree,       // neighbours are joined by jobs of the farm first
  sink,       // the sink joins all
};

/// Whether the vertices of the result move to where it is nearer to the input (vertex_fit.hpp).
enum class VertexFit : std::uint8_t {
  automatic,  // where that takes little of the time
  on,
  off,
};

/// What becomes of the input's normals.
enum class Normals : std::uint8_t {
  blend,      // fitted to the input's, as other channels are
  recompute,  // those of the result's triangles, on the side that the input's are on
  drop,
};

/// What becomes of the stage's texture coordinates and pictures.
enum class TextureMode : std::uint8_t {
  automatic,  // kept if the number of triangles can be met so, else baked
  keep,       // charts stay: vertices on their borders merge along them only
  bake,       // a new picture, with new texture coordinates
  drop,
};

/// A length in the mesh's unit, or as a fraction of the diagonal of its bounding box.
struct Length {
  double value = 0;
  bool of_diagonal = false;
  double in(const Box& box) const { return of_diagonal ? value * box.diagonal() : value; }
};

/// RunOptions::colour_weight, where none is asked for.
inline constexpr double k_colour_weight = 0.002;
/// RunOptions::uv_weight, where none is asked for. On a torus of 4,000 triangles the 99th
/// percentile of the texture coordinates' error fell to a fifth for 1 % more RMS; with three times
/// as much, to an eighth for 6 %.
inline constexpr double k_uv_weight = 0.1;

/// What a run is asked to make of a stage.
struct RunOptions {
  double ratio = 0;  // of the input's triangles; used when triangles is 0
  std::uint64_t triangles = 0;
  Length error;  // where above 0: as few triangles as keep this distance
  /// Whether that is proven of every point of both surfaces, not only measured.
  bool certify = false;
  Allocation allocation = Allocation::threshold;
  Finish finish = Finish::global;
  FinishPlace finish_place = FinishPlace::automatic;
  Composition composition = Composition::automatic;
  VertexFit fit = VertexFit::automatic;
  LineOptions lines;
  Length drop_components;  // components with a smaller diagonal are left out
  /// Black for white is as bad as a move of the surface by this share of the bounding box's
  /// diagonal. 0: colours do not count.
  double colour_weight = k_colour_weight;
  /// Where textures are kept: to show what is a length away on them is as bad as a move of the
  /// surface by this share of it. 0: it does not count.
  double uv_weight = k_uv_weight;
  ChannelChoice channels;  // of those that the stage has
  Normals normals = Normals::blend;
  TextureMode textures = TextureMode::automatic;
  std::uint32_t texture_size = 0;  // of a new picture, in pixels; 0: by the input's pictures
};

/// The number of triangles that is asked for. Throws UsageError if the options name neither a ratio
/// in (0, 1] nor a count.
std::uint64_t asked_triangles(const Manifest& manifest, const RunOptions& options);

/// The number that the result shall have: more than is asked for where it shall keep textures and
/// these need more. To go below would take what is left beside them at any cost. Throws as above.
std::uint64_t target_triangles(const Manifest& manifest, const RunOptions& options);

/// Which of the stage's channels the result is to have. Throws UsageError as io's chosen_columns().
std::vector<std::size_t> chosen_columns(const Manifest& manifest, const RunOptions& options);

/// Whether the stage's labels hold so many vertices where they are that the number of triangles
/// would not be met, or only at their cost. They are dropped then, unless they are asked for by
/// name, or the error is what is given.
bool are_labels_too_fine(const Manifest& manifest, const RunOptions& options);

/// The stage's labels, if the result is to have them.
std::optional<LabelMeaning> chosen_labels(const Manifest& manifest, const RunOptions& options);

/// What the stage's texture coordinates are to become: any but automatic; drop where it has none.
TextureMode chosen_textures(const Manifest& manifest, const RunOptions& options);

/// About as few triangles as a result has that keeps the stage's texture coordinates.
std::uint64_t texture_floor(const Manifest& manifest);

/// The run's lines, and how much the colours and labels of the stage count: none do if none is
/// chosen.
LineOptions lines_of(const Manifest& manifest, const RunOptions& options);

/// How the vertices of a result with these lines are fitted.
VertexFitOptions fit_options(const LineOptions& lines, PositionType positions,
                             std::uint32_t locked_vertices, unsigned threads);

/// What appearances and labels add to the memory of a job on so many triangles: four copies at
/// most.
std::uint64_t memory_of_channels(const LineOptions& lines, std::uint64_t triangles);

/// As they stand in a job's parameters: u8: 1 preserve border, 2 avoid crossings | crease angle f64
/// | topology u8 | length of appearances f64 | steepest f64 | columns u8: 1 labels, 2 texture
/// coordinates; with these their weight f64.
void put(ByteWriter& out, const LineOptions& lines);
LineOptions get_lines(ByteReader& in);

/// Tells one run from another on the same stage.
std::uint64_t run_key(const Manifest& manifest, const RunOptions& options);

}  // namespace meshfarm
