// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/io/png_file.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

#include "io/picture.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

TEST_CASE("a PNG file holds the texels that were written, with and without alpha") {
  const test::TempFolder folder;
  for (const std::size_t step : {std::size_t{3}, std::size_t{4}}) {
    CAPTURE(step);
    Texels texels{.width = 5, .height = 3, .step = step, .bytes = {}};
    texels.bytes.resize(5 * 3 * step, 200);
    texels.at(4, 2)[1] = 17;
    const std::vector<std::uint8_t> bytes = texels.bytes;
    write_png(folder / "a.png", texels);
    const Picture read = decode_picture(read_file(folder / "a.png"));
    CHECK(read.width == 5);
    CHECK(read.height == 3);
    REQUIRE(read.step == step);
    CHECK(read.texels == bytes);
  }
}

TEST_CASE("a PNG file that cannot be written is an error, and nothing is left") {
  const test::TempFolder folder;
  const Texels texels{.width = 1, .height = 1, .step = 3, .bytes = {1, 2, 3}};
  CHECK_THROWS_AS(write_png(folder / "none" / "a.png", texels), IoError);
  CHECK_THROWS_AS(write_png(folder / "a.png", Texels{}), DataError);
  CHECK(std::filesystem::is_empty(folder.path()));
}
