// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/io/result_file.hpp>

#include "fuzz/staged_fuzzer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  const std::size_t rung = size == 0 ? 0 : data[0] % 4;
  fuzz::decode_staged(data, size, {'R', 'S', 'L', 'T'},
                      [rung](std::string_view file) { decode_result(file, rung, "result"); });
  try {
    decode_summary({reinterpret_cast<const char*>(data), size}, "summary");
  } catch (const DataError&) {
  }
  return 0;
}
