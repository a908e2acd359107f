// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <doctest/doctest.h>

#include <meshfarm/util/errors.hpp>

namespace meshfarm::test {

/// Checks that `decode` refuses every prefix and every single flipped bit.
template <class Decode>
void check_refuses_damage(const std::string& file, Decode decode) {
  for (std::size_t i = 0; i < file.size(); ++i) {
    CAPTURE(i);
    CHECK_THROWS_AS(decode(std::string_view(file).substr(0, i)), DataError);
    std::string damaged = file;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    CHECK_THROWS_AS(decode(damaged), DataError);
  }
}

}  // namespace meshfarm::test
