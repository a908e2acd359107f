// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>
#include <string>

#include <doctest/doctest.h>
#include <support/temp_folder.hpp>

#include "io/scratch_array.hpp"

using namespace meshfarm;
using test::TempFolder;

namespace {

/// Sets $TMPDIR during its lifetime.
class ScratchIn {
 public:
  explicit ScratchIn(const std::filesystem::path& folder) {
    const char* before = std::getenv("TMPDIR");
    has_before_ = before != nullptr;
    if (has_before_) before_ = before;
    ::setenv("TMPDIR", folder.c_str(), 1);
  }
  ~ScratchIn() { has_before_ ? ::setenv("TMPDIR", before_.c_str(), 1) : ::unsetenv("TMPDIR"); }
  ScratchIn(const ScratchIn&) = delete;
  ScratchIn& operator=(const ScratchIn&) = delete;

 private:
  bool has_before_ = false;
  std::string before_;
};

}  // namespace

TEST_CASE("an array above its limit is in a scratch file, one below in memory") {
  const TempFolder folder;
  const ScratchIn none(folder / "none");
  CHECK(ScratchArray<std::uint64_t>(8, 64).size() == 8);
  CHECK_THROWS_AS(ScratchArray<std::uint64_t>(9, 64), IoError);
  // The default limit; untouched pages take no memory in either case.
  constexpr std::uint64_t k_most_numbers = ScratchArray<std::uint64_t>::k_most_in_memory / 8;
  CHECK(ScratchArray<std::uint64_t>(k_most_numbers).size() == k_most_numbers);
  CHECK_THROWS_AS(ScratchArray<std::uint64_t>(k_most_numbers + 1), IoError);
}

TEST_CASE("an array in a scratch file keeps what is written when its pages are given back") {
  const TempFolder folder;
  const ScratchIn here(folder.path());
  constexpr std::uint64_t k_count = 100'000;
  ScratchArray<std::uint64_t> array(k_count, 1);
  CHECK(std::filesystem::is_empty(folder.path()));  // the file has no name
  const auto is_zero = [](std::uint64_t item) { return item == 0; };
  CHECK(std::all_of(array.items().begin(), array.items().end(), is_zero));
  for (std::uint64_t i = 0; i < k_count; ++i) array.items()[i * 7919 % k_count] = i;
  array.used(std::size_t{1} << 30);
  bool is_kept = true;
  for (std::uint64_t i = 0; i < k_count; ++i) is_kept &= array.items()[i * 7919 % k_count] == i;
  CHECK(is_kept);
}
