// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string_view>

#include <doctest/doctest.h>

#include "io/text_numbers.hpp"

using namespace meshfarm;

TEST_CASE("a float holds the digits of a text if it differs by half of its last digit") {
  struct Case {
    double near;
    double value;
    std::string_view text;
    bool holds;
  };
  const Case cases[] = {
      {1.25004, 1.25, "1.2500000", false},         // half a digit is 5e-8
      {1.25000004, 1.25, "1.2500000", true},       //
      {-1.25000004, -1.25, "-1.2500000", true},    //
      {12345678.4, 12345678, "12345678", true},    // no point: half of one
      {12345678.6, 12345678, "12345678", false},   //
      {12345678.4, 12345678, "12345678.", true},   // nothing behind it
      {12345678.6, 12345678, "12345678.", false},  //
      {1250.04, 1250, "1.25000e3", false},         // half a digit is 5e-3
      {1250.004, 1250, "1.25000E3", true},         //
      {1250.004, 1250, "1.25000e+3", true},        //
      {0.12500004, 0.125, "1.250000e-1", true},    //
      {0.1250004, 0.125, "1.250000e-1", false},    //
      {0.1250004, 0.125, "0.1250", true},          // so short that any float does
  };
  for (const Case& c : cases) {
    CAPTURE(c.text);
    CHECK(holds_digits(c.near, c.value, c.text) == c.holds);
  }
}
