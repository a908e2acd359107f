// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A host card from a shared folder.
#include <cstdlib>

#include <meshfarm/staging/host_card.hpp>

#include "fuzz/staged_fuzzer.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  const auto round_trip = [](std::string_view file) {
    if (encode_host_card(decode_host_card(file, "fuzz")) != file) std::abort();
  };
  fuzz::decode_staged(data, size, {'H', 'O', 'S', 'T'}, round_trip);
  return 0;
}
