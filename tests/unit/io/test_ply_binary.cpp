// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <limits>

#include <doctest/doctest.h>

#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

using Order = BinaryFile::Order;

/// The square, with its faces' counts and indices in these types.
template <class Count, class Index>
BinaryFile square_of(Order order, std::string_view count, std::string_view index) {
  BinaryFile file(order, replaced(mesh_elements(4, 2), "uchar int",
                                  std::string(count) + " " + std::string(index)));
  file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5F});
  file.put<Count>({3}).template put<Index>({0, 1, 2});
  return file.put<Count>({3}).template put<Index>({2, 1, 3});
}

template <class Count>
void check_all_index_types(Order order, std::string_view count) {
  check_square(read_bytes(square_of<Count, std::int8_t>(order, count, "char").text()));
  check_square(read_bytes(square_of<Count, std::uint8_t>(order, count, "uint8").text()));
  check_square(read_bytes(square_of<Count, std::int16_t>(order, count, "short").text()));
  check_square(read_bytes(square_of<Count, std::uint16_t>(order, count, "uint16").text()));
  check_square(read_bytes(square_of<Count, std::int32_t>(order, count, "int").text()));
  check_square(read_bytes(square_of<Count, std::uint32_t>(order, count, "uint32").text()));
  check_square(read_bytes(square_of<Count, std::int64_t>(order, count, "int64").text()));
  check_square(read_bytes(square_of<Count, std::uint64_t>(order, count, "uint64").text()));
  check_square(read_bytes(square_of<Count, float>(order, count, "float").text()));
  check_square(read_bytes(square_of<Count, double>(order, count, "double").text()));
}

template <class T>
void check_coordinates(Order order, std::string_view type) {
  std::string elements = "element vertex 2\n";
  for (const auto axis : {"x", "y", "z"}) {
    elements += "property " + std::string(type) + " " + axis + "\n";
  }
  BinaryFile file(order, elements);
  file.put<T>({1, 2, 100, 4, 50, 6});
  CHECK(read_bytes(file.text()).mesh.positions == std::vector<Vec3>{{1, 2, 100}, {4, 50, 6}});
}

}  // namespace

TEST_CASE("list counts and indices of every type, in both byte orders") {
  for (const Order order : {Order::little, Order::big}) {
    check_all_index_types<std::int8_t>(order, "char");
    check_all_index_types<std::uint8_t>(order, "uchar");
    check_all_index_types<std::int16_t>(order, "int16");
    check_all_index_types<std::uint16_t>(order, "ushort");
    check_all_index_types<std::int32_t>(order, "int");
    check_all_index_types<std::uint32_t>(order, "uint");
    check_all_index_types<std::int64_t>(order, "int64");
    check_all_index_types<std::uint64_t>(order, "uint64");
    check_all_index_types<float>(order, "float");
    check_all_index_types<double>(order, "double");
  }
}

TEST_CASE("coordinates of every type, in both byte orders") {
  for (const Order order : {Order::little, Order::big}) {
    check_coordinates<std::int8_t>(order, "char");
    check_coordinates<std::uint8_t>(order, "uchar");
    check_coordinates<std::int16_t>(order, "short");
    check_coordinates<std::uint16_t>(order, "ushort");
    check_coordinates<std::int32_t>(order, "int");
    check_coordinates<std::uint32_t>(order, "uint");
    check_coordinates<std::int64_t>(order, "int64");
    check_coordinates<std::uint64_t>(order, "uint64");
    check_coordinates<float>(order, "float");
    check_coordinates<double>(order, "double");
  }
}

