// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "render/lettering.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <vector>

namespace meshfarm {
namespace {

constexpr double k_rows = 6;  // of the letters' grid, from the top
constexpr double k_advance = 5.8;
constexpr double k_thickness = 0.62;

/// A letter's lines: grid points as column and row, with blanks between lines.
struct Letter {
  char name;
  std::string_view lines;
};

constexpr Letter k_letters[] = {
    {'0', "103041453616050110"},
    {'1', "021016 0626"},
    {'2', "01103041420646"},
    {'3', "01103041423313 334445361605"},
    {'4', "36300444"},
    {'5', "400003334445361605"},
    {'6', "4130100105163645443303"},
    {'7', "004016"},
    {'8', "103041423313020110 1304051636454433"},
    {'9', "4313020110304145361605"},
    {'A', "062046 1434"},
    {'B', "003041423303000636454433"},
    {'C', "4130100105163645"},
    {'D', "00304145360600"},
    {'E', "40000646 0333"},
    {'F', "400006 0333"},
    {'G', "41301001051636454323"},
    {'H', "0006 4046 0343"},
    {'I', "1030 2026 1636"},
    {'J', "4045361605"},
    {'K', "0006 400346"},
    {'L', "000646"},
    {'M', "0600234046"},
    {'N', "06004640"},
    {'O', "103041453616050110"},
    {'P', "06003041423303"},
    {'Q', "103041453616050110 2446"},
    {'R', "06003041423303 2346"},
    {'S', "4130100102134445361605"},
    {'T', "0040 2026"},
    {'U', "000516364540"},
    {'V', "002640"},
    {'W', "0016233640"},
    {'X', "0046 4006"},
    {'Y', "002340 2326"},
    {'Z', "00400646"},
    {'.', "2526"},
    {',', "2516"},
    {'-', "0343"},
    {'+', "0343 2125"},
    {'_', "0646"},
    {'/', "0640"},
    {'(', "30121436"},
    {')', "10323416"},
    {'%', "0640 0111 3545"},
    {' ', ""},
};

std::string_view lines_of(char character) {
  const char capital = static_cast<char>(std::toupper(static_cast<unsigned char>(character)));
  for (const Letter& letter : k_letters) {
    if (letter.name == capital) return letter.lines;
  }
  return "0040460600";
}

struct Place {
  double x = 0;
  double y = 0;
};
struct Stroke {
  Place from;
  Place to;
};

std::vector<Stroke> strokes_of(char character, const Lettering& lettering, double left) {
  const double unit = lettering.height / k_rows;
  std::vector<Stroke> strokes;
  const std::string_view lines = lines_of(character);
  bool has_last = false;
  Place last;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i] == ' ') {
      has_last = false;
      continue;
    }
    const Place next{left + (lines[i] - '0') * unit, lettering.top + (lines[i + 1] - '0') * unit};
    ++i;
    if (has_last) strokes.push_back({last, next});
    has_last = true;
    last = next;
  }
  return strokes;
}

double distance(Place p, const Stroke& stroke) {
  const double dx = stroke.to.x - stroke.from.x;
  const double dy = stroke.to.y - stroke.from.y;
  const double along = (p.x - stroke.from.x) * dx + (p.y - stroke.from.y) * dy;
  const double share = std::clamp(along / (dx * dx + dy * dy), 0.0, 1.0);
  return std::hypot(p.x - stroke.from.x - share * dx, p.y - stroke.from.y - share * dy);
}

/// Blends this share of the colour over the existing texel.
void blend(std::uint8_t* texel, std::size_t step, const Srgb& colour, double share) {
  const double under = step == 4 ? texel[3] / 255.0 : 1.0;
  const double alpha = share + under * (1 - share);
  if (!(alpha > 0)) return;
  for (std::size_t i = 0; i < 3; ++i) {
    const double mixed = (colour[i] * share + texel[i] * under * (1 - share)) / alpha;
    texel[i] = static_cast<std::uint8_t>(std::lround(mixed));
  }
  if (step == 4) texel[3] = static_cast<std::uint8_t>(std::lround(255 * alpha));
}

void draw_letter(Texels& picture, const Lettering& lettering, const std::vector<Stroke>& strokes,
                 double left) {
  const double half = std::max(1.1, k_thickness * lettering.height / k_rows) / 2;
  const auto cut_off = [](double value, std::uint32_t most) {
    return static_cast<std::uint32_t>(std::clamp(value, 0.0, static_cast<double>(most)));
  };
  const std::uint32_t x_end = cut_off(left + lettering.height + 2, picture.width);
  const std::uint32_t y_end = cut_off(lettering.top + lettering.height + 3, picture.height);
  for (std::uint32_t y = cut_off(lettering.top - 2, picture.height); y < y_end; ++y) {
    for (std::uint32_t x = cut_off(left - 2, picture.width); x < x_end; ++x) {
      double nearest = HUGE_VAL;
      for (const Stroke& stroke : strokes) {
        nearest = std::min(nearest, distance({x + 0.5, y + 0.5}, stroke));
      }
      const double share = std::clamp(half + 0.5 - nearest, 0.0, 1.0);
      if (share > 0) blend(picture.at(x, y), picture.step, lettering.colour, share);
    }
  }
}

}  // namespace

double width_of(std::string_view text, double height) {
  return static_cast<double>(text.size()) * k_advance * height / k_rows;
}

void draw_text(Texels& picture, const Lettering& lettering, std::string_view text) {
  double left = lettering.left;
  for (const char character : text) {
    draw_letter(picture, lettering, strokes_of(character, lettering, left), left);
    left += k_advance * lettering.height / k_rows;
  }
}

}  // namespace meshfarm
