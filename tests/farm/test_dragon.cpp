// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The main job on a real scan: the Stanford dragon, if scripts/get-dragon.sh has fetched it. It has
// 2,100 coincident vertices, 151 loose pieces and 4,270 border edges; once welded, it is a single
// closed surface.
#include <algorithm>
#include <cstdlib>

#include <doctest/doctest.h>

#include "support/process.hpp"
#include "support/temp_folder.hpp"

using meshfarm::test::Ran;
using meshfarm::test::run_meshfarm;

namespace {

const std::filesystem::path k_dragon =
    std::filesystem::path(MESHFARM_SOURCE_DIR) / "data" / "dragon_vrip.ply.gz";

/// The number after `"name": ` in the part of a JSON text that follows `after`.
double number_in(const std::string& json, const std::string& after, const std::string& name) {
  const std::size_t start = json.find("\"" + after + "\"");
  const std::size_t at = json.find("\"" + name + "\": ", start);
  REQUIRE(start != std::string::npos);
  REQUIRE(at != std::string::npos);
  return std::strtod(json.c_str() + at + name.size() + 4, nullptr);
}

}  // namespace

TEST_CASE("the dragon to 1 %: closed, one piece, its tunnels kept, and close to the scan" *
          doctest::skip(!std::filesystem::exists(k_dragon))) {
  const meshfarm::test::TempFolder folder;
  const std::string output = (folder.path() / "dragon.ply").string();
  const Ran ran = run_meshfarm({"simplify", k_dragon.string(), "-o", output, "--ratio", "0.01",
                                "--workers", "2", "--json", "--quiet"},
                               folder.path() / "simplify");
  CHECK(ran.err == "");
  REQUIRE(ran.code == 0);
  CHECK(number_in(ran.out, "input", "triangles") == 871'414);
  CHECK(number_in(ran.out, "input", "coincident_vertices") == 2'100);
  CHECK(number_in(ran.out, "output", "triangles") == 8'712);  // 1 % is 8,713, which is odd
  const double told = number_in(ran.out, "error", "rms");

  const Ran compared =
      run_meshfarm({"compare", k_dragon.string(), output, "--json"}, folder.path() / "compare");
  REQUIRE(compared.code == 0);
  CHECK(number_in(compared.out, "topology_b", "components") == 1);
  CHECK(number_in(compared.out, "topology_b", "euler") == -108);
  CHECK(number_in(compared.out, "topology_b", "border_edges") == 0);
  CHECK(number_in(compared.out, "topology_b", "nonmanifold_edges") == 0);
  CHECK(number_in(compared.out, "topology_b", "orientation_conflicts") == 0);
  CHECK(number_in(compared.out, "topology_b", "degenerate") == 0);
  CHECK(number_in(compared.out, "topology_b", "zero_area") == 0);
  CHECK(number_in(compared.out, "topology_b", "duplicate") == 0);
  const double measured = number_in(compared.out, "a_to_b", "rms");
  CHECK(measured < 3.3e-4);
  const double back = number_in(compared.out, "b_to_a", "rms");
  CHECK(back < 3.3e-4);
  // The summary must report the error that was measured here.
  CHECK(told == doctest::Approx(std::max(measured, back)).epsilon(0.05));
}