TEST_CASE("coordinates stand in any order, apart or together") {
  for (const std::string order : {"xyz", "zyx", "yxz", "xwyz", "wxyz", "xywz", "xwzy", "xyzw"}) {
    std::string elements = "element vertex 2\n";
    for (const char axis : order) elements += std::string("property float ") + axis + "\n";
    BinaryFile file(Order::little, elements);
    for (const float vertex : {0.F, 10.F}) {
      for (const char axis : order) file.floats({vertex + static_cast<float>(axis - 'w')});
    }
    CAPTURE(order);
    CHECK(read_bytes(file.text()).mesh.positions == std::vector<Vec3>{{1, 2, 3}, {11, 12, 13}});
  }
}

TEST_CASE("extra elements and properties stand anywhere in a binary file") {
  for (const Order order : {Order::little, Order::big}) {
    BinaryFile file(
        order,
        "element camera 2\nproperty float f\nproperty list uchar int tags\n"
        "element nothing 7\n"
        "element face 2\nproperty uchar flags\nproperty list uchar int vertex_indices\n"
        "property list uchar float uv\n"
        "element edge 1\nproperty int a\nproperty int b\n"
        "element vertex 4\nproperty uchar r\nproperty double z\nproperty list int int ring\n"
        "property float y\nproperty short x\n"
        "element end 1\nproperty list uchar uchar text\n");
    file.floats({1}).bytes({2}).ints({7, 8}).floats({2}).bytes({0});
    file.bytes({255, 3}).ints({0, 1, 2}).bytes({2}).floats({1, 2});
    file.bytes({0, 3}).ints({2, 1, 3}).bytes({0});
    file.ints({0, 1});
    file.bytes({9}).put<double>({0}).ints({0}).floats({0}).put<short>({0});
    file.bytes({9}).put<double>({0}).ints({1, 5}).floats({0}).put<short>({1});
    file.bytes({9}).put<double>({0}).ints({2, 5, 6}).floats({1}).put<short>({0});
    file.bytes({9}).put<double>({0.5}).ints({0}).floats({1}).put<short>({1});
    file.bytes({3, 'A', 'B', 'C'});
    const ReadFile read = read_bytes(file.text());
    check_square(read);
    CHECK(read.info.faces == 2);
    CHECK(read.info.channels.size() == 1);
    CHECK(read.info.skipped.size() == 7);
  }
}

TEST_CASE("triangles, polygons and small faces mix, with properties round their lists") {
  for (const Order order : {Order::little, Order::big}) {
    std::string elements = mesh_elements(4, 6);
    elements = replaced(elements, "property list", "property uchar before\nproperty list") +
               "property float after\n";
    BinaryFile file(order, elements);
    file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5F});
    file.bytes({1, 3}).ints({0, 1, 2}).floats({1});
    file.bytes({1, 4}).ints({0, 1, 3, 2}).floats({2});
    file.bytes({1, 2}).ints({0, 1}).floats({3});
    file.bytes({1, 3}).ints({2, 1, 3}).floats({4});
    file.bytes({1, 0}).floats({5});
    file.bytes({1, 3}).ints({0, 2, 1}).floats({6});
    const ReadFile read = read_bytes(file.text());
    CHECK(read.mesh.triangles ==
          std::vector<Triangle>{{0, 1, 2}, {0, 1, 3}, {0, 3, 2}, {2, 1, 3}, {0, 2, 1}});
    CHECK(read.small_faces == 2);
  }
}

TEST_CASE("binary strips restart at -1") {
  const std::string elements = "element vertex 4\n" + std::string(k_xyz) +
                               "element tristrips 2\nproperty list int int vertex_indices\n";
  BinaryFile file(Order::little, elements);
  file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5F});
  file.ints({9, 0, 1, 2, 3, -1, 1, 3, 2, -1});
  file.ints({3, 3, 2, 1});
  const ReadFile read = read_bytes(file.text());
  CHECK(read.mesh.triangles == std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {1, 3, 2}, {3, 2, 1}});
  CHECK(read.info.faces == 2);
}

