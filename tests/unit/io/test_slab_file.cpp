// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <limits>

#include <doctest/doctest.h>

#include <meshfarm/io/part_file.hpp>
#include <meshfarm/io/slab_file.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/damage.hpp"
#include "support/meshes.hpp"

using namespace meshfarm;

namespace {

MeshShare sample_slab(const Mesh& mesh, PositionType type) {
  MeshShare slab;
  slab.type = type;
  for (const Vec3& p : mesh.positions) slab.positions.push_back(rounded(p, type));
  slab.triangles = mesh.triangles;
  slab.boundary = {0, 2, 3};
  slab.positions[1] = slab.positions[0];
  slab.apart = {{0, 1}, {1, 0}, {3, 2}};
  return slab;
}

}  // namespace

TEST_CASE("a slab comes back in the order it had, in both kinds of positions") {
  for (const PositionType type : {PositionType::float32, PositionType::float64}) {
    const MeshShare slab = sample_slab(test::icosphere(2), type);
    const MeshShare back = decode_slab(encode_slab(slab), "slab");
    CHECK(back.positions == slab.positions);
    CHECK(back.triangles == slab.triangles);
    CHECK(back.boundary == slab.boundary);
    CHECK(back.apart == slab.apart);
    CHECK(back.type == type);
  }
  CHECK(decode_slab(encode_slab({}), "slab").positions.empty());
}

TEST_CASE("a slab that is damaged, or another file, is refused") {
  const std::string file = encode_slab(sample_slab(test::tetrahedron(), PositionType::float32));
  test::check_refuses_damage(file,
                             [](std::string_view bytes) { return decode_slab(bytes, "slab"); });
  CHECK_THROWS_AS(decode_slab(encode_part({}), "slab"), DataError);
}

TEST_CASE("a slab that does not fit together is refused, though its checksum is right") {
  const MeshShare good = sample_slab(test::tetrahedron(), PositionType::float32);
  const auto refuses = [](const MeshShare& slab) {
    CHECK_THROWS_AS(decode_slab(encode_slab(slab), "slab"), DataError);
  };
  MeshShare bad = good;
  bad.triangles[1][2] = 4;
  refuses(bad);
  bad = good;
  bad.positions[3].z = std::numeric_limits<double>::infinity();
  refuses(bad);
  for (const std::vector<std::uint32_t>& boundary :
       {std::vector<std::uint32_t>{4}, {2, 1}, {1, 1}}) {
    bad = good;
    bad.boundary = boundary;
    refuses(bad);
  }
  for (const std::vector<ApartVertex>& apart :
       {std::vector<ApartVertex>{{4, 0}}, {{2, 0}, {1, 0}}, {{0, 1}}, {{0, 0}, {2, 0}}}) {
    bad = good;
    bad.apart = apart;
    refuses(bad);
  }
}

TEST_CASE("a slab's appearances come back") {
  MeshShare slab = sample_slab(test::icosphere(1), PositionType::float32);
  slab.appearances = test::appearances(slab.positions.size());
  const MeshShare back = decode_slab(encode_slab(slab), "slab");
  CHECK(back.appearances == slab.appearances);
  CHECK(back.positions == slab.positions);
  CHECK(back.apart == slab.apart);
}
