// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/staged_picture.hpp"

#include <atomic>
#include <cmath>
#include <mutex>

#include <meshfarm/pipeline/input_surface.hpp>
#include <meshfarm/render/surface_picture.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/errors.hpp>

#include "cli/input_framing.hpp"

namespace meshfarm {
namespace {

/// Tracks how much of the input was shown.
class Shown {
 public:
  Shown(const RenderOptions& options, std::uint64_t triangles)
      : options_(options), all_(static_cast<double>(triangles + 1)) {}
  void add(std::string_view phase, std::uint64_t triangles) {
    const std::lock_guard lock(mutex_);
    seen_ += triangles;
    if (options_.progress) options_.progress(phase, static_cast<double>(seen_) / all_);
  }
  std::uint64_t take() { return std::exchange(seen_, 0); }

 private:
  const RenderOptions& options_;
  double all_;
  std::mutex mutex_;
  std::uint64_t seen_ = 0;
};

}  // namespace

Rendering render_stage(const std::string& folder, RenderOptions options) {
  if (options.colour_by == ColourBy::automatic) options.colour_by = ColourBy::part;
  if (options.colour_by != ColourBy::part && options.colour_by != ColourBy::normal &&
      options.colour_by != ColourBy::none) {
    throw UsageError("--colour-by: a stage is coloured by part, normal or none");
  }
  const Stage stage = Stage::open(folder);
  const Manifest manifest =
      decode_manifest(stage.read(ManifestName{}), stage.path(ManifestName{}).string());
  check_canvas(options);
  InputSurface input(stage, manifest, options.threads);
  Shown shown(options, manifest.triangles());
  Framing framing(options.view, SurfacePicture::frame_of(options));
  add_input(input, {&framing, 1}, [&](std::uint64_t triangles) { shown.add("look", triangles); });
  Rendering made;
  made.triangles = shown.take();
  if (made.triangles == 0) throw DataError(folder + ": has no triangles to draw");
  SurfacePicture picture(options, framing.camera());
  input.show([](const Box&) { return true; },
             [&](const SurfacePiece& piece) {
               const bool is_part = piece.part < manifest.parts.size();
               picture.draw(piece.positions, piece.triangles,
                            {.part = is_part ? piece.part : PiecePaint::k_between});
               shown.add("draw", piece.triangles.size());
             });
  made.picture = picture.finish();
  made.vertices = manifest.input_vertices;
  if (options.colour_by == ColourBy::part) {
    made.colours = "part";
    made.pieces = manifest.parts.size();
  } else if (options.colour_by == ColourBy::normal) {
    made.colours = "normal";
  }
  return made;
}

}  // namespace meshfarm
