// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/report_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include <meshfarm/geometry/crossings.hpp>
#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/io/png_file.hpp>
#include <meshfarm/pipeline/input_surface.hpp>
#include <meshfarm/render/colour_scale.hpp>
#include <meshfarm/render/surface_picture.hpp>
#include <meshfarm/util/parallel.hpp>

#include "cli/input_framing.hpp"
#include "cli/report_samples.hpp"

namespace meshfarm {
namespace {

/// A larger result is not embedded in the page, and its crossings are not counted.
constexpr std::uint64_t k_most_in_model = 200'000;
constexpr std::uint64_t k_most_for_crossings = 1'000'000;
/// An input up to this size is also measured as a whole.
constexpr std::uint64_t k_small_input = 1'500'000;

/// Widths of pictures, in pixels.
constexpr std::uint32_t k_wide = 580;
constexpr std::uint32_t k_narrow = 320;
constexpr std::uint32_t k_map = 640;

struct NamedAngle {
  const char* caption;
  double azimuth;
  double elevation;
};
constexpr double k_above = 48;  // elevation for flat-lying shapes
constexpr std::array<NamedAngle, 3> k_views = {
    {{"from the front", 25, 18}, {"from the right", 145, 18}, {"from the left", 265, 18}}};

struct Zoom {
  Vec3 at;
  double radius = 0;
  double depth = 0;  // surfaces nearer to the viewer by more than this would hide it
  View view;
  ViewAxes axes;

  bool shows(const std::array<Vec3, 3>& corners) const {
    Box box;
    bool is_before = true;
    for (const Vec3& p : corners) {
      box.add(p);
      is_before = is_before && dot(axes.toward, p - at) > depth;
    }
    return !is_before && touches(box);
  }
  bool touches(const Box& box) const {
    const double reach = 3 * radius;
    return box.lo.x <= at.x + reach && box.hi.x >= at.x - reach && box.lo.y <= at.y + reach &&
           box.hi.y >= at.y - reach && box.lo.z <= at.z + reach && box.hi.z >= at.z - reach;
  }
};

/// Terrains and floors lie, everything else stands: whether the up axis is the shortest by far.
bool lies(const Box& box, Vec3 up) {
  const Vec3 sides = box.hi - box.lo;
  const double high = std::abs(dot(sides, up));
  std::array<double, 3> of = {sides.x, sides.y, sides.z};
  std::sort(of.begin(), of.end());
  return high == of[0] && high < 0.4 * of[1];
}

Vec3 up_of(const Box& box) {
  constexpr Vec3 k_z{0, 0, 1};
  return lies(box, k_z) ? k_z : Vec3{0, 1, 0};
}

/// The best view of a side with this normal.
View facing(Vec3 normal, Vec3 up) {
  constexpr double k_degrees = 180 / 3.14159265358979323846;
  const ViewAxes front({.azimuth = 0, .elevation = 0, .up = up});
  const double size = length(normal);
  const Vec3 to = size > 0 ? normal * (1 / size) : front.toward;
  return {.projection = Projection::orthographic,
          .azimuth = k_degrees * std::atan2(dot(front.right, to), dot(front.toward, to)),
          .elevation = k_degrees * std::asin(std::clamp(dot(up, to), -1.0, 1.0)),
          .up = up};
}

PagePicture to_page(Texels texels) {
  PagePicture made{.width = texels.width, .height = texels.height};
  made.png = encode_png(std::move(texels), PngSize::soon);
  return made;
}

class SceneMaker {
 public:
  SceneMaker(RunPage& page, const Stage& stage, const Mesh& result, const SceneOptions& options)
      : page_(page),
        result_(result),
        options_(options),
        threads_(options.threads),
        input_(stage, page.manifest, options.threads),
        up_(options.up.value_or(up_of(page.manifest.box))),
        index_(result, options.threads),
        samples_(page.manifest) {}

  void make() {
    set_cameras();
    draw_input();
    measure();
    draw_map();
    draw_zoom();
    if (result_.triangles.size() <= k_most_in_model) add_model();
    finish();
  }

 private:
  /// Where to store a finished picture, and its other look if it has one.
  struct Drawn {
    PagePicture* to;
    SurfacePicture picture;
    PagePicture* by_part = nullptr;
  };

  /// `width`: the width on a desktop page.
  static RenderOptions options_for(const View& view, std::uint32_t width = k_wide) {
    RenderOptions options;
    options.width = width;
    options.height = width * 3 / 4;
    options.view = view;
    options.colour_by = ColourBy::none;
    options.transparent = true;
    options.quick = true;
    options.threads = 1;
    return options;
  }

