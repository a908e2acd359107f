// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>
#include <malloc.h>
#include <meshoptimizer.h>
#include <support/meshes.hpp>

#include "gltf_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

/// A mesh with compressed buffer views; their buffer, number 1, has a size but no bytes.
struct Compressed {
  std::string json;
  std::string binary;

  std::string glb() const { return glb_file(json, binary); }
};

/// The rows of a buffer view, compressed.
struct PackedRows {
  std::string mode = "ATTRIBUTES";
  std::string filter;
  std::size_t rows = 0;
  std::size_t stride = 0;
  std::string bytes;
  std::string accessor;  // without the view and the count
  std::string more_of_view;
};

PackedRows packed_rows(const void* rows, std::size_t count, std::size_t stride,
                       std::string_view accessor, std::string_view filter = "") {
  std::string bytes(meshopt_encodeVertexBufferBound(count, stride), '\0');
  bytes.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()),
                                          bytes.size(), rows, count, stride));
  return {.filter = std::string(filter),
          .rows = count,
          .stride = stride,
          .bytes = bytes,
          .accessor = std::string(accessor)};
}

constexpr std::string_view k_of_floats = R"("componentType":5126,"type":"VEC3")";

PackedRows packed_positions(const std::vector<Vec3>& positions) {
  std::vector<float> floats;
  for (const Vec3& p : positions) {
    for (const double x : {p.x, p.y, p.z}) floats.push_back(static_cast<float>(x));
  }
  return packed_rows(floats.data(), positions.size(), 12, k_of_floats);
}

PackedRows packed_triangles(const Mesh& mesh, std::string_view mode, std::size_t stride) {
  const std::uint32_t* const corners = mesh.triangles.front().data();
  const std::size_t count = 3 * mesh.triangles.size();
  const std::size_t vertices = mesh.positions.size();
  const bool is_sequence = mode == "INDICES";
  std::string bytes(is_sequence ? meshopt_encodeIndexSequenceBound(count, vertices)
                                : meshopt_encodeIndexBufferBound(count, vertices),
                    '\0');
  auto* const out = reinterpret_cast<unsigned char*>(bytes.data());
  bytes.resize(is_sequence ? meshopt_encodeIndexSequence(out, bytes.size(), corners, count)
                           : meshopt_encodeIndexBuffer(out, bytes.size(), corners, count));
  return {.mode = std::string(mode),
          .filter = "",
          .rows = count,
          .stride = stride,
          .bytes = bytes,
          .accessor = "\"componentType\":" + std::string(stride == 2 ? "5123" : "5125") +
                      R"(,"type":"SCALAR")",
          .more_of_view = ""};
}

std::string view_of(const PackedRows& packed, std::size_t start) {
  const auto number = [](std::size_t value) { return std::to_string(value); };
  const std::string filter = packed.filter.empty() ? "" : R"(,"filter":")" + packed.filter + "\"";
  return R"({"buffer":1,"byteLength":)" + number(packed.rows * packed.stride) +
         packed.more_of_view + R"(,"extensions":{"EXT_meshopt_compression":{"buffer":0,)" +
         R"("byteOffset":)" + number(start) + R"(,"byteLength":)" + number(packed.bytes.size()) +
         R"(,"byteStride":)" + number(packed.stride) + R"(,"mode":")" + packed.mode + "\"" +
         filter + R"(,"count":)" + number(packed.rows) + "}}}";
}

/// A mesh of one primitive; `primitive` names its accessors.
Compressed compressed(const std::vector<PackedRows>& all,
                      std::string_view primitive = R"("attributes":{"POSITION":0},"indices":1)") {
  Compressed made;
  std::string accessors;
  std::string views;
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0) accessors += ",", views += ",";
    accessors += "{\"bufferView\":" + std::to_string(i) + "," + all[i].accessor +
                 ",\"count\":" + std::to_string(all[i].rows) + "}";
    views += view_of(all[i], made.binary.size());
    made.binary += all[i].bytes;
    bytes += all[i].rows * all[i].stride;
  }
  std::string head =
      with(k_square_json.substr(0, k_square_json.find("\"accessors\"")), "\"scene\":0",
           R"("extensionsRequired":["EXT_meshopt_compression"],"scene":0)");
  head = with(head, R"("attributes":{"POSITION":0},"indices":1)", primitive);
  made.json = head + "\"accessors\":[" + accessors + "],\"bufferViews\":[" + views +
              R"(],"buffers":[{"byteLength":)" + std::to_string(made.binary.size()) +
              R"(},{"byteLength":)" + std::to_string(bytes) + "}]}";
  return made;
}

Compressed compressed(const Mesh& mesh) {
  return compressed({packed_positions(mesh.positions), packed_triangles(mesh, "INDICES", 4)});
}

