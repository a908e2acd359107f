// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A host card from a shared folder: as it is, and as the payload of a sound seal.
#include <cstdint>
#include <cstdlib>
#include <string>

#include <meshfarm/staging/host_card.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/errors.hpp>

namespace {

void try_file(std::string_view file) {
  try {
    const meshfarm::HostCard card = meshfarm::decode_host_card(file, "fuzz");
    if (meshfarm::encode_host_card(card) != file) std::abort();
  } catch (const meshfarm::DataError&) {
    return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try_file(bytes);
  try_file(meshfarm::seal({'H', 'O', 'S', 'T'}, 1, bytes));
  return 0;
}
