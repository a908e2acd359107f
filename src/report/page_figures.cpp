// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The tables of a run's page.
#include <cmath>
#include <functional>

#include "report/lines.hpp"
#include "report/page_html.hpp"
#include "report/summary_words.hpp"

namespace meshfarm {
namespace {

const char* const k_none = "–";

std::string shown(const std::optional<double>& value, const char* format = "%.6g") {
  return value && std::isfinite(*value) ? number(*value, format) : k_none;
}

/// A table of input, result, and change.
class Table {
 public:
  explicit Table(const std::vector<std::string>& head)
      : text_("<table class=\"numbers\">\n" + row_of(head, "th")) {}
  void add(const std::vector<std::string>& cells) { text_ += row_of(cells); }
  void add_measures(const std::string& name, const std::optional<double>& input,
                    const std::optional<double>& result) {
    std::string change = k_none;
    if (input && result && *input != 0) {
      change = number(100 * (*result - *input) / std::abs(*input), "%+.3g %%");
      if (change.front() == '-') change.replace(0, 1, "−");
    }
    add({name, shown(input), shown(result), change});
  }
  /// Sizes of a mesh, with the percentage left.
  void add_sizes(const std::string& name, std::uint64_t input,
                 const std::optional<std::uint64_t>& result) {
    if (!result) return add({name, grouped(input), k_none, ""});
    const double left =
        static_cast<double>(*result) / static_cast<double>(std::max<std::uint64_t>(1, input));
    add({name, grouped(input), grouped(*result), number(100 * left, "%.3g %% left")});
  }
  void add_counts(const std::string& name, const std::optional<std::uint64_t>& input,
                  const std::optional<std::uint64_t>& result) {
    const auto text = [](const std::optional<std::uint64_t>& count) {
      return count ? grouped(*count) : k_none;
    };
    std::string change;
    if (input && result && *input != *result) {
      change = (*result > *input ? "+" : "−") +
               grouped(*result > *input ? *result - *input : *input - *result);
    }
    add({name, text(input), text(result), change});
  }
  std::string text() const { return "<div class=\"wide\">" + text_ + "</table></div>\n"; }

