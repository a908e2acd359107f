// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <filesystem>

#include "io/files_beside.hpp"
#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

TEST_CASE("files that other systems named are found beside a mesh, and nowhere else") {
  const TempFolder folder;
  std::filesystem::create_directory(folder / "model");
  std::filesystem::create_directory(folder / "model/maps");
  write_file(folder / "outside.png", "0");
  write_file(folder / "model/a b.png", "1");
  write_file(folder / "model/maps/C.JPG", "22");
  const auto found = [&](std::string_view name) {
    const auto path = find_beside(folder / "model", name);
    return path ? path->lexically_relative(folder / "model").string() : "";
  };
  CHECK(found("a b.png") == "a b.png");
  CHECK(found("maps/C.JPG") == "maps/C.JPG");
  CHECK(found("maps\\C.JPG") == "maps/C.JPG");
  CHECK(found("maps\\c.jpg") == "maps/C.JPG");
  CHECK(found("D:\\work\\a b.png") == "a b.png");
  CHECK(found("/home/other/A B.PNG") == "a b.png");
  CHECK(found("D:\\work\\maps\\c.jpg") == "maps/C.JPG");
  CHECK(found("/home/other/model/maps/C.JPG") == "maps/C.JPG");
  CHECK(found("../maps/C.JPG") == "maps/C.JPG");
  CHECK(found("/home/other/C.JPG") == "");
  CHECK(found("../outside.png") == "");
  CHECK(found("maps") == "");
  CHECK(found("") == "");
  CHECK(read_beside(folder / "model/maps/C.JPG") == "22");
  CHECK(read_beside(folder / "model/maps/C.JPG", 2) == "22");
  CHECK_THROWS_AS(read_beside(folder / "model/maps/C.JPG", 1), DataError);
}
