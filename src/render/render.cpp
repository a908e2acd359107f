// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Scans of the input: all vertices, to find the camera; all vertices, to project and store them;
// with ColourBy::piece all triangles, to connect them; and all triangles, to draw them.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <meshfarm/render/render.hpp>
#include <meshfarm/util/errors.hpp>

#include "render/canvas.hpp"
#include "render/crew.hpp"
#include "render/develop.hpp"
#include "render/legend.hpp"
#include "render/occlusion.hpp"
#include "render/paged_array.hpp"
#include "render/paints.hpp"
#include "render/pieces.hpp"
#include "render/rasterizer.hpp"

namespace meshfarm {
namespace {

constexpr std::size_t k_block = std::size_t{1} << 16;  // vertices or triangles at a time

/// Vertices or triangles on their way to a thread.
struct VertexBlock {
  std::uint64_t first = 0;
  ChannelPoints vertices;
};
struct TriangleBlock {
  std::vector<WideTriangle> corners;
  std::vector<Label> labels;
};

Canvas::Size size_of(const RenderOptions& options) {
  check_canvas(options);
  return {options.width, options.height, options.samples};
}

/// All vertices, kept while triangles are drawn.
struct Kept {
  Kept(std::uint64_t vertices, bool have_paints, const ArrayRoom& array_room)
      : room(array_room),
        points(vertices, array_room),
        paints(have_paints ? vertices : 0, array_room) {}
  ArrayRoom room;
  PagedArray<ScreenPoint> points;
  PagedArray<std::uint32_t> paints;
};

/// One thread's view of the kept vertices.
struct View {
  View(Kept& kept, unsigned views) : points(kept.points, views), paints(kept.paints, views) {}
  PagedArray<ScreenPoint>::View points;
  PagedArray<std::uint32_t>::View paints;
};

/// Views are reused by later blocks: pages that one has read, the next may need.
class Views {
 public:
  Views(Kept& kept, unsigned threads) : kept_(kept), threads_(threads) {}
  std::unique_ptr<View> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return std::make_unique<View>(kept_, threads_);
    std::unique_ptr<View> view = std::move(free_.back());
    free_.pop_back();
    return view;
  }
  void give_back(std::unique_ptr<View> view) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(view));
  }

 private:
  Kept& kept_;
  unsigned threads_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<View>> free_;
};

class Renderer {
 public:
  Renderer(MeshSource& source, const RenderOptions& options)
      : source_(source),
        options_(options),
        paints_(source.info(), options),
        canvas_(size_of(options)),
        crew_(options.threads) {}

  Rendering run() {
    const Camera camera = find_camera();
    {
      const std::unique_ptr<Kept> kept = keep_vertices(camera);
      if (paints_.from() == Paints::From::pieces) find_pieces(*kept);
      draw(camera, *kept);
    }
    return finish(camera);
  }

 private:
  /// The frame without the legend, if any.
  Frame frame() const {
    const std::uint32_t legend =
        paints_.have_scale() ? std::min(legend_width(options_.height), options_.width / 2) : 0;
    const double side = options_.samples;
    return {0, 0, side * (options_.width - legend), side * options_.height};
  }

  Camera find_camera() {
    made_.vertices = source_.info().vertices;
    PositionType positions{};
    Framing framing(options_.view, frame());
    do {  // repeated if they turn out to be finer than estimated
      positions = source_.info().positions;
      framing = Framing(options_.view, frame());
      std::uint64_t seen = 0;
      source_.scan_vertices([&](std::span<const Vec3> batch) {
        framing.add(batch);
        if (paints_.from() == Paints::From::heights) paints_.look_at(batch, {});
        seen += batch.size();
        tell("look", seen, made_.vertices);
      });
    } while (source_.info().positions != positions);
    if (framing.empty()) throw DataError(options_.name + ": has no vertex with a position");
    if (paints_.from() == Paints::From::values && !options_.range) {
      source_.scan_channels(
          [&](const ChannelPoints& batch) { paints_.look_at(batch.points, batch.values); });
    }
    paints_.finish_range();
    return framing.camera();
  }

