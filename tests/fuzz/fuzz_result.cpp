// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>

#include <meshfarm/io/result_file.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

namespace {

void decode(std::string_view file, std::size_t rung) {
  try {
    meshfarm::decode_result(file, rung, "result");
  } catch (const meshfarm::DataError&) {
  }
}

}  // namespace

/// As they are, and with the right sum behind them, so that it does not keep the fuzzer from what
/// lies behind it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  const std::size_t rung = size == 0 ? 0 : data[size - 1] % 4;
  std::string file(reinterpret_cast<const char*>(data), size);
  decode(file, rung);
  const std::uint64_t sum = checksum(file);
  file.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  decode(file, rung);
  try {
    decode_summary({reinterpret_cast<const char*>(data), size}, "summary");
  } catch (const DataError&) {
  }
  return 0;
}
