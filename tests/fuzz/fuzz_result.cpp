// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>

#include <meshfarm/io/result_file.hpp>
#include <meshfarm/util/errors.hpp>

namespace {

void decode(std::string_view file, std::size_t rung) {
  try {
    meshfarm::decode_result(file, rung, "result");
  } catch (const meshfarm::DataError&) {
  }
}

}  // namespace

/// Decodes the bytes as a file, and as a rung and a tail, past the checksums.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  const std::size_t rung = size == 0 ? 0 : data[size - 1] % 4;
  const std::string file(reinterpret_cast<const char*>(data), size);
  decode(file, rung);
  const std::size_t split = size < 2 ? 0 : size * data[size - 2] / 256;
  try {
    decode_rung(std::string_view(file).substr(0, split), std::string_view(file).substr(split), rung,
                "result");
  } catch (const DataError&) {
  }
  try {
    decode_summary({reinterpret_cast<const char*>(data), size}, "summary");
  } catch (const DataError&) {
  }
  return 0;
}
