// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <numeric>
#include <string>

#include <doctest/doctest.h>

#include <meshfarm/util/bucket_file.hpp>
#include <meshfarm/util/memory.hpp>

#include "support/temp_folder.hpp"

using namespace meshfarm;

TEST_CASE("buckets give back what each was given, through full buffers and past the memory") {
  const test::TempFolder folder;
  std::uint64_t memory_bytes = 0;
  SUBCASE("all in the file") {}
  SUBCASE("some in memory") {
    memory_bytes = 345'678;
  }
  SUBCASE("all in memory") {
    memory_bytes = 800'000;
  }
  BucketFile buckets(folder.path(), 10'000, memory_bytes);  // the smallest buffers
  for (std::uint32_t i = 0; i < 200'000; ++i) buckets.put(i % 7, i);
  buckets.finish();
  for (std::uint32_t b = 0; b < 7; ++b) {
    const auto values = buckets.read<std::uint32_t>(b);
    REQUIRE(values.size() == (200'000 - b + 6) / 7);
    for (std::uint32_t i = 0; i < values.size(); ++i) {
      if (values[i] != i * 7 + b) FAIL("bucket " << b << " at " << i);
    }
  }
  CHECK(buckets.read<std::uint32_t>(9999).empty());
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("what is larger than a buffer is not held") {
  constexpr std::size_t k_large = std::size_t{16} << 20;
  const test::TempFolder folder;
  BucketFile buckets(folder.path(), 8);
  std::string bytes(k_large, 'a');
  const std::uint64_t before = resident_memory();
  for (std::uint32_t b = 0; b < 8; ++b) {
    buckets.put(b, std::uint64_t{b});
    bytes.back() = static_cast<char>('a' + b);
    buckets.append(b, bytes);
    buckets.put(b, std::uint64_t{7});
  }
  CHECK(resident_memory() < before + k_large);
  buckets.finish();
  for (std::uint32_t b = 0; b < 8; ++b) {
    CHECK(buckets.read_one<std::uint64_t>(b, 0) == b);
    const auto values = buckets.read<char>(b);
    REQUIRE(values.size() == k_large + 16);
    CHECK(values[k_large + 6] == 'a');
    CHECK(values[k_large + 7] == static_cast<char>('a' + b));
    CHECK(values[k_large + 8] == 7);
  }
  CHECK(std::filesystem::is_empty(folder.path()));
}