TEST_CASE("concave polygons are cut inside, wherever their corners' positions are found") {
  // Concave at its second corner: a fan from the first would leave the polygon.
  const auto faces = [](BinaryFile& file) { file.bytes({4}).ints({0, 1, 2, 3}); };
  const std::vector<Triangle> inside{{1, 2, 3}, {0, 1, 3}};
  for (const Order order : {Order::little, Order::big}) {
    BinaryFile plain(order, mesh_elements(4, 1));
    plain.floats({0, 0, 0, 1, 1, 0, 2, 0, 0, 1, 3, 0});
    faces(plain);
    CHECK(read_bytes(plain.text()).mesh.triangles == inside);

    BinaryFile after(order, "element face 1\n" + std::string(k_corners) + "element vertex 4\n" +
                                std::string(k_xyz));
    faces(after);
    after.floats({0, 0, 0, 1, 1, 0, 2, 0, 0, 1, 3, 0});
    CHECK(read_bytes(after.text()).mesh.triangles == inside);

    BinaryFile lists(order, "element vertex 4\n" + std::string(k_xyz) +
                                "property list uchar uchar tags\nelement face 1\n" +
                                std::string(k_corners));
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 1}, {2, 0}, {1, 3}}) {
      lists.floats({static_cast<float>(x), static_cast<float>(y), 0}).bytes({2, 8, 9});
    }
    faces(lists);
    CHECK(read_bytes(lists.text()).mesh.triangles == inside);
  }
  const std::string ascii = "ply\nformat ascii 1.0\n" + mesh_elements(4, 1) +
                            "end_header\n0 0 0\n1 1 0\n2 0 0\n1 3 0\n4 0 1 2 3\n";
  CHECK(read_bytes(ascii).mesh.triangles == inside);
}

TEST_CASE("a polygon with very many corners is read as a fan, and told") {
  constexpr std::uint32_t k_count = 100'000;
  BinaryFile file(BinaryFile::Order::little,
                  replaced(mesh_elements(4, 1), "list uchar", "list int"));
  file.floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5F}).ints({k_count});
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(k_count); ++i) file.ints({i % 4});
  std::vector<Triangle> triangles;
  const std::string told = stderr_of([&] { triangles = read_bytes(file.text()).mesh.triangles; });
  CHECK(told.find("1 polygons cross themselves, or have too many corners") != std::string::npos);
  REQUIRE(triangles.size() == k_count - 2);
  for (std::uint32_t i = 0; i < k_count - 2; ++i) {
    REQUIRE(triangles[i] == Triangle{0, (i + 1) % 4, (i + 2) % 4});
  }
}

