// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <string_view>

#include <meshfarm/report/trace.hpp>
#include <meshfarm/util/errors.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    meshfarm::parse_trace({reinterpret_cast<const char*>(data), size}, "trace");
  } catch (const meshfarm::DataError&) {
  }
  return 0;
}
