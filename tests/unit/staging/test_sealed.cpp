// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/errors.hpp>

using namespace meshfarm;

namespace {

constexpr FileKind k_kind = {'T', 'E', 'S', 'T'};

}  // namespace

TEST_CASE("a sealed payload comes back") {
  for (const std::string& payload :
       {std::string(), std::string("payload"), std::string(5000, 'p')}) {
    const std::string file = seal(k_kind, 1, payload);
    CHECK(unseal(file, k_kind, 1, "file") == payload);
  }
}

TEST_CASE("every flipped bit and every cut is noticed") {
  const std::string file = seal(k_kind, 1, "some payload");
  for (std::size_t i = 0; i < file.size(); ++i) {
    std::string damaged = file;
    damaged[i] = static_cast<char>(damaged[i] ^ (1 << (i % 8)));
    CAPTURE(i);
    CHECK_THROWS_AS(unseal(damaged, k_kind, 1, "file"), DataError);
    CHECK_THROWS_AS(unseal(file.substr(0, i), k_kind, 1, "file"), DataError);
  }
  CHECK_THROWS_AS(unseal(file + "x", k_kind, 1, "file"), DataError);
}

TEST_CASE("a file of another kind or version is refused by name") {
  const std::string file = seal(k_kind, 2, "");
  CHECK_THROWS_WITH_AS(unseal(file, {'P', 'A', 'R', 'T'}, 2, "parts/000001.part"),
                       "parts/000001.part: a 'TEST' file where a 'PART' file is wanted at byte 8",
                       DataError);
  CHECK_THROWS_WITH_AS(unseal(file, k_kind, 1, "f"),
                       "f: format version 2 is unknown to this meshfarm at byte 12", DataError);
}