  /// The memory left besides the canvas.
  std::uint64_t memory_for_arrays() const {
    const std::uint64_t memory = options_.memory_bytes;
    const std::uint64_t others = Canvas::memory_for(canvas_.size()) + memory / 8;
    return memory > others ? memory - others : memory / 8;
  }

  /// All arrays in memory if they fit, else in scratch files.
  ArrayRoom room() const {
    const std::uint64_t left = memory_for_arrays();
    const bool fits = made_.vertices < left / bytes_of_vertex();
    return {options_.folder, fits ? left : left / 4};
  }

  std::uint64_t bytes_of_vertex() const {
    std::uint64_t bytes = sizeof(ScreenPoint);
    if (paints_.are_of_vertices()) bytes += sizeof(std::uint32_t);
    if (paints_.from() == Paints::From::pieces) bytes += sizeof(std::uint32_t);
    return bytes;
  }

  std::unique_ptr<Kept> keep_vertices(const Camera& camera) {
    auto kept = std::make_unique<Kept>(made_.vertices, paints_.are_of_vertices(), room());
    const Crew::Shift shift(crew_);
    auto block = std::make_shared<VertexBlock>();
    std::uint64_t next = 0;
    const auto hand_out = [&] {
      crew_.give([this, &camera, &to = *kept, block] { project(*block, camera, to); });
      next += block->vertices.points.size();
      tell("project", next, made_.vertices);
      block = std::make_shared<VertexBlock>();
      block->first = next;
    };
    const auto add = [&](std::span<const Vec3> points, std::span<const float> values) {
      ChannelPoints& to = block->vertices;
      to.points.insert(to.points.end(), points.begin(), points.end());
      to.values.insert(to.values.end(), values.begin(), values.end());
      if (to.points.size() >= k_block) hand_out();
    };
    if (paints_.are_of_channels()) {
      source_.scan_channels([&](const ChannelPoints& batch) { add(batch.points, batch.values); });
    } else {
      source_.scan_vertices([&](std::span<const Vec3> batch) { add(batch, {}); });
    }
    hand_out();
    crew_.wait();
    return kept;
  }

  void project(const VertexBlock& block, const Camera& camera, Kept& kept) const {
    const std::size_t channels = source_.info().channels.size();
    const std::span<const float> values(block.vertices.values);
    std::vector<ScreenPoint> points;
    std::vector<std::uint32_t> paints;
    points.reserve(block.vertices.points.size());
    for (std::size_t i = 0; i < block.vertices.points.size(); ++i) {
      points.push_back(camera.project(block.vertices.points[i]));
      if (kept.paints.size() == 0 || paints_.from() == Paints::From::pieces) continue;
      const std::span<const float> of_vertex =
          values.empty() ? values : values.subspan(i * channels, channels);
      paints.push_back(paints_.of(block.vertices.points[i], of_vertex));
    }
    kept.points.write(block.first, points);
    kept.paints.write(block.first, paints);
  }

  void find_pieces(Kept& kept) {
    if (made_.vertices > Pieces::k_most_vertices) {
      throw DataError(options_.name + ": a mesh of " + std::to_string(made_.vertices) +
                      " vertices is too large to be coloured by piece: the limit is " +
                      std::to_string(Pieces::k_most_vertices));
    }
    const std::uint64_t left = memory_for_arrays();
    const std::uint64_t arrays = made_.vertices * bytes_of_vertex();
    Pieces pieces(kept.points, kept.room, arrays < left ? left - arrays : left / 4);
    std::uint64_t seen = 0;
    source_.scan_triangles([&](const TriangleView& batch) {
      pieces.join(batch);
      seen += batch.size();
      tell("connect", seen, source_.info().faces);
    });
    made_.pieces = pieces.colour(kept.paints);
  }