 private:
  std::string text_;
};

void add_shapes(Table& table, const SurfaceFigures& input, const SurfaceFigures& result,
                bool are_closed) {
  using Edges = std::optional<EdgeLengths>;
  const auto border = [](const Edges& e) { return e ? std::optional(e->border) : std::nullopt; };
  const auto feature = [](const Edges& e) { return e ? std::optional(e->feature) : std::nullopt; };
  table.add_measures("area", input.shape.area, result.shape.area);
  if (are_closed) table.add_measures("volume", input.shape.volume, result.shape.volume);
  table.add_measures("length of borders", border(input.edges), border(result.edges));
  table.add_measures("length of edges over " + number(k_feature_degrees, "%g°"),
                     feature(input.edges), feature(result.edges));
  table.add({"smallest angle: 1 % of the triangles up to",
             number(input.shape.smallest_angle_p1, "%.3g°"),
             number(result.shape.smallest_angle_p1, "%.3g°"), ""});
  table.add({"triangles with an angle below 5°", number(100 * input.shape.share_below_5, "%.3g %%"),
             number(100 * result.shape.share_below_5, "%.3g %%"), ""});
  table.add_counts("triangles that cut or touch others", input.crossing_triangles,
                   result.crossing_triangles);
}

bool is_closed(const Json& topology) {
  // Summaries of earlier versions have only the counts.
  const bool by_counts =
      count_of(topology, "border_edges") == 0U && count_of(topology, "nonmanifold_edges") == 0U;
  return topology.is_object() && topology.value("closed", by_counts);
}

void add_topology(Table& table, const Json& input, const Json& result) {
  const auto add = [&](const std::string& name, const char* key) {
    table.add_counts(name, count_of(input, key), count_of(result, key));
  };
  add("pieces", "components");
  add("handles", "handles");
  add("border edges", "border_edges");
  add("edges of more than two triangles", "nonmanifold_edges");
}

bool has_figure(const Json& error, const char* direction, const char* figure) {
  return error.is_object() && error.contains(direction) &&
         error.at(direction).value(figure, Json(nullptr)).is_number();
}

std::string share_of(const Json& error, const char* direction, const char* figure) {
  if (!has_figure(error, direction, figure)) return k_none;
  return number(error.at(direction).value(figure, 0.0), "%.3g");
}

/// The run's own figures, and those measured for the page.
std::string error_table(const Json& summary, const PageFigures* figures, double diagonal) {
  const Json error = summary.value("error", Json(nullptr));
  if (!error.is_object() && figures == nullptr) return {};
  Table table({"distances, of the diagonal", "input to result", "result to input", ""});
  const auto add = [&](const char* name, const char* figure) {
    table.add({name, share_of(error, "input_to_output", figure),
               share_of(error, "output_to_input", figure), ""});
  };
  add("rms", "rms");
  add("mean", "mean");
  const bool has_quantiles = has_figure(error, "input_to_output", "p95");
  if (has_quantiles) add("95 %", "p95");
  if (has_quantiles) add("99 %", "p99");
  add("max", "max");
  if (const std::optional<double> proven = proven_bound(summary)) {
    const std::string bound = number(*proven, "%.3g");
    table.add({"proven for every point", "≤ " + bound, "≤ " + bound, ""});
  }
  if (figures != nullptr) {
    const SurfaceError& e = figures->to_result;
    if (!has_quantiles) {  // of a result that was measured in pieces
      table.add({"95 %", number(e.quantiles.p95 / diagonal, "%.3g"), k_none, ""});
      table.add({"99 %", number(e.quantiles.p99 / diagonal, "%.3g"), k_none, ""});
    }
    if (e.normals) {
      table.add({"normals turned, RMS", number(e.normals->rms, "%.3g°"), k_none, ""});
      table.add({"normals turned, 95 %", number(e.normals->p95, "%.3g°"), k_none, ""});
      table.add({"area turned by more than 90°", number(100 * e.normals->over_90, "%.3g %%"),
                 k_none, ""});
    }
  }
  return table.text() + "<p class=\"dim\">The diagonal of the input's box is " +
         number(diagonal, "%.6g") + " long.</p>\n";
}

std::string channel_table(const Json& summary) {
  const Json channels = summary.value("channels", Json::array());
  if (channels.empty()) return {};
  Table table({"values of vertices", "RMS from the input"});
  for (const Json& each : channels) {
    table.add({each.value("name", ""), number(each.value("rms", 0.0), "%.3g")});
  }
  return table.text();
}

}  // namespace

std::optional<std::uint64_t> count_of(const Json& of, const char* name) {
  if (!of.is_object() || !of.value(name, Json(nullptr)).is_number()) return {};
  return static_cast<std::uint64_t>(std::max<std::int64_t>(0, of.at(name)));
}

std::optional<double> proven_bound(const Json& summary) {
  const Json bound = summary.value("bound", Json(nullptr));
  if (!bound.is_object() || bound.value("kind", "") != "certified") return {};
  return bound.value("max", 0.0);
}

std::string figure_tables(const RunPage& page, const Json& summary) {
  const Manifest& m = page.manifest;
  const PageFigures* figures = page.figures ? &*page.figures : nullptr;
  Table table({"", "input", "result", "change"});
  const Json output = summary.value("output", Json::object());
  table.add_sizes("triangles", m.input_triangles, count_of(output, "triangles"));
  table.add_sizes("vertices", m.input_vertices, count_of(output, "vertices"));
  const Json change = summary.value("topology_change", Json(nullptr));
  const auto of = [&](const char* which) {
    return change.is_object() ? change.value(which, Json(nullptr)) : Json(nullptr);
  };
  const Json before = of("input"), after = of("output");
  if (change.is_object()) add_topology(table, before, after);
  if (figures != nullptr) {
    add_shapes(table, figures->input, figures->result, is_closed(before) && is_closed(after));
  }
  return table.text() + error_table(summary, figures, m.box.diagonal()) + channel_table(summary);
}

}  // namespace meshfarm
