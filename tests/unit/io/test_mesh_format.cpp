// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/util/errors.hpp>

using namespace meshfarm;

TEST_CASE("an output is PLY, or has no extension") {
  for (const char* path : {"a.ply", "a.PLY", "folder.obj/a.ply", "a", "folder.obj/a", "a.b.ply"}) {
    INFO(path);
    CHECK_NOTHROW(check_output_format(path));
  }
}

TEST_CASE("an output that would not be what its name says is refused") {
  for (const char* path : {"a.obj", "a.STL", "a.ply.gz", "a.ply.zst", "a.ply/b.glb", "a.plyx"}) {
    INFO(path);
    CHECK_THROWS_AS(check_output_format(path), DataError);
  }
  CHECK_THROWS_WITH(check_output_format("f/a.obj"),
                    "f/a.obj: cannot write .obj; meshfarm writes PLY, not compressed: name the "
                    "output .ply");
}
