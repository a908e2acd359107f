// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "report/svg.hpp"

#include <cmath>

#include "report/lines.hpp"

namespace meshfarm {
namespace {

std::string attribute(std::string_view name, double value) {
  std::string text = number(value, "%.2f");
  return " " + std::string(name) + "=\"" + text + "\"";
}

std::string attribute(std::string_view name, std::string_view value) {
  return value.empty() ? "" : " " + std::string(name) + "=\"" + escaped(value) + "\"";
}

/// The title is the tooltip in browsers.
std::string end_with(std::string_view tag, std::string_view title) {
  if (title.empty()) return "/>\n";
  return "><title>" + escaped(title) + "</title></" + std::string(tag) + ">\n";
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  }
  return safe;
}

Svg::Svg(double width, double height)
    : text_(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 )" + number(width, "%.0f") +
            " " + number(height, "%.0f") + "\"" + attribute("width", width) +
            attribute("height", height) +
            R"( font-family="sans-serif" font-size="12" fill="#333">)" + "\n") {}

void Svg::rect(SvgPoint at, double width, double height, std::string_view fill,
               std::string_view title) {
  text_ += "<rect" + attribute("x", at.x) + attribute("y", at.y) + attribute("width", width) +
           attribute("height", height) + attribute("fill", fill) + end_with("rect", title);
}

void Svg::line(SvgPoint from, SvgPoint to, std::string_view stroke, double width,
               std::string_view dash) {
  text_ += "<line" + attribute("x1", from.x) + attribute("y1", from.y) + attribute("x2", to.x) +
           attribute("y2", to.y) + attribute("stroke", stroke) + attribute("stroke-width", width) +
           attribute("stroke-dasharray", dash) + "/>\n";
}

void Svg::path(std::string_view d, std::string_view stroke, double width, std::string_view dash) {
  text_ += "<path fill=\"none\"" + attribute("d", d) + attribute("stroke", stroke) +
           attribute("stroke-width", width) + attribute("stroke-dasharray", dash) + "/>\n";
}

void Svg::circle(SvgPoint at, double radius, std::string_view fill, std::string_view title) {
  text_ += "<circle" + attribute("cx", at.x) + attribute("cy", at.y) + attribute("r", radius) +
           attribute("fill", fill) + end_with("circle", title);
}

void Svg::text(SvgPoint at, std::string_view words, SvgAnchor anchor) {
  const std::string_view where = anchor == SvgAnchor::start    ? ""
                                 : anchor == SvgAnchor::middle ? "middle"
                                                               : "end";
  text_ += "<text" + attribute("x", at.x) + attribute("y", at.y) + attribute("text-anchor", where) +
           ">" + escaped(words) + "</text>\n";
}

double round_step(double range, int pieces) {
  if (!(range > 0)) return 1;
  const double least = range / pieces;
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least) return factor * power;
  }
  return 10 * power;
}

}  // namespace meshfarm
