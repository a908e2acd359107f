// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>

#include <meshfarm/report/run_page.hpp>
#include <meshfarm/report/timeline.hpp>
#include <meshfarm/util/errors.hpp>

#include "report/lines.hpp"
#include "report/page_assets.hpp"
#include "report/page_html.hpp"
#include "report/summary_words.hpp"
#include "report/svg.hpp"

namespace meshfarm {
namespace {

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

std::string section(const std::string& title, const std::string& text) {
  return text.empty() ? "" : "<section>\n<h2>" + title + "</h2>\n" + text + "</section>\n";
}

std::string paragraph(const std::string& text) {
  return "<p class=\"dim\">" + escaped(text) + "</p>\n";
}

/// A duration for a heading.
std::string time_text(double seconds) {
  if (seconds < 120) return number(seconds, "%.3g s");
  if (seconds < 7200) return number(seconds / 60, "%.3g min");
  return number(seconds / 3600, "%.3g h");
}

struct Phase {
  const char* name;
  const char* colour;
  double seconds;
};

std::vector<Phase> phases_of(const RunTimes& t) {
  return {{"cut", "#4878a8", t.cut},         {"farm", "#d08030", t.farm},
          {"stitch", "#58a058", t.stitch},   {"finish", "#a05898", t.finish},
          {"measure", "#48a0a0", t.measure}, {"write", "#808080", t.write}};
}

double sum_of(const std::vector<Phase>& phases) {
  double sum = 0;
  for (const Phase& each : phases) sum += each.seconds;
  return sum;
}

class Page {
 public:
  explicit Page(const RunPage& page)
      : page_(page),
        summary_(page.summary.empty() ? Json::object() : Json::parse(page.summary)),
        output_(summary_.value("output", Json::object()).value("path", "")) {
    if (!page.summary.empty()) times_ = run_times_of(summary_, "the run's summary");
  }

  std::string render() const {
    return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
           escaped(title()) + "</title>\n<style>\n" + std::string(k_page_css) +
           "</style>\n</head>\n<body>\n" + head() + section("Input and result", views()) +
           section("Error", map()) + section("Where it is farthest off", zoom()) +
           section("Parts", parts()) + section("Figures", figure_tables(page_, summary_)) +
           section("Time", phases() + render_timeline(page_.manifest, page_.trace, times_)) +
           section("Again", command()) + model() + "</body>\n</html>\n";
  }

 private:
  std::string title() const {
    return file_name(page_.manifest.input) + (output_.empty() ? "" : " → " + file_name(output_));
  }

  std::string head() const {
    const Manifest& m = page_.manifest;
    std::string text = "<header>\n<h1>" + escaped(title()) + "</h1>\n<p class=\"dim\">" +
                       escaped(m.input_format) + ", simplified by meshfarm</p>\n" + cards();
    const Json warning = summary_.value("warning", Json(nullptr));
    if (warning.is_string()) text += warned(warning.get<std::string>());
    if (page_.summary.empty()) text += warned("This run has not ended: there is no result yet.");
    if (page_.trace.end && !page_.trace.end->failure.empty()) {
      text += warned("The run stopped: " + page_.trace.end->failure);
    }
    if (summary_.value("topology", "kept") == "simplified") {
      text += warned("Holes, handles or pieces were closed or removed; see the figures.");
    }
    for (const std::string& note : page_.notes) text += warned(note);
    return text + "</header>\n";
  }

  static std::string warned(const std::string& text) {
    return "<div class=\"warning\">" + escaped(text) + "</div>\n";
  }

  std::string cards() const {
    const auto card = [](const std::string& value, const std::string& what) {
      return "<div><b>" + escaped(value) + "</b><span>" + escaped(what) + "</span></div>\n";
    };
    std::string text =
        "<div class=\"cards\">\n" + card(grouped(page_.manifest.input_triangles), "triangles in");
    if (times_) {
      const double share =
          100 * static_cast<double>(times_->triangles_out) /
          static_cast<double>(std::max<std::uint64_t>(1, page_.manifest.input_triangles));
      text += card(grouped(times_->triangles_out),
                   "triangles out, " + number(share, "%.3g") + " % of them");
      const Json error = summary_.value("error", Json(nullptr));
      if (error.is_object()) {
        text += card(number(error.value("rms", 0.0), "%.2g"),
                     "RMS error, of the diagonal; " + greatest(error.value("max", 0.0)));
      }
      text += card(time_text(sum_of(phases_of(*times_))), "from input to result");
    }
    return text + "</div>\n";
  }

  /// The proven bound, or the maximum over the sampled points.
  std::string greatest(double of_points) const {
    const auto proven = proven_bound(summary_);
    return proven ? "proven to be within " + number(*proven, "%.3g") + " everywhere"
                  : "max " + number(of_points, "%.2g");
  }

  static std::string pair_of(const PicturePair& pair) {
    return "<div class=\"pair\">\n" +
           figure_of(pair.input, "the input, " + pair.caption, "input, " + pair.caption) +
           figure_of(pair.result, "the result, " + pair.caption, "result, " + pair.caption) +
           "</div>\n";
  }

  std::string views() const {
    if (!page_.scene || page_.scene->views.empty()) return {};
    const std::vector<PicturePair>& views = page_.scene->views;
    std::string text = pair_of(views.front()) + "<div class=\"pairs\">\n";
    for (std::size_t i = 1; i < views.size(); ++i) text += pair_of(views[i]);
    return text + "</div>\n";
  }

