// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "render/legend.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include "render/lettering.hpp"

namespace meshfarm {
namespace {

double text_height(std::uint32_t picture_height) {
  return std::clamp(picture_height / 60.0, 7.0, 48.0);
}

/// 1, 2 or 5 times a power of ten, giving about five steps.
double round_step(double range) {
  const double rough = range / 5;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10 * power;
}

void fill(Texels& picture, const Frame& box, const Srgb& colour) {
  const auto cut_off = [](double value, std::uint32_t most) {
    return static_cast<std::uint32_t>(std::clamp(std::round(value), 0.0, double{1} * most));
  };
  for (std::uint32_t y = cut_off(box.top, picture.height);
       y < cut_off(box.top + box.height, picture.height); ++y) {
    for (std::uint32_t x = cut_off(box.left, picture.width);
         x < cut_off(box.left + box.width, picture.width); ++x) {
      std::uint8_t* texel = picture.at(x, y);
      std::copy(colour.begin(), colour.end(), texel);
      if (picture.step == 4) texel[3] = 255;
    }
  }
}

}  // namespace

std::uint32_t legend_width(std::uint32_t picture_height) {
  return static_cast<std::uint32_t>(13 * text_height(picture_height));
}

std::string number_text(double value, double step) {
  if (!(step > 0)) step = std::abs(value) / 1e4;
  if (std::abs(value) < step / 1000) value = 0;
  const double size = std::max(std::abs(value), step);
  const int last = step > 0 ? static_cast<int>(std::floor(std::log10(step))) : 0;  // digit's place
  const int first = size > 0 ? static_cast<int>(std::floor(std::log10(size))) : 0;
  const bool is_plain = first < 7 && last > -5;
  if (value == 0 && !is_plain) return "0";
  const int digits = is_plain ? std::max(0, -last) : std::clamp(first - last, 0, 16);
  std::array<char, 64> text{};
  const auto format = is_plain ? std::chars_format::fixed : std::chars_format::scientific;
  const auto made = std::to_chars(text.data(), text.data() + text.size(), value, format, digits);
  return {text.data(), made.ptr};
}

void draw_legend(Texels& picture, const std::string& title, const ValueRange& range,
                 const Srgb& ink) {
  const double text = text_height(picture.height);
  const Frame bar{.left = static_cast<double>(picture.width - legend_width(picture.height)),
                  .top = std::round(picture.height * 0.22),
                  .width = std::round(1.4 * text),
                  .height = std::round(picture.height * 0.56)};
  for (double y = 0; y < bar.height; ++y) {
    const double place = 1 - (y + 0.5) / bar.height;
    fill(picture, {bar.left, bar.top + y, bar.width, 1}, colour_on_scale(place));
  }
  const auto mark = [&](double value, double step) {
    const double y = bar.top + bar.height * (1 - range.place(value));
    fill(picture, {bar.left + bar.width, y - 0.5, std::round(text / 2), 1}, ink);
    draw_text(picture, {bar.left + bar.width + text, y - text / 2, text, ink},
              number_text(value, step));
  };
  const double width = width_of(title, text);
  const double most_left = picture.width - width - text;
  draw_text(picture,
            {std::max(text, std::min(bar.left, most_left)), bar.top - 2.6 * text, text, ink},
            title);
  if (!(range.high > range.low)) return mark(range.low, 0);
  const double step = round_step(range.high - range.low);
  mark(range.low, step / 100);
  mark(range.high, step / 100);
  const double margin = 1.6 * text / bar.height * (range.high - range.low);
  for (double i = std::ceil((range.low + margin) / step); i * step <= range.high - margin; ++i) {
    mark(i * step, step);
  }
}

}  // namespace meshfarm
