// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstring>
#include <string>

#include "io/gltf_draco.hpp"
#include "mesh_fuzzer.hpp"

namespace {

struct Counts {
  std::uint16_t points = 0;
  std::uint16_t corners = 0;
};

std::string document_of(const Counts& counts) {
  const std::string points = std::to_string(counts.points);
  return R"({"primitive":{"attributes":{"POSITION":1,"NORMAL":2,"TEXCOORD_0":3,"COLOR_0":4},)"
         R"("indices":0,"extensions":{"KHR_draco_mesh_compression":{"attributes":)"
         R"({"POSITION":0,"TEXCOORD_0":1}}}},"accessors":[{"componentType":5123,"count":)" +
         std::to_string(counts.corners) + R"(,"type":"SCALAR"},{"componentType":5126,"count":)" +
         points + R"(,"type":"VEC3"},{},{"componentType":5126,"count":)" + points +
         R"(,"type":"VEC2"},{}]})";
}

}  // namespace

/// Input: the counts of the accessors, then the bytes of Draco's data. Decoded in this process, so
/// that the fuzzer sees coverage; a Draco built with sanitizers shows more.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  constexpr std::size_t k_most_bytes = 1 << 12;
  Counts counts;
  if (size < sizeof counts || size > k_most_bytes) return -1;
  std::memcpy(&counts, data, sizeof counts);
  const std::string bytes(reinterpret_cast<const char*>(data) + sizeof counts,
                          size - sizeof counts);
  const nlohmann::json json = parse_gltf_json(document_of(counts), 0, "m.gltf");
  const GltfValue document(json, "m.gltf: ");
  std::size_t rows = 0;
  try {
    decode_draco(document, document.at("primitive"), bytes, [&](std::string_view sent) {
      fuzz::require(sent.size() <= 12 * (std::size_t{counts.points} + counts.corners));
      ++rows;
    });
    fuzz::require(rows == 3);
  } catch (const Error&) {
    return 0;
  }
  return 0;
}