  void draw(const Camera& camera, Kept& kept) {
    Rasterizer rasterizer(camera, canvas_, options_.wire ? Wire::yes : Wire::no);
    Views views(kept, crew_.size());
    const Crew::Shift shift(crew_);
    auto block = std::make_shared<TriangleBlock>();
    const auto hand_out = [&] {
      crew_.give([this, &rasterizer, &views, block] { draw_block(*block, rasterizer, views); });
      block = std::make_shared<TriangleBlock>();
    };
    source_.scan_triangles([&](const TriangleView& batch) {
      block->corners.insert(block->corners.end(), batch.corners.begin(), batch.corners.end());
      const std::span<const Label> labels = batch.columns.labels;
      block->labels.insert(block->labels.end(), labels.begin(), labels.end());
      made_.triangles += batch.size();
      tell("draw", made_.triangles, source_.info().faces);
      if (block->corners.size() >= k_block) hand_out();
    });
    hand_out();
    crew_.wait();
    made_.not_finite = not_finite_;
    if (made_.triangles == 0) throw DataError(options_.name + ": has no triangles to draw");
  }

  void draw_block(const TriangleBlock& block, Rasterizer& rasterizer, Views& views) {
    std::unique_ptr<View> view = views.take();
    std::uint64_t not_finite = 0;
    for (std::size_t i = 0; i < block.corners.size(); ++i) {
      const WideTriangle& t = block.corners[i];
      const std::array<ScreenPoint, 3> corners = {view->points.get(t[0]), view->points.get(t[1]),
                                                  view->points.get(t[2])};
      if (!rasterizer.may_cover(corners)) {
        if (std::isnan(corners[0].x + corners[1].x + corners[2].x)) ++not_finite;
        continue;
      }
      std::array<std::uint32_t, 3> paints{};
      if (paints_.are_of_vertices()) {
        paints = {view->paints.get(t[0]), view->paints.get(t[1]), view->paints.get(t[2])};
      }
      const Label label = block.labels.empty() ? 0 : block.labels[i];
      rasterizer.draw(corners, paints_.of_triangle(label, paints));
    }
    not_finite_ += not_finite;
    views.give_back(std::move(view));
  }

  Rendering finish(const Camera& camera) {
    std::vector<float> open_sky;
    if (paints_.from() != Paints::From::normals) {
      open_sky = find_open_sky(canvas_, camera, options_);
    }
    made_.picture = develop(canvas_, open_sky, options_);
    made_.colours = paints_.name();
    if (paints_.have_scale()) {
      const ValueRange& range = paints_.range();
      made_.range = {range.low, range.high};
      const Light ink = light_of(options_.background) * -1.0F + Light{1, 1, 1};
      const bool is_dark = !options_.transparent && ink.green > 0.8F;
      draw_legend(made_.picture, paints_.name(), range, is_dark ? Srgb{225, 225, 225} : k_ink);
    }
    return std::move(made_);
  }

  void tell(std::string_view phase, std::uint64_t done, std::uint64_t all) const {
    if (!options_.progress) return;
    const double share = static_cast<double>(done) / static_cast<double>(all + 1);
    options_.progress(phase, std::min(1.0, share));
  }

  static constexpr Srgb k_ink = {50, 54, 62};

  MeshSource& source_;
  const RenderOptions& options_;
  Paints paints_;
  Canvas canvas_;
  std::atomic<std::uint64_t> not_finite_{0};
  Rendering made_;
  Crew crew_;  // last, so that its threads end first
};

}  // namespace

Textures textures_for(const RenderOptions& options) {
  const bool by_colour =
      options.colour_by == ColourBy::automatic || options.colour_by == ColourBy::colour;
  return by_colour ? Textures::bake : Textures::drop;
}

void check_canvas(const RenderOptions& options) {
  const Canvas::Size size{options.width, options.height, options.samples};
  const std::uint64_t bytes = Canvas::memory_for(size);
  if (bytes <= options.memory_bytes / 4 * 3) return;
  throw UsageError("--size " + std::to_string(size.width) + "x" + std::to_string(size.height) +
                   " with --samples " + std::to_string(size.side) + " takes --memory " +
                   std::to_string((bytes / 3 * 4 >> 20) + 1) + "M");
}

Rendering render_mesh(MeshSource& source, const RenderOptions& options) {
  return Renderer(source, options).run();
}

}  // namespace meshfarm