TEST_CASE("a coordinate that is not finite costs the triangles that use it, no more") {
  const BinaryFile good = binary_square();
  const auto changed = [&good](std::size_t offset, float value) {
    std::string bytes = good.text();
    std::memcpy(bytes.data() + good.header_bytes() + offset, &value, sizeof value);
    return read_bytes(bytes).mesh;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const Mesh first = changed(0, nan);
  CHECK_FALSE(has_position(first.positions[0]));
  CHECK(first.positions[1] == k_square_vertices[1]);
  CHECK(first.triangles == std::vector<Triangle>{k_square_triangles[1]});
  CHECK(changed(16, infinity).triangles.empty());  // both triangles use vertex 1
  CHECK(changed(44, -infinity).triangles == std::vector<Triangle>{k_square_triangles[0]});
}

TEST_CASE("bad values are refused with element, index and byte") {
  const BinaryFile good = binary_square();
  const auto changed = [&good](std::size_t offset, auto value) {
    std::string bytes = good.text();
    std::memcpy(bytes.data() + good.header_bytes() + offset, &value, sizeof value);
    return refusal(bytes);
  };
  const auto at = [&good](std::string_view what, std::size_t offset) {
    return "m.ply: " + std::string(what) + " at byte " +
           std::to_string(good.header_bytes() + offset) + ": ";
  };
  CHECK(changed(49, 4) ==
        at("face 0", 49) + "vertex index 4 is out of range: there are 4 vertices");
  CHECK(changed(70, -1) ==
        at("face 1", 70) + "vertex index -1 is out of range: there are 4 vertices");
  CHECK(changed(61, '\xff') ==
        at("face 1", 61) + "list vertex_indices claims 255 items, but only 12 bytes follow");
}

TEST_CASE("list counts below zero, huge or broken are refused") {
  const auto told = [](auto count, std::string_view type) {
    BinaryFile file(Order::little,
                    replaced(mesh_elements(1, 1), "uchar int", std::string(type) + " int"));
    file.floats({0, 0, 0}).put({count}).ints({0, 0, 0});
    const std::string message = refusal(file.text());
    return message.substr(message.find(": list") + 2);
  };
  CHECK(told(std::int8_t{-1}, "char") == "list vertex_indices has a count below zero or broken");
  CHECK(told(std::int32_t{-5}, "int") == "list vertex_indices has a count below zero or broken");
  CHECK(told(1.5F, "float") == "list vertex_indices has a count below zero or broken");
  CHECK(told(std::numeric_limits<double>::quiet_NaN(), "double") ==
        "list vertex_indices has a count below zero or broken");
  CHECK(told(std::uint32_t{4'000'000'000}, "uint") ==
        "list vertex_indices claims 4000000000 items, but only 12 bytes follow");
  CHECK(told(UINT64_MAX, "uint64") ==
        "list vertex_indices claims 9223372036854775807 items, but only 12 bytes follow");
}

TEST_CASE("indices that are no whole number are refused") {
  BinaryFile file = square_of<std::uint8_t, float>(Order::little, "uchar", "float");
  std::string bytes = file.text();
  const float half = 0.5F;
  std::memcpy(bytes.data() + bytes.size() - 4, &half, 4);
  CHECK(refusal(bytes) == "m.ply: face 1 at byte " + std::to_string(bytes.size() - 4) +
                              ": a vertex index is not a whole number");
}

TEST_CASE("an index type wider than the vertex count is compared in full") {
  BinaryFile file(Order::little, replaced(mesh_elements(1, 1), "uchar int", "uchar uint64"));
  file.floats({0, 0, 0}).bytes({3}).put<std::uint64_t>({0, std::uint64_t{1} << 32, 0});
  CHECK(refusal(file.text())
            .ends_with("vertex index 4294967296 is out of range: there are 1 vertices"));
}

TEST_CASE("bytes behind the last element are told") {
  const std::string told =
      stderr_of([] { check_square(read_bytes(binary_square().text() + "\n")); });
  CHECK(told.find("m.ply: there is more in the file than its header says\n") != std::string::npos);
  CHECK(stderr_of([] { check_square(read_bytes(binary_square().text())); }).empty());
}

TEST_CASE("a big binary file is read through many windows") {
  constexpr std::uint32_t k_count = 800'000;  // 9.6 MB of vertices, 10.4 MB of faces
  for (const Order order : {Order::little, Order::big}) {
    BinaryFile file(order, mesh_elements(k_count, k_count));
    for (std::uint32_t i = 0; i < k_count; ++i) {
      file.floats({static_cast<float>(i), 0.5F, -static_cast<float>(i)});
    }
    for (std::uint32_t i = 0; i < k_count; ++i) {
      file.bytes({3}).put<std::uint32_t>({i, (i + 1) % k_count, (i + 2) % k_count});
    }
    const ReadFile read = read_bytes(file.text());
    REQUIRE(read.mesh.positions.size() == k_count);
    REQUIRE(read.mesh.triangles.size() == k_count);
    bool same = true;
    for (std::uint32_t i = 0; i < k_count; ++i) {
      same = same && read.mesh.positions[i] == Vec3{double(i), 0.5, -double(i)} &&
             read.mesh.triangles[i] == Triangle{i, (i + 1) % k_count, (i + 2) % k_count};
    }
    CHECK(same);
  }
}
