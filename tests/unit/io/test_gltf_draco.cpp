// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>

#ifdef MESHFARM_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif

#include "gltf_test_files.hpp"
#include "uv_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

/// The square of k_square_vertices, with only `packed` in the binary chunk.
std::string draco_glb(const std::string& packed, std::size_t points, std::size_t corners = 6) {
  const std::string json =
      R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":2,"COLOR_0":3},)"
      R"("indices":1,"mode":5,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,)"
      R"("attributes":{"POSITION":0,"TEXCOORD_0":1,"COLOR_0":2}}}}]}],"accessors":[)"
      R"({"componentType":5126,"count":)" +
      std::to_string(points) + R"(,"type":"VEC3"},{"componentType":5123,"count":)" +
      std::to_string(corners) + R"(,"type":"SCALAR"},{"componentType":5126,"count":)" +
      std::to_string(points) +
      R"(,"type":"VEC2"},{"componentType":5121,"normalized":true,"count":)" +
      std::to_string(points) +
      R"(,"type":"VEC4"}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":)" +
      std::to_string(packed.size()) + R"(}],"buffers":[{"byteLength":)" +
      std::to_string(packed.size()) + "}]}";
  return glb_file(json, packed);
}

}  // namespace

#ifdef MESHFARM_DRACO

namespace {

struct Packed {
  std::string bytes;
  std::size_t points = 0;
};

/// The square; each vertex is at (x, y) of the picture, and its red is its number.
Packed packed_square(draco::MeshEncoderMethod method) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int positions =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int places =
      builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
  const int colours = builder.AddAttribute(draco::GeometryAttribute::COLOR, 4, draco::DT_UINT8);
  for (std::uint32_t i = 0; i < 2; ++i) {
    std::array<std::array<float, 3>, 3> points{};
    std::array<std::array<float, 2>, 3> uvs{};
    std::array<std::array<std::uint8_t, 4>, 3> levels{};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = k_square_triangles[i][k];
      const Vec3 p = k_square_vertices[vertex];
      points[k] = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
      uvs[k] = {points[k][0], points[k][1] / 4};
      levels[k] = {static_cast<std::uint8_t>(vertex), 0, 0, 255};
    }
    const draco::FaceIndex face(i);
    const auto set = [&](int attribute, const auto& values) {
      builder.SetAttributeValuesForFace(attribute, face, values[0].data(), values[1].data(),
                                        values[2].data());
    };
    set(positions, points);
    set(places, uvs);
    set(colours, levels);
  }
  const auto mesh = builder.Finalize();
  REQUIRE(mesh);
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  draco::EncoderBuffer buffer;
  REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {{buffer.data(), buffer.size()}, mesh->num_points()};
}

std::string told(const std::string& glb) {
  const UvModel model("m.glb", glb);
  return error_of([&] { triangles_of(*model.open()); });
}

}  // namespace

TEST_CASE("a GLB that Draco compressed is read, whatever the method") {
  for (const auto method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
    const Packed packed = packed_square(method);
    const UvModel model("m.glb", draco_glb(packed.bytes, packed.points));
    const auto source = model.open();
    CHECK(source->info().uvs);
    CHECK(source->info().skipped.empty());
    std::vector<Vec3> points;
    source->scan_vertices([&](std::span<const Vec3> batch) {
      points.insert(points.end(), batch.begin(), batch.end());
    });
    REQUIRE(points.size() == 4);
    const UvTriangles read = triangles_of(*source);
    REQUIRE(read.corners.size() == 2);
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 p = points[read.corners[i][k]];
        CHECK(std::count(k_square_vertices.begin(), k_square_vertices.end(), p) == 1);
        CHECK(read.uvs[i][k] == Uv{static_cast<float>(p.x), 1 - static_cast<float>(p.y) / 4});
      }
    }
    std::size_t seen = 0;
    source->scan_channels([&](const ChannelPoints& batch) {
      for (std::size_t i = 0; i < batch.points.size(); ++i, ++seen) {
        const auto at =
            std::find(k_square_vertices.begin(), k_square_vertices.end(), batch.points[i]);
        // Linear levels are converted to sRGB.
        CHECK((batch.values[4 * i] > 1) == (at != k_square_vertices.begin()));
        CHECK(batch.values[4 * i + 3] == 255);
      }
    });
    CHECK(seen == 4);
  }
}

TEST_CASE("what Draco compressed is refused if it is malformed, or does not fit") {
  const Packed packed = packed_square(draco::MESH_EDGEBREAKER_ENCODING);
  CHECK(told(draco_glb("no Draco at all.", 4)).find("is malformed") != std::string::npos);
  for (std::size_t bytes = 0; bytes < packed.bytes.size(); ++bytes) {
    CHECK(told(draco_glb(packed.bytes.substr(0, bytes), packed.points)) != "no error");
  }
  CHECK(told(draco_glb(packed.bytes, packed.points + 1)).find("are compressed for it") !=
        std::string::npos);
  CHECK(told(draco_glb(packed.bytes, packed.points, 9)) ==
        "m.glb: accessors[1] has 9 elements, but 6 are compressed for it");
  CHECK(told(with(draco_glb(packed.bytes, packed.points), R"("TEXCOORD_0":1)", R"("TEXCOORD_0":9)"))
            .find("is no attribute of what is compressed") != std::string::npos);
  CHECK(told(with(draco_glb(packed.bytes, packed.points), "VEC2", "VEC4")).find("another type") !=
        std::string::npos);
}

TEST_CASE("Draco takes no memory for triangles that a few bytes tell of") {
  // An edgebreaker's head, then vertices, triangles, one attribute, symbols and splits.
  const std::string head("DRACO\2\2\1\1\0\0\0", 12);
  const std::string many = "\x80\x80\x80\x80\4";  // 2^30
  const std::string bytes = head + many + many + "\1" + many + std::string(9, '\0');
  CHECK(told(draco_glb(bytes, 4)) ==
        "m.glb: accessors[1] has 6 elements, but 3221225472 are compressed for it");
  CHECK(told(draco_glb(bytes, 4, std::size_t{3} << 30)).find("tells of 1073741824 triangles in") !=
        std::string::npos);
  std::string old = bytes;
  old[6] = 1;
  CHECK(told(draco_glb(old, 4)).find("is of version 2.1 of Draco's format; glTF has 2.2") !=
        std::string::npos);
}

#else

TEST_CASE("a build without Draco says so") {
  const UvModel model("m.glb", draco_glb("1234", 4));
  CHECK(error_of([&] { model.open(); }).find("built without") != std::string::npos);
}

#endif
