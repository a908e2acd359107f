// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <string_view>

#include "ply_test_files.hpp"

namespace meshfarm::test {

template <class T>
std::string raw(std::initializer_list<T> values) {
  std::string bytes;
  for (const T value : values) {
    char each[sizeof(T)];
    std::memcpy(each, &value, sizeof(T));
    bytes.append(each, sizeof(T));
  }
  return bytes;
}

inline std::string glb_chunk(std::string_view type, std::string bytes, char pad) {
  while (bytes.size() % 4 != 0) bytes += pad;
  return raw({static_cast<std::uint32_t>(bytes.size())}) + std::string(type) + bytes;
}

inline std::string glb_file(const std::string& json, const std::string& binary) {
  const std::string chunks =
      glb_chunk("JSON", json, ' ') + glb_chunk(std::string_view("BIN\0", 4), binary, '\0');
  return "glTF" + raw<std::uint32_t>({2, static_cast<std::uint32_t>(12 + chunks.size())}) + chunks;
}

/// The text with `from`, which must occur exactly once, replaced by `to`.
inline std::string with(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  REQUIRE(text.find(from, at + 1) == std::string::npos);
  return text.replace(at, from.size(), to);
}

/// The square of k_square_vertices: 48 bytes of positions, 12 of indices.
inline const std::string k_square_binary =
    raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0.5F}) + raw<std::uint16_t>({0, 1, 2, 2, 1, 3});
inline const std::string k_square_json =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
    R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
    R"("accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},)"
    R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"}],)"
    R"("bufferViews":[{"buffer":0,"byteLength":48},)"
    R"({"buffer":0,"byteOffset":48,"byteLength":12}],)"
    R"("buffers":[{"byteLength":60}]})";

inline std::string square_glb() {
  return glb_file(k_square_json, k_square_binary);
}

/// A square with other JSON, or other bytes.
inline ReadFile read_glb(const std::string& json, const std::string& binary = k_square_binary) {
  return read_bytes(glb_file(json, binary));
}

}  // namespace meshfarm::test
