// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/io/boundary_file.hpp>

#include "fuzz/staged_fuzzer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  fuzz::decode_staged(data, size, {'B', 'N', 'D', 'Y'},
                      [](std::string_view file) { decode_boundary(file, "boundary"); });
  fuzz::decode_staged(data, size, {'B', 'N', 'D', 'Y'}, [](std::string_view file) {
    scan_boundary(fill_from(file, "boundary"), "boundary",
                  [](std::span<const BoundaryTriangle>, const TriangleColumnsView&) {});
  });
  return 0;
}
