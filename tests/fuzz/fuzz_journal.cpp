// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include <meshfarm/staging/journal.hpp>
#include <meshfarm/staging/names.hpp>
#include <meshfarm/util/errors.hpp>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const JournalContent content = parse_journal(bytes, "journal");
    std::size_t whole = content.torn_bytes + (size < 8 ? 0 : 8);
    for (const std::string& record : content.records) whole += 12 + record.size();
    if (whole != size) std::abort();  // every byte belongs to a record or counts as torn
  } catch (const DataError&) {
  }
  if (const auto name = parse_staged_name(bytes); name && to_string(*name) != bytes) std::abort();
  return 0;
}
