// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <array>

#include <doctest/doctest.h>

#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

using namespace meshfarm;

TEST_CASE("a reader gives back what the writer took") {
  ByteWriter out;
  out.put(std::uint16_t{0xbeef});
  out.put_string("stage");
  const std::array<std::uint32_t, 3> numbers = {1, 2, 0xffffffff};
  out.put_array(std::span<const std::uint32_t>(numbers));
  out.put(-0.5);

  ByteReader in(out.bytes(), "test");
  CHECK(in.get<std::uint16_t>() == 0xbeef);
  CHECK(in.get_string() == "stage");
  CHECK(in.get_array<std::uint32_t>(3) == std::vector<std::uint32_t>{1, 2, 0xffffffff});
  CHECK(in.get<double>() == -0.5);
  CHECK_NOTHROW(in.expect_end());
}

TEST_CASE("a reader refuses whatever runs past the end") {
  ByteWriter out;
  out.put(std::uint32_t{0xffffffff});  // a string's length: 4 GiB that do not exist
  ByteReader string(out.bytes(), "test");
  CHECK_THROWS_WITH_AS(string.get_string(), "test: cut short at byte 4", DataError);

  ByteReader array(out.bytes(), "test");
  CHECK_THROWS_AS(array.get_array<std::uint64_t>(std::uint64_t{1} << 61), DataError);

  ByteReader rest(out.bytes(), "test");
  rest.get<std::uint16_t>();
  CHECK_THROWS_WITH_AS(rest.expect_end(), "test: 2 bytes too many at byte 2", DataError);
  CHECK_THROWS_AS(rest.get<std::uint32_t>(), DataError);
}

TEST_CASE("a checksum by pieces is that of the whole") {
  const std::string text(10'000, 'x');
  Checksum sum;
  sum.add(std::string_view(text).substr(0, 1));
  sum.add(std::string_view(text).substr(1));
  CHECK(sum.value() == checksum(text));
  CHECK(checksum("a") != checksum("b"));
  CHECK(to_hex(0xabc) == "0000000000000abc");
}
