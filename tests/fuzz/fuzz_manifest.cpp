// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/io/manifest.hpp>

#include "fuzz/staged_fuzzer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  fuzz::decode_staged(data, size, {'M', 'N', 'F', 'T'},
                      [](std::string_view file) { decode_manifest(file, "manifest"); });
  return 0;
}
