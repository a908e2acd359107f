// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A key file: as it is, as the payload of a sound seal, and as the four keys of a sound file.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>

#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/errors.hpp>

#include "farm/run_keys.hpp"

namespace {

void try_file(std::string_view file) {
  try {
    const meshfarm::RunKeys keys = meshfarm::decode_keys(file, "fuzz");
    if (meshfarm::encode_keys(keys) != file) std::abort();
  } catch (const meshfarm::DataError&) {
    return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try_file(bytes);
  try_file(meshfarm::seal({'K', 'E', 'Y', 'S'}, 1, bytes));
  std::string text(160, '0');
  std::copy_n(bytes.begin(), std::min(size, text.size()), text.begin());
  try_file(meshfarm::encode_keys(
      {text.substr(0, 40), text.substr(40, 40), text.substr(80, 40), text.substr(120, 40)}));
  return 0;
}
