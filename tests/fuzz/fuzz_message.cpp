// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A frame from anybody: refused with DataError, or decoded to a message that encodes to the same
// bytes.
#include <cstdint>
#include <cstdlib>

#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/util/errors.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view frame(reinterpret_cast<const char*>(data), size);
  try {
    const meshfarm::Message message = meshfarm::decode(frame);
    if (meshfarm::encode(message) != frame) std::abort();
  } catch (const meshfarm::DataError&) {
    return 0;
  }
  return 0;
}
