// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "report/page_html.hpp"

#include "report/svg.hpp"

namespace meshfarm {

std::string base64(std::string_view bytes) {
  constexpr std::string_view k_letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      bits = bits << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? k_letters[bits >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

std::string html_of(const PagePicture& picture, std::string_view what) {
  return "<img width=\"" + std::to_string(picture.width) + "\" height=\"" +
         std::to_string(picture.height) + "\" alt=\"" + escaped(what) +
         "\" src=\"data:image/png;base64," + base64(picture.png) + "\">";
}

std::string figure_of(const PagePicture& picture, std::string_view what, std::string_view caption) {
  if (picture.png.empty()) return {};
  return "<figure>" + html_of(picture, what) + "<figcaption>" + escaped(caption) +
         "</figcaption></figure>\n";
}

std::string row_of(const std::vector<std::string>& cells, const char* tag) {
  std::string text = "<tr>";
  for (const std::string& cell : cells) {
    text += "<" + std::string(tag) + ">" + escaped(cell) + "</" + std::string(tag) + ">";
  }
  return text + "</tr>\n";
}

std::string css_of(const std::array<std::uint8_t, 3>& colour) {
  constexpr std::string_view k_digits = "0123456789abcdef";
  std::string text = "#";
  for (const std::uint8_t level : colour) {
    text += k_digits[level >> 4];
    text += k_digits[level & 15];
  }
  return text;
}

}  // namespace meshfarm
