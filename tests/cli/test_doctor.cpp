// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// 'meshfarm doctor' on folders of this machine; tests/lab tries it on real NFS mounts.
#include <doctest/doctest.h>

#include "support/process.hpp"
#include "support/temp_folder.hpp"

using meshfarm::test::Ran;
using meshfarm::test::run_meshfarm;
using meshfarm::test::TempFolder;

TEST_CASE("the doctor looks at a folder, a stage, and what is neither") {
  const TempFolder folder;
  const auto path = [&](const std::string& name) { return (folder.path() / name).string(); };
  Ran ran = run_meshfarm({"doctor", folder.path().string()}, path("log1"));
  CHECK(ran.code == 0);
  CHECK(ran.out.find("nothing is cut yet") != std::string::npos);

  REQUIRE(run_meshfarm({"generate", "-o", path("mesh.ply"), "--triangles", "2000"}, path("log2"))
              .code == 0);
  REQUIRE(run_meshfarm({"cut", path("mesh.ply"), "--stage", path("stage")}, path("log3")).code ==
          0);
  ran = run_meshfarm({"doctor", path("stage"), "--json"}, path("log4"));
  CHECK(ran.code == 0);
  CHECK(ran.out.find("\"healthy\": true") != std::string::npos);
  CHECK(ran.out.find("\"sync_ms\"") != std::string::npos);
  CHECK(std::filesystem::is_empty(folder.path() / "stage" / "results"));

  ran = run_meshfarm({"doctor", path("stage"), "--workers", "10000000"}, path("log5"));
  CHECK(ran.code == 1);
  CHECK(ran.out.find("BAD   open files") != std::string::npos);

  ran = run_meshfarm({"doctor", path("absent")}, path("log6"));
  CHECK(ran.code == 1);
  CHECK(ran.err == "meshfarm doctor: error: " + path("absent") + ": no such folder\n");
}