/// The triangle with its smallest corner first.
Triangle turned(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

Mesh ball(int level) {
  Mesh mesh = icosphere(level);
  for (Vec3& p : mesh.positions) p = rounded(p, PositionType::float32);
  return mesh;
}

/// The values of all channels, vertex by vertex.
std::vector<float> channels_of(const Compressed& made) {
  const TempFolder folder;
  write_file(folder / "m.glb", made.glb());
  std::vector<float> values;
  open_mesh(folder / "m.glb")->scan_channels([&](const ChannelPoints& batch) {
    values.insert(values.end(), batch.values.begin(), batch.values.end());
  });
  return values;
}

/// Bytes allocated and not freed.
std::size_t held_bytes() {
  const struct mallinfo2 info = ::mallinfo2();
  return info.uordblks + info.hblkhd;
}

}  // namespace

TEST_CASE("what meshoptimizer compressed is read, in memory or by way of a scratch file") {
  for (const std::uint32_t size : {50, 1250}) {  // 1,565,001 vertices: 18 MB
    const Mesh mesh = grid(size, size);
    const Compressed made = compressed(mesh);
    const ReadFile read = read_glb(made.json, made.binary);
    CHECK((read.mesh.positions == mesh.positions));
    CHECK((read.mesh.triangles == mesh.triangles));
  }
}

TEST_CASE("compressed triangles are read, with indices of 16 and of 32 bits") {
  const Mesh mesh = ball(4);
  for (const std::size_t stride : {2, 4}) {
    for (const char* mode : {"TRIANGLES", "INDICES"}) {
      CAPTURE(stride);
      CAPTURE(mode);
      const Compressed made =
          compressed({packed_positions(mesh.positions), packed_triangles(mesh, mode, stride)});
      const ReadFile read = read_bytes(made.glb());
      CHECK((read.mesh.positions == mesh.positions));
      REQUIRE(read.mesh.triangles.size() == mesh.triangles.size());
      bool are_same = true;  // TRIANGLES may rotate their corners
      for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        are_same &= turned(read.mesh.triangles[t]) == turned(mesh.triangles[t]);
      }
      CHECK(are_same);
    }
  }
}

TEST_CASE("positions that were filtered as exponentials are read") {
  const Mesh mesh = ball(3);
  std::vector<float> floats;
  for (const Vec3& p : mesh.positions) {
    for (const double x : {p.x, p.y, p.z}) floats.push_back(static_cast<float>(1000 * x));
  }
  std::vector<std::uint32_t> filtered(floats.size());
  meshopt_encodeFilterExp(filtered.data(), mesh.positions.size(), 12, 20, floats.data());
  const ReadFile read = read_bytes(compressed({packed_rows(filtered.data(), mesh.positions.size(),
                                                           12, k_of_floats, "EXPONENTIAL"),
                                               packed_triangles(mesh, "TRIANGLES", 4)})
                                       .glb());
  REQUIRE(read.mesh.positions.size() == mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    CHECK(length(read.mesh.positions[i] - mesh.positions[i] * 1000) < 0.005);
  }
}

TEST_CASE("normals that were filtered as octahedra are read, of 8 and of 16 bits") {
  const Mesh mesh = ball(3);  // its positions are its normals
  const std::size_t count = mesh.positions.size();
  std::vector<float> normals;
  for (const Vec3& p : mesh.positions) {
    for (const double x : {p.x, p.y, p.z, 1.0}) normals.push_back(static_cast<float>(x));
  }
  for (const std::size_t stride : {4, 8}) {
    CAPTURE(stride);
    std::string filtered(count * stride, '\0');
    meshopt_encodeFilterOct(filtered.data(), count, stride, stride == 4 ? 8 : 16, normals.data());
    const std::string accessor = "\"componentType\":" + std::string(stride == 4 ? "5120" : "5122") +
                                 R"(,"type":"VEC3","normalized":true)";
    PackedRows rows = packed_rows(filtered.data(), count, stride, accessor, "OCTAHEDRAL");
    rows.more_of_view = ",\"byteStride\":" + std::to_string(stride);
    const std::vector<float> values = channels_of(
        compressed({packed_positions(mesh.positions), rows, packed_triangles(mesh, "TRIANGLES", 4)},
                   R"("attributes":{"POSITION":0,"NORMAL":1},"indices":2)"));
    REQUIRE(values.size() == 3 * count);
    const float most = stride == 4 ? 0.02F : 0.0002F;
    for (std::size_t i = 0; i < values.size(); ++i) {
      CHECK(std::abs(values[i] - normals[i / 3 * 4 + i % 3]) < most);
    }
  }
}

TEST_CASE("rows that were filtered as quaternions are read") {
  // No vertex has quaternions, but the first three components can serve as a position.
  const Mesh mesh = ball(3);
  const std::size_t count = mesh.positions.size();
  std::vector<float> turns;
  for (const Vec3& p : mesh.positions) {
    for (const double x : {p.x * 0.6, p.y * 0.6, p.z * 0.6, 0.8}) {
      turns.push_back(static_cast<float>(x));
    }
  }
  std::string filtered(count * 8, '\0');
  meshopt_encodeFilterQuat(filtered.data(), count, 8, 16, turns.data());
  PackedRows rows =
      packed_rows(filtered.data(), count, 8,
                  R"("componentType":5122,"type":"VEC3","normalized":true)", "QUATERNION");
  rows.more_of_view = R"(,"byteStride":8)";
  const ReadFile read = read_bytes(compressed({rows, packed_triangles(mesh, "INDICES", 2)}).glb());
  REQUIRE(read.mesh.positions.size() == count);
  for (std::size_t i = 0; i < count; ++i) {
    CHECK(length(read.mesh.positions[i] - mesh.positions[i] * 0.6) < 0.001);
  }
}

