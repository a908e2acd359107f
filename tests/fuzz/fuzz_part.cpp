// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/io/part_file.hpp>

#include "fuzz/staged_fuzzer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  fuzz::decode_staged(data, size, {'P', 'A', 'R', 'T'},
                      [](std::string_view file) { decode_part(file, "part"); });
  return 0;
}
