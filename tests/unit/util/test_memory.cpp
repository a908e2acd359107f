// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>

#include <doctest/doctest.h>

#include <meshfarm/util/memory.hpp>

namespace meshfarm {
namespace {

TEST_CASE("memory in use grows by what is touched, and some is left") {
  const auto room = available_memory();
  REQUIRE(room);
  CHECK(room->bytes > (std::uint64_t{1} << 20));
  CHECK(room->pool != 0);
  const std::uint64_t before = resident_memory();
  const std::string touched(std::size_t{64} << 20, 'x');
  CHECK(resident_memory() >= before + (std::uint64_t{60} << 20));
  CHECK(touched.back() == 'x');
}

}  // namespace
}  // namespace meshfarm
