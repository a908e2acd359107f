// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// An endpoint file from a shared folder. The checksum would stop the fuzzer at the door, so the
// input is also tried as the payload of a sound seal.
#include <cstdint>
#include <cstdlib>
#include <string>

#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/errors.hpp>

namespace {

void try_file(std::string_view file) {
  try {
    const meshfarm::Endpoint endpoint = meshfarm::decode_endpoint(file, "fuzz");
    if (meshfarm::encode_endpoint(endpoint) != file) std::abort();
  } catch (const meshfarm::DataError&) {
    return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try_file(bytes);
  try_file(meshfarm::seal({'E', 'N', 'D', 'P'}, 2, bytes));
  return 0;
}
