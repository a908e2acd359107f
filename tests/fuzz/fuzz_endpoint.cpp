// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// An endpoint file from a shared folder.
#include <cstdlib>

#include <meshfarm/farm/endpoint.hpp>

#include "fuzz/staged_fuzzer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  const auto round_trip = [](std::string_view file) {
    if (encode_endpoint(decode_endpoint(file, "fuzz")) != file) std::abort();
  };
  fuzz::decode_staged(data, size, {'E', 'N', 'D', 'P'}, round_trip);
  return 0;
}
