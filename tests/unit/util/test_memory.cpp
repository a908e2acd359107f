// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>

#include <doctest/doctest.h>

#include <meshfarm/util/memory.hpp>

namespace meshfarm {
namespace {

TEST_CASE("memory in use grows by what is touched, and some is left") {
  CHECK(available_memory() > (std::uint64_t{1} << 20));
  const std::uint64_t before = resident_memory();
  const std::string touched(std::size_t{64} << 20, 'x');
  CHECK(resident_memory() >= before + (std::uint64_t{60} << 20));
  CHECK(touched.back() == 'x');
}

TEST_CASE("a limit on the cores is none or a number above 0") {
  CHECK(cpu_limit() >= 0);
  CHECK(cpu_limit() < 100'000);
}

}  // namespace
}  // namespace meshfarm
