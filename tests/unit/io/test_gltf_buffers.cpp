// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>
#include <iterator>

#include <doctest/doctest.h>

#include "gltf_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

/// A .gltf with a buffer at `uri`, in the folder.
std::filesystem::path gltf_in(const TempFolder& folder, std::string_view uri) {
  write_file(folder / "m.gltf", with(k_square_json, "\"byteLength\":60",
                                     R"("byteLength":60,"uri":")" + std::string(uri) + "\""));
  return folder / "m.gltf";
}

std::string refused(const TempFolder& folder, std::string_view uri) {
  try {
    read_path(gltf_in(folder, uri));
  } catch (const Error& error) {
    const std::string message = error.what();
    const std::size_t at = message.find(folder.path().string());
    REQUIRE(at != std::string::npos);
    return message.substr(0, at) + message.substr(at + folder.path().string().size() + 1);
  }
  return "";
}

}  // namespace

TEST_CASE("a glTF is read with its buffer beside it") {
  const TempFolder folder;
  write_file(folder / "all of it.bin", k_square_binary + "more");
  const ReadFile read = read_path(gltf_in(folder, "./all%20of%20it.bin"));
  check_square(read);
  CHECK(read.info.format == "glTF");
  std::filesystem::create_directory(folder / "sub");
  write_file(folder / "sub" / "m.bin", k_square_binary);
  check_square(read_path(gltf_in(folder, "sub/m.bin")));
}

TEST_CASE("a glTF is read with its buffer in itself") {
  const TempFolder folder;
  // k_square_binary
  const std::string_view base64 =
      "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAACAPwAAgD8AAAA/AAABAAIAAgABAAMA";
  const auto uri = [](std::string_view bytes) {
    return "data:application/octet-stream;base64," + std::string(bytes);
  };
  check_square(read_path(gltf_in(folder, uri(base64))));
  CHECK(refused(folder, uri("AAA*")) == "m.gltf: buffers[0].uri is malformed base64");
  CHECK(refused(folder, "data:text/plain,abc") == "m.gltf: buffers[0].uri is not base64");
  CHECK(refused(folder, uri("AAAA")) ==
        "m.gltf: buffers[0] is truncated: it is to have 60 bytes, but has 3");
}

TEST_CASE("a buffer that is elsewhere, or nowhere, is refused") {
  const TempFolder folder;
  write_file(folder / "short.bin", "1234");
  const std::string elsewhere = " does not name a file beside this one, or in a folder below";
  for (const char* uri : {"../m.bin", "a/../../m.bin", "/etc/passwd", "%2fetc/passwd",
                          "http://there/m.bin", "file:///m.bin", "", "a/", "%00", "%4"}) {
    CAPTURE(uri);
    CHECK(refused(folder, uri) == "m.gltf: buffers[0].uri '" + std::string(uri) + "'" + elsewhere);
  }
  CHECK(refused(folder, "short.bin") ==
        "m.gltf: buffers[0] is truncated: it is to have 60 bytes, but has 4");
  CHECK(refused(folder, "absent.bin").find("absent.bin") != std::string::npos);
  CHECK(refused(folder, ".").find("Is a directory") != std::string::npos);
}

TEST_CASE("many buffers beside a glTF are read with few files open") {
  const TempFolder folder;
  constexpr int k_squares = 40;
  std::string meshes, nodes, roots, accessors, views, buffers;
  for (int i = 0; i < k_squares; ++i) {
    const std::string each = std::to_string(i);
    std::string bytes = k_square_binary;
    bytes[4 * 3 * 4 - 4] = static_cast<char>(i);  // the lowest bits of the last z
    write_file(folder / (each + ".bin"), bytes);
    const std::string comma = i > 0 ? "," : "";
    nodes += comma + "{\"mesh\":" + each + "}";
    roots += comma + each;
    meshes += comma + R"({"primitives":[{"attributes":{"POSITION":)" + std::to_string(2 * i) +
              R"(},"indices":)" + std::to_string(2 * i + 1) + "}]}";
    accessors += comma + "{\"bufferView\":" + std::to_string(2 * i) +
                 R"(,"componentType":5126,"count":4,"type":"VEC3"},{"bufferView":)" +
                 std::to_string(2 * i + 1) + R"(,"componentType":5123,"count":6,"type":"SCALAR"})";
    views += comma + "{\"buffer\":" + each + R"(,"byteLength":48},{"buffer":)" + each +
             R"(,"byteOffset":48,"byteLength":12})";
    buffers += comma + R"({"byteLength":60,"uri":")" + each + ".bin\"}";
  }
  write_file(folder / "m.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" +
                                    roots + "]}],\"nodes\":[" + nodes + "],\"meshes\":[" + meshes +
                                    "],\"accessors\":[" + accessors + "],\"bufferViews\":[" +
                                    views + "],\"buffers\":[" + buffers + "]}");
  const auto open_files = [] {
    const std::filesystem::directory_iterator files("/proc/self/fd");
    return std::distance(begin(files), end(files));
  };
  const auto before = open_files();
  const auto source = open_mesh(folder / "m.gltf");
  CHECK(open_files() <= before + 8);
  const Mesh mesh = read_mesh(*source);
  CHECK(open_files() <= before + 8);
  REQUIRE(mesh.positions.size() == 4 * k_squares);
  for (std::size_t i = 0; i < k_squares; ++i) {
    CHECK(mesh.positions[4 * i + 3].z == 0.5 + static_cast<double>(i) * std::ldexp(1, -24));
  }
  CHECK(mesh.triangles.back() == Triangle{4 * k_squares - 2, 4 * k_squares - 3, 4 * k_squares - 1});
  // On a second read, buffers that are no longer open are reopened.
  write_file(folder / "1.bin", k_square_binary + "more");
  CHECK_THROWS_WITH_AS(read_mesh(*source), doctest::Contains("1.bin: changed while it was read"),
                       DataError);
}

TEST_CASE("buffers that no triangle needs are not opened") {
  const TempFolder folder;
  write_file(folder / "m.glb", glb_file(with(k_square_json, "\"byteLength\":60}",
                                             R"("byteLength":60},{"byteLength":9,"uri":"no.bin"})"),
                                        k_square_binary));
  check_square(read_path(folder / "m.glb"));
}
