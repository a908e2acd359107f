// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Which vertices become one.
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "support/shell.hpp"

using meshfarm::test::has;
using meshfarm::test::Ran;
using meshfarm::test::Shell;

TEST_CASE("info and compare weld, and hold no more than they are given") {
  Shell shell;
  const std::string torus = shell.path("t.ply"), coarse = shell.path("s.ply");
  CHECK(shell({"generate", "-o", torus, "--triangles", "20000"}).code == 0);
  CHECK(shell({"simplify", torus, "-o", coarse, "--triangles", "2000", "-q"}).code == 0);
  const std::string seam = shell.file("seam.ply",
                                      "ply\nformat ascii 1.0\nelement vertex 6\n"
                                      "property float x\nproperty float y\nproperty float z\n"
                                      "element face 2\nproperty list uchar int vertex_indices\n"
                                      "end_header\n0 0 0\n1 0 0\n0 1 0\n1 0 0\n1 1 0\n0 1 0\n"
                                      "3 0 1 2\n3 3 4 5\n");
  const Ran info = shell({"info", seam});
  const std::size_t welded = info.out.find("welded (2 coincident vertices merged): 1 component,");
  REQUIRE(welded != std::string::npos);
  CHECK(info.out.find("as it is: 2 components") > welded);
  CHECK(info.out.find("as it is: 2 components") != std::string::npos);
  CHECK(has(shell({"info", seam, "--json"}).out, "\"topology_not_welded\""));
  // In many slabs, through scratch files.
  const Ran little = shell({"info", torus, "--memory", "100K"});
  CHECK(has(little.out, "1 component, 0 border edges, 0 non-manifold edges"));
  CHECK_FALSE(has(little.out, "welded"));
  const auto rms_of = [](const Ran& ran) {
    const std::size_t at = ran.out.find("rms ");
    return at == std::string::npos ? 0.0 : std::stod(ran.out.substr(at + 4));
  };
  const Ran held = shell({"compare", torus, coarse, "--samples", "20000"});
  const Ran divided = shell({"compare", torus, coarse, "--samples", "20000", "--memory", "100K"});
  CHECK(divided.code == 0);
  CHECK(rms_of(held) > 0);
  CHECK(std::abs(rms_of(divided) / rms_of(held) - 1) < 0.05);
  CHECK(shell({"info", torus, "--memory", "0"}).code == 2);
}

TEST_CASE("corners that hardly miss each other are merged, as far as asked for") {
  Shell shell;
  std::ostringstream stl;
  stl.precision(9);
  stl << "solid sheet\n";
  int corners = 0;
  const auto corner = [&](int x, int y) {
    stl << "vertex " << x + 1e-6 * (corners * 13 % 7) << ' ' << y << ' '
        << std::sin(0.2 * x) + 1e-6 * (corners * 5 % 3) << '\n';
    ++corners;
  };
  const auto triangle = [&](const std::array<std::array<int, 2>, 3>& t) {
    stl << "facet normal 0 0 0\nouter loop\n";
    for (const auto& [x, y] : t) corner(x, y);
    stl << "endloop\nendfacet\n";
  };
  for (int x = 0; x < 40; ++x) {
    for (int y = 0; y < 40; ++y) {
      triangle({{{x, y}, {x + 1, y}, {x + 1, y + 1}}});
      triangle({{{x, y}, {x + 1, y + 1}, {x, y + 1}}});
    }
  }
  stl << "endsolid\n";
  const std::string sheet = shell.file("sheet.stl", stl.str()), out = shell.path("out.ply");
  CHECK(has(shell({"info", sheet}).out, "corners that belong together are up to "));
  const auto simplify = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"simplify", sheet, "-o", out};
    words.insert(words.end(), more.begin(), more.end());
    return shell(words);
  };
  const auto pieces = [&] {
    const std::string text = shell({"info", out}).out;
    const std::size_t at = text.find(" component");
    REQUIRE(at != std::string::npos);
    return text.substr(text.rfind(' ', at - 1) + 1, at - text.rfind(' ', at - 1) - 1);
  };
  for (const char* scheme : {"cut", "stream"}) {
    CAPTURE(scheme);
    const Ran merged = simplify({"--triangles", "300", "--scheme", scheme});
    CHECK(merged.code == 0);
    CHECK(has(merged.err, "--weld exact leaves them as they are"));
    CHECK(has(merged.out, " moved onto others up to "));
    CHECK(pieces() == "1");
  }
  const Ran apart = simplify({"--ratio", "1", "--weld", "exact"});
  CHECK(apart.code == 0);
  CHECK_FALSE(has(apart.err, "merged"));
  CHECK(pieces() != "1");
  // 2e-5 is more than the jitter; 1e-7 is less.
  CHECK(simplify({"--ratio", "1", "--weld", "2e-5"}).code == 0);
  CHECK(pieces() == "1");
  CHECK(simplify({"--ratio", "1", "--weld", "1e-7"}).code == 0);
  CHECK(pieces() != "1");
  // A promise of less error than the merge would make is kept.
  const Ran bounded = simplify({"--error", "1e-7"});
  CHECK(bounded.code == 0);
  CHECK(has(bounded.err, "warning: "));
  CHECK(has(bounded.err, "not merged, as --error is so small"));
  CHECK_FALSE(has(simplify({"--error", "0.1"}).err, "warning: "));
  const Ran far = simplify({"--ratio", "0.5", "--weld", "1"});
  CHECK(far.code == 2);
  CHECK(has(far.err, "--weld 1: more than 1% of the diagonal"));
  const Ran farmed = simplify({"--ratio", "0.5", "--cut", "farm"});
  CHECK(farmed.code == 2);
  CHECK(has(farmed.err, "--cut here merges them"));
}
