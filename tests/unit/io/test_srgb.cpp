// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <initializer_list>
#include <limits>

#include <doctest/doctest.h>

#include "io/srgb.hpp"

using namespace meshfarm;

TEST_CASE("levels of sRGB are those of the standard at 8 bits") {
  for (int i = 0; i < 256; ++i) {
    CAPTURE(i);
    const double level = i / 255.0;
    const double standard =
        level <= 0.04045 ? level / 12.92 : std::pow((level + 0.055) / 1.055, 2.4);
    CHECK(std::abs(linear_of_srgb(level) - standard) < 1e-14);
    CHECK(std::abs(srgb_of_linear(standard) - level) < 1e-12);
  }
}

TEST_CASE("between 8 bits levels of sRGB are near the standard's, and come back") {
  for (int i = 0; i <= 10'000; ++i) {
    CAPTURE(i);
    const double level = i / 1e4;
    const double standard =
        level <= 0.04045 ? level / 12.92 : std::pow((level + 0.055) / 1.055, 2.4);
    CHECK(std::abs(linear_of_srgb(level) - standard) < 1e-5);
    CHECK(std::abs(srgb_of_linear(linear_of_srgb(level)) - level) < 1e-12);
  }
}

TEST_CASE("all 8 bit levels come back by way of 16 linear bits") {
  for (int i = 0; i < 256; ++i) {
    CAPTURE(i);
    const double whole = std::floor(linear_of_srgb(i / 255.0) * 65535 + 0.5);
    CHECK(std::abs(255 * srgb_of_linear(whole / 65535) - i) < 0.05);
  }
}

TEST_CASE("what is no level is clamped to one") {
  for (double (*const curve)(double) : {linear_of_srgb, srgb_of_linear}) {
    CHECK(curve(-1) == 0);
    CHECK(curve(0) == 0);
    CHECK(curve(std::numeric_limits<double>::quiet_NaN()) == 0);
    CHECK(curve(1) == 1);
    CHECK(curve(HUGE_VAL) == 1);
  }
}