  /// By the result, which covers the input; by both if parts of the input are gone.
  void set_cameras() {
    Box box;
    for (const Vec3& p : result_.positions) box.add(p);
    const Box& whole = page_.manifest.box;
    const double most = 0.01 * whole.diagonal();
    const bool is_whole = length(box.lo - whole.lo) <= most && length(box.hi - whole.hi) <= most;
    std::vector<Framing> framings;
    for (const NamedAngle& each : k_views) {
      const double elevation = lies(whole, up_) ? k_above : each.elevation;
      const View view{.azimuth = each.azimuth, .elevation = elevation, .up = up_};
      pictures_.push_back(options_for(view, framings.empty() ? k_wide : k_narrow));
      framings.emplace_back(view, SurfacePicture::frame_of(pictures_.back()));
      framings.back().add(result_.positions);
    }
    if (!is_whole) add_input(input_, framings);
    for (const Framing& framing : framings) cameras_.push_back(framing.camera());
  }

  SurfacePicture& start(PagePicture& to, const RenderOptions& options, const Camera& camera) {
    drawn_.push_back({&to, SurfacePicture(options, camera)});
    return drawn_.back().picture;
  }

  /// Everything that needs the whole input, in one pass.
  void draw_input() {
    drawn_.reserve(16);  // nothing may move
    scene_.views.resize(pictures_.size());
    std::vector<SurfacePicture*> of_input;
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      scene_.views[i].caption = k_views[i].caption;
      of_input.push_back(&start(scene_.views[i].input, pictures_[i], cameras_[i]));
    }
    of_input.front()->add_look(ColourBy::part);
    drawn_.front().by_part = &scene_.parts;
    const auto parts = static_cast<std::uint32_t>(page_.manifest.parts.size());
    const bool keeps =
        page_.manifest.scheme == Scheme::cut && page_.manifest.triangles() <= k_small_input;
    pieces_.resize(keeps ? parts + 1 : 0);
    input_.show([](const Box&) { return true; },
                [&](const SurfacePiece& piece) {
                  const bool is_part = piece.part < parts;
                  SurfacePicture::draw_in_all(
                      of_input, piece.positions, piece.triangles,
                      {.part = is_part ? piece.part : PiecePaint::k_between});
                  samples_.add(piece);
                  if (keeps) append_surface(piece.positions, piece.triangles, pieces_[piece.part]);
                });
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      start(scene_.views[i].result, pictures_[i], cameras_[i])
          .draw(result_.positions, result_.triangles);
    }
  }

  void measure() {
    places_ = samples_.measure(index_, threads_);
    figures_.samples = places_.size();
    ErrorFigures figures = error_figures_of(places_);
    figures_.to_result = figures.error;
    figures_.histogram = std::move(figures.histogram);
    figures_.input.shape = samples_.shape();
    if (!pieces_.empty()) measure_whole_input();
    ShapeMeter meter(threads_);
    meter.add(result_.positions, result_.triangles);
    figures_.result.shape = meter.measures();
    figures_.result.edges = measure_edge_lengths(result_, threads_);
    figures_.result.crossing_triangles = options_.crossings;
    if (!options_.crossings && result_.triangles.size() <= k_most_for_crossings) {
      figures_.result.crossing_triangles = count_crossing_triangles(index_, {.threads = threads_});
    }
  }

  void measure_whole_input() {
    Mesh whole;
    for (Mesh& piece : pieces_) {
      append_surface(piece.positions, piece.triangles, whole);
      piece = {};
    }
    figures_.input.edges = measure_edge_lengths(whole, threads_);
    figures_.input.crossing_triangles = count_crossing_triangles(whole, {.threads = threads_});
  }

  void draw_map() {
    errors_ = errors_at_vertices(result_, places_);
    const double end = figures_.histogram.end;
    RenderOptions options = options_for(pictures_[0].view, k_map);
    options.colour_by = ColourBy::quality;
    options.range = {0.0, end > 0 ? end : 1};
    Framing framing(options.view, SurfacePicture::frame_of(options));
    framing.add(result_.positions);
    start(scene_.map, options, framing.camera())
        .draw(result_.positions, result_.triangles, {.values = errors_});
    constexpr int k_stops = 32;
    for (int i = 0; i < k_stops; ++i) {
      scene_.scale.push_back(colour_on_scale(static_cast<double>(i) / (k_stops - 1)));
    }
  }

