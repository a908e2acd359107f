// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A record of the sink's journal, and a whole journal.
#include <cstdint>
#include <cstdlib>

#include <meshfarm/farm/ledger.hpp>
#include <meshfarm/staging/journal.hpp>
#include <meshfarm/util/errors.hpp>

namespace {

void try_record(std::string_view record) {
  try {
    const meshfarm::JournalRecord decoded = meshfarm::decode_record(record, "fuzz");
    // A record of version 1 names no run, and is re-encoded in the current version.
    const meshfarm::JournalRecord again =
        meshfarm::decode_record(meshfarm::encode_record(decoded), "fuzz");
    if (again.run != decoded.run || again.accepted.output.file != decoded.accepted.output.file) {
      std::abort();
    }
    if (!meshfarm::names_result_of(decoded.accepted.key, decoded.accepted.output.file.name)) {
      std::abort();
    }
  } catch (const meshfarm::DataError&) {
    return;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try_record(bytes);
  try {
    for (const std::string& record : meshfarm::parse_journal(bytes, "fuzz").records) {
      try_record(record);
    }
  } catch (const meshfarm::DataError&) {
    return 0;
  }
  return 0;
}
