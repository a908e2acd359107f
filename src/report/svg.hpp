// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace meshfarm {

/// Text for a page: HTML markup is escaped.
std::string escaped(std::string_view text);

struct SvgPoint {
  double x = 0;
  double y = 0;
};

enum class SvgAnchor { start, middle, end };

/// An SVG picture that grows element by element. Colours are CSS: "#36c" or "var(--fast)".
class Svg {
 public:
  Svg(double width, double height);

  void rect(SvgPoint at, double width, double height, std::string_view fill,
            std::string_view title = {});
  void line(SvgPoint from, SvgPoint to, std::string_view stroke, double width = 1,
            std::string_view dash = {});
  void path(std::string_view d, std::string_view stroke, double width = 2,
            std::string_view dash = {});
  void circle(SvgPoint at, double radius, std::string_view fill, std::string_view title = {});
  void text(SvgPoint at, std::string_view words, SvgAnchor anchor = SvgAnchor::start);

  /// The element for a page, or for a file of its own.
  std::string str() const { return text_ + "</svg>\n"; }

 private:
  std::string text_;
};

/// The smallest of 1, 2, 5 times a power of ten that divides `range` into at most `pieces`.
double round_step(double range, int pieces);

}  // namespace meshfarm