  /// At the sample with the largest distance; close enough that triangles of the result are large.
  std::optional<Zoom> find_zoom() const {
    const auto worst = std::max_element(places_.begin(), places_.end(),
                                        [](const MeasuredPlace& a, const MeasuredPlace& b) {
                                          return a.near.distance < b.near.distance;
                                        });
    if (worst == places_.end()) return std::nullopt;
    const auto& [a, b, c] = result_.triangles[worst->near.triangle];
    const Vec3 p = result_.positions[a], q = result_.positions[b], r = result_.positions[c];
    const double side = std::max({length(q - p), length(r - q), length(p - r)});
    const double most = page_.manifest.box.diagonal() / 4;
    const double off = worst->near.distance;
    const double radius = std::min(most, std::max(3 * side, 3 * off));
    const double depth = std::max(2 * off, 0.6 * radius);
    const View view = facing(worst->point.normal, up_);
    return Zoom{worst->point.at, radius, depth, view, ViewAxes(view)};
  }

  void draw_zoom() {
    const std::optional<Zoom> zoom = find_zoom();
    if (!zoom) return;
    RenderOptions options = options_for(zoom->view);
    options.wire = true;
    const ViewAxes& axes = zoom->axes;
    const double aspect = static_cast<double>(options.width) / options.height;
    const std::array<std::pair<Vec3, double>, 3> reaches = {
        {{axes.right, aspect}, {axes.up, 1}, {axes.toward, 3}}};
    Framing framing(zoom->view, SurfacePicture::frame_of(options));
    for (const auto& [axis, reach] : reaches) {
      const Vec3 by = axis * (reach * zoom->radius);
      framing.add(std::array{zoom->at + by, zoom->at - by});
    }
    const Camera camera = framing.camera();
    const auto near = [&](std::span<const Vec3> at, std::span<const Triangle> triangles) {
      std::vector<Triangle> found;
      for (const Triangle& t : triangles) {
        if (zoom->shows({at[t[0]], at[t[1]], at[t[2]]})) found.push_back(t);
      }
      return found;
    };
    SurfacePicture& of_input = start(scene_.zoom.input, options, camera);
    input_.show([&](const Box& box) { return zoom->touches(box); },
                [&](const SurfacePiece& piece) {
                  of_input.draw(piece.positions, near(piece.positions, piece.triangles));
                });
    start(scene_.zoom.result, options, camera)
        .draw(result_.positions, near(result_.positions, result_.triangles));
    scene_.zoom.caption = zoom_caption(*zoom);
  }

  std::string zoom_caption(const Zoom& zoom) const {
    const auto text = [](double value) {
      std::array<char, 32> made{};
      std::snprintf(made.data(), made.size(), "%.4g", value);
      return std::string(made.data());
    };
    return "At " + text(zoom.at.x) + ", " + text(zoom.at.y) + ", " + text(zoom.at.z) +
           " a point of the input is " + text(figures_.to_result.distance.max) +
           " from the result: the most of all points looked at. Each picture is " +
           text(2 * zoom.radius) + " high.";
  }

  void add_model() {
    const double end = figures_.histogram.end;
    std::vector<float> shares;
    shares.reserve(errors_.size());
    for (const float error : errors_) {
      shares.push_back(end > 0 ? static_cast<float>(static_cast<double>(error) / end) : 0.0F);
    }
    scene_.model = encode_model(result_, shares);
    const ViewAxes axes(pictures_[0].view);
    scene_.axes = {axes.right.x, axes.right.y,  axes.right.z,  axes.up.x,    axes.up.y,
                   axes.up.z,    axes.toward.x, axes.toward.y, axes.toward.z};
  }

  void finish() {
    parallel_for(drawn_.size(), threads_, [&](std::uint64_t i) {
      Drawn& drawn = drawn_[i];
      *drawn.to = to_page(drawn.picture.finish());
      if (drawn.by_part != nullptr) *drawn.by_part = to_page(drawn.picture.finish(1));
    });
    page_.scene = std::move(scene_);
    page_.figures = std::move(figures_);
  }

  RunPage& page_;
  const Mesh& result_;
  SceneOptions options_;
  unsigned threads_;
  InputSurface input_;
  Vec3 up_;
  TriangleIndex index_;
  InputSamples samples_;
  std::vector<Mesh> pieces_;             // of a small input
  std::vector<RenderOptions> pictures_;  // the views
  std::vector<Camera> cameras_;
  std::vector<MeasuredPlace> places_;
  std::vector<float> errors_;  // at the result's vertices
  PageScene scene_;
  PageFigures figures_;
  std::vector<Drawn> drawn_;
};

}  // namespace

void add_scene(RunPage& page, const Stage& stage, const Mesh& result, const SceneOptions& options) {
  SceneMaker(page, stage, result, options).make();
}

}  // namespace meshfarm