  std::string map() const {
    if (!page_.scene || !page_.figures) return {};
    const bool turns = !page_.scene->model.empty();
    std::string text = "<div class=\"map\">\n<figure>\n<div class=\"model\">" +
                       html_of(page_.scene->map, "the result, coloured by error") + "</div>\n";
    if (turns) {
      text +=
          "<div class=\"buttons\"><button type=\"button\" data-shows=\"error\">Error</button>"
          "<button type=\"button\" data-shows=\"edges\">Edges</button>"
          "<button type=\"button\" data-does=\"nearer\" aria-label=\"nearer\">+</button>"
          "<button type=\"button\" data-does=\"farther\" aria-label=\"farther\">−</button>"
          "<button type=\"button\" data-does=\"reset\">Reset</button></div>\n";
    }
    return text + "</figure>\n<div>\n" + histogram() + "</div>\n</div>\n";
  }

  std::string scale_css() const {
    std::string text = "linear-gradient(to right";
    for (const auto& colour : page_.scene->scale) text += ", " + css_of(colour);
    return text + ")";
  }

  std::string histogram() const {
    constexpr double k_width = 480;
    constexpr double k_height = 170;
    const ErrorHistogram& h = page_.figures->histogram;
    if (h.shares.empty() || page_.scene->scale.empty()) return {};
    const double most = std::max(1e-12, *std::max_element(h.shares.begin(), h.shares.end()));
    const double pitch = k_width / static_cast<double>(h.shares.size());
    Svg svg(k_width, k_height);
    for (std::size_t i = 0; i < h.shares.size(); ++i) {
      const double height = h.shares[i] / most * (k_height - 4);
      const std::size_t colour = (2 * i + 1) * page_.scene->scale.size() / (2 * h.shares.size());
      svg.rect({static_cast<double>(i) * pitch, k_height - height}, pitch - 1, height,
               css_of(page_.scene->scale[colour]),
               number(100 * h.shares[i], "%.3g %% of the area"));
    }
    return svg.str() + R"(<div class="scale" style="background:)" + scale_css() +
           "\"></div>\n<div class=\"ends\"><span>0</span><span>" + number(h.end / 2, "%.3g") +
           "</span><span>" + number(h.end, "%.3g") + "</span></div>\n" +
           paragraph(
               "How far the input's surface is from the result, in the mesh's unit, by "
               "area: " +
               grouped(page_.figures->samples) + " points. " + number(100 * h.beyond, "%.2g") +
               " % are farther. The map has at each vertex the mean of the points that are "
               "nearest to its triangles.");
  }

  std::string zoom() const {
    if (!page_.scene || page_.scene->zoom.result.png.empty()) return {};
    return "<div class=\"pair\">\n" +
           figure_of(page_.scene->zoom.input, "edges of the input, where it is farthest off",
                     "input, its edges") +
           figure_of(page_.scene->zoom.result, "edges of the result, where it is farthest off",
                     "result, its edges") +
           "</div>\n" + paragraph(page_.scene->zoom.caption);
  }

  std::string parts() const {
    if (!page_.scene || page_.scene->parts.png.empty()) return {};
    const Manifest& m = page_.manifest;
    return "<div class=\"pair aside\">\n" +
           figure_of(page_.scene->parts, "the parts of the input", "the parts of the input") +
           "<div>" +
           paragraph(grouped(m.parts.size()) + (m.scheme == Scheme::stream ? " slabs" : " parts") +
                     " in colours, each simplified by itself. The " +
                     grouped(m.boundary_triangles) +
                     " triangles between them are dark. Twelve colours come over and over.") +
           "</div></div>\n";
  }

  std::string phases() const {
    if (!times_) return {};
    const std::vector<Phase> phases = phases_of(*times_);
    const double sum = std::max(1e-9, sum_of(phases));
    std::string bar = "<div class=\"stages\">";
    std::string key = "<div class=\"key\">";
    for (const Phase& each : phases) {
      const std::string colour = "background:" + std::string(each.colour);
      bar += "<div title=\"" + std::string(each.name) +
             "\" style=\"width:" + number(100 * each.seconds / sum, "%.3f%%") + ";" + colour +
             "\"></div>";
      key += "<span><i style=\"" + colour + "\"></i>" + each.name + " " +
             number(each.seconds, "%.2f s") + "</span>";
    }
    return bar + "</div>\n" + key + "</div>\n";
  }

  std::string command() const {
    if (page_.command.empty()) return {};
    return "<pre>" + escaped(page_.command) + "</pre>\n";
  }

  /// Comes last, since it is long and not for reading.
  std::string model() const {
    if (!page_.scene || page_.scene->model.empty()) return {};
    Json axes = page_.scene->axes;
    Json scale = page_.scene->scale;
    return R"(<script type="text/plain" id="model" data-axes=")" + axes.dump() +
           "\" data-scale=\"" + scale.dump() + "\">" + base64(page_.scene->model) +
           "</script>\n<script>\n" + std::string(k_page_js) + "</script>\n";
  }

  const RunPage& page_;
  Json summary_;
  std::string output_;
  std::optional<RunTimes> times_;
};

}  // namespace

std::string render_run_page(const RunPage& page) {
  return Page(page).render();
}

RunResult parse_run_result(std::string_view text, std::string_view what) {
  try {
    const Json json = Json::parse(text);
    const Json& output = json.at("output");
    RunResult result{output.at("path").get<std::string>(),
                     output.at("triangles").get<std::uint64_t>()};
    const Json surface = json.value("surface", Json(nullptr));
    if (surface.is_object()) result.crossing_triangles = count_of(surface, "crossing_triangles");
    return result;
  } catch (const std::exception& error) {
    throw DataError(std::string(what) + ": no summary of a run: " + error.what());
  }
}

}  // namespace meshfarm