TEST_CASE("of compressed buffer views few are held in memory, however many there are") {
  constexpr std::size_t k_views = 8;
  constexpr std::size_t k_rows = 1'200'000;  // 14.4 MB
  std::string primitives;
  std::vector<PackedRows> all;
  for (std::size_t i = 0; i < k_views; ++i) {
    const std::vector<float> floats(3 * k_rows, static_cast<float>(i));
    all.push_back(packed_rows(floats.data(), k_rows, 12, k_of_floats));
    if (i > 0) primitives += "},{";
    primitives += R"("attributes":{"POSITION":)" + std::to_string(i) + "}";
  }
  const TempFolder folder;
  write_file(folder / "m.glb", compressed(all, primitives).glb());
  all.clear();
  const std::size_t before = held_bytes();
  const auto source = open_mesh(folder / "m.glb");
  CHECK(held_bytes() < before + 24'000'000);
  std::size_t row = 0;
  bool are_right = true;
  source->scan_vertices([&](std::span<const Vec3> batch) {
    for (const Vec3& p : batch) {
      const std::size_t view = row++ / k_rows;
      const auto expected = static_cast<double>(view);
      are_right &= p == Vec3{expected, expected, expected};
    }
  });
  CHECK(row == k_views * k_rows);
  CHECK(are_right);
}

TEST_CASE("a buffer view that is not as its compression says is refused") {
  const Mesh mesh = icosphere(2);  // 162 vertices, 320 triangles
  const std::string json = compressed(mesh).json;
  const std::string binary = compressed(mesh).binary;
  const auto refused = [&](std::string_view from, std::string_view to) {
    return refusal(glb_file(with(json, from, to), binary));
  };
  const std::string_view view = R"({"buffer":1,"byteLength":1944)";
  CHECK(refused(view, R"({"buffer":1,"byteLength":1945)") ==
        "m.ply: bufferViews[0].byteLength is 1945, but its EXT_meshopt_compression has 162 "
        "elements of 12 bytes");
  CHECK(refused("\"ATTRIBUTES\",\"count\":162", "\"ATTRIBUTES\",\"count\":150") ==
        "m.ply: bufferViews[0].byteLength is 1944, but its EXT_meshopt_compression has 150 "
        "elements of 12 bytes");
  CHECK(refused(view, R"({"buffer":1,"byteLength":1944,"byteStride":16)") ==
        "m.ply: bufferViews[0].byteStride is 16, but 12 in its EXT_meshopt_compression");
  CHECK(refused(view, R"({"buffer":1,"byteLength":1944,"byteStride":12)").empty());
}

TEST_CASE("a compressed buffer view that is malformed is refused") {
  const Compressed made = compressed(icosphere(2));  // 162 vertices, 320 triangles
  const auto refused = [&](std::string_view from, std::string_view to) {
    std::string json = with(made.json, from, to);
    const std::size_t count = to.find("\"count\":");  // the view must have the same count
    if (count != std::string_view::npos) {
      const auto rows = std::stoull(std::string(to.substr(count + 8)));
      json = with(json, "1944", std::to_string(12 * rows));
    }
    const std::string told = refusal(glb_file(json, made.binary));
    const std::string_view place = "m.ply: bufferViews[0].extensions.EXT_meshopt_compression";
    return told.starts_with(place) ? told.substr(place.size()) : told;
  };
  CHECK(refused("\"byteStride\":12", "\"byteStride\":10") == ".byteStride does not fit the mode");
  CHECK(refused("\"byteStride\":12", "\"byteStride\":0") == ".byteStride does not fit the mode");
  CHECK(refused("ATTRIBUTES", "OTHERS") == ".mode is not ATTRIBUTES, TRIANGLES or INDICES");
  CHECK(refused("\"mode\":\"ATTRIBUTES\"", R"("filter":"OCTAHEDRAL","mode":"ATTRIBUTES")") ==
        ".filter is not known, or does not fit the stride");
  CHECK(refused("\"ATTRIBUTES\",\"count\":162", "\"ATTRIBUTES\",\"count\":700000000000000") ==
        " is of more than 2 GiB when it is decompressed");
  CHECK(refused("\"ATTRIBUTES\",\"count\":162", "\"ATTRIBUTES\",\"count\":100000000") ==
        " is malformed: it is too short for its count");
  for (const char* count : {"150", "400"}) {
    CHECK(refused("\"ATTRIBUTES\",\"count\":162",
                  "\"ATTRIBUTES\",\"count\":" + std::string(count)) == " is malformed");
  }
  std::string torn = made.binary;
  torn[0] = '\x7f';
  CHECK(refusal(glb_file(made.json, torn)) ==
        "m.ply: bufferViews[0].extensions.EXT_meshopt_compression is malformed");
}
