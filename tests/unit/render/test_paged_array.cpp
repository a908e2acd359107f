// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/util/errors.hpp>

#include "render/paged_array.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

TEST_CASE("an array in a scratch file is one in memory, in whatever order it is used") {
  constexpr std::uint64_t k_count = 100'001;
  constexpr std::uint64_t k_stride = 70'003;  // coprime to k_count
  const test::TempFolder folder;
  for (const std::uint64_t memory : {std::uint64_t{0}, std::uint64_t{1} << 20}) {
    CAPTURE(memory);
    PagedArray<std::uint32_t> array(k_count, {folder.path(), memory});
    REQUIRE(array.size() == k_count);
    {
      PagedArray<std::uint32_t>::View view(array);
      CHECK(view.get(k_count - 1) == 0);
      for (std::uint64_t i = 0; i < k_count; ++i) {
        const std::uint64_t at = i * k_stride % k_count;
        view.set(at, view.get(at) + static_cast<std::uint32_t>(at));
      }
      view.flush();
    }
    array.write(k_count - 2, std::vector<std::uint32_t>{7, 8});
    PagedArray<std::uint32_t>::View view(array);
    std::uint64_t wrong = 0;
    for (std::uint64_t i = 0; i + 2 < k_count; ++i) wrong += view.get(i) == i ? 0 : 1;
    CHECK(wrong == 0);
    CHECK(view.get(k_count - 2) == 7);
    CHECK(view.get(k_count - 1) == 8);
  }
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("a scratch file that cannot be made is an error") {
  const test::TempFolder folder;
  CHECK_THROWS_AS(PagedArray<int>(1000, {folder / "none", 100}), IoError);
}
