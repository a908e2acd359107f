// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A key file: once like all staged files, and once as the four keys of a valid file.
#include <algorithm>
#include <cstdlib>
#include <string>

#include "fuzz/staged_fuzzer.hpp"
#include "transport/run_keys.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  const auto round_trip = [](std::string_view file) {
    if (encode_keys(decode_keys(file, "fuzz")) != file) std::abort();
  };
  fuzz::decode_staged(data, size, {'K', 'E', 'Y', 'S'}, round_trip);
  std::string text(160, '0');
  std::copy_n(data, std::min(size, text.size()), text.begin());
  try {
    round_trip(encode_keys(
        {text.substr(0, 40), text.substr(40, 40), text.substr(80, 40), text.substr(120, 40)}));
  } catch (const DataError&) {
    return 0;
  }
  return 0;
}
