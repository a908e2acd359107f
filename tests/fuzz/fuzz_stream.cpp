// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstring>
#include <string>

#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

#include "io/staged_positions.hpp"

namespace {

using namespace meshfarm;

void read_all(const std::string& file) {
  try {
    StreamReader reader(fill_from(file, "stream"), "stream");
    StreamBlock block;
    while (reader.next(block)) {
    }
  } catch (const DataError&) {
  }
}

/// Writes valid checksums after the head and after each block that the counts announce, so that the
/// fuzzer gets past them.
std::string resealed(std::string file) {
  constexpr std::size_t k_head = 37;
  if (file.size() < k_head + 8) return file;
  std::uint64_t sum = checksum(std::string_view(file).substr(0, k_head));
  std::memcpy(file.data() + k_head, &sum, sizeof sum);
  const auto format = vertex_format_of(static_cast<std::uint8_t>(file[16]));
  if (!format) return file;
  for (std::size_t at = k_head + 8; at + 12 <= file.size();) {
    std::uint32_t counts[3];
    std::memcpy(counts, file.data() + at, sizeof counts);
    const std::size_t size = 12 + counts[0] * format->bytes() + counts[1] * std::size_t{4} +
                             counts[2] * (std::size_t{12} + format->columns.bytes());
    if (size > file.size() - at || file.size() - at - size < 8) break;
    std::string chained(reinterpret_cast<const char*>(&sum), sizeof sum);
    chained += file.substr(at, size);
    sum = checksum(chained);
    std::memcpy(file.data() + at + size, &sum, sizeof sum);
    at += size + 8;
  }
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string file(reinterpret_cast<const char*>(data), size);
  read_all(file);
  read_all(resealed(file));
  return 0;
}
