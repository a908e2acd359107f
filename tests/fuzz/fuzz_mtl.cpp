// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>

#include "io/mtl.hpp"
#include "mesh_fuzzer.hpp"

// Any text gives materials with finite numbers.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  for (const MtlMaterial& each : parse_mtl({reinterpret_cast<const char*>(data), size})) {
    for (const double number : each.colour) fuzz::require(std::isfinite(number));
    for (const MtlMap* map : {&each.map, &each.normals, &each.emission}) {
      for (const double number : map->scale) fuzz::require(std::isfinite(number));
      for (const double number : map->offset) fuzz::require(std::isfinite(number));
    }
  }
  return 0;
}
