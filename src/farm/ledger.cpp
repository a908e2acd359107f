// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A record of the sink's journal, version 2:
//   version u32 | run u64 | key u64 | name text | size u64 | hash u64 | summary text
//   text = length u32 | bytes
// Version 1 had no run.
#include <cerrno>

#include <meshfarm/farm/ledger.hpp>
#include <meshfarm/staging/file_ref.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm {
namespace {

constexpr std::uint32_t k_ledger_version = 2;

}  // namespace

std::vector<JournalRecord> read_journal(const Stage& stage, JournalName name,
                                        const ReadPatience& patience) {
  const std::string what = stage.path(name).string();
  const JournalContent content = parse_journal(stage.read(name, patience), what);
  if (content.torn_bytes > 0) {
    log_warning(what + ": its last " + std::to_string(content.torn_bytes) +
                " bytes are torn and left out (its sink was killed while writing)");
  }
  std::vector<JournalRecord> records;
  std::uint64_t set_aside = 0;
  for (const std::string& record : content.records) {
    try {
      records.push_back(decode_record(record, what));
    } catch (const DataError& error) {
      if (++set_aside == 1) log_warning("set aside: " + std::string(error.what()));
    }
  }
  if (set_aside > 1) {
    log_warning(what + ": " + std::to_string(set_aside) +
                " records are set aside; their jobs are done again");
  }
  return records;
}

std::string encode_record(const JournalRecord& record) {
  const AcceptedJob& accepted = record.accepted;
  ByteWriter out;
  out.put(k_ledger_version);
  out.put(record.run);
  out.put(accepted.key.value);
  put_file(out, accepted.output.file);
  out.put_string(accepted.output.summary);
  return out.take();
}

JournalRecord decode_record(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  const auto version = in.get<std::uint32_t>();
  if (version != 1 && version != k_ledger_version) in.fail("a record of an unknown version");
  JournalRecord record;
  if (version > 1) record.run = in.get<std::uint64_t>();
  AcceptedJob& accepted = record.accepted;
  accepted.key.value = in.get<std::uint64_t>();
  accepted.output.file = get_file(in);
  accepted.output.summary = in.get_string();
  in.expect_end();
  if (!names_result_of(accepted.key, accepted.output.file.name)) in.fail("a forged result name");
  return record;
}

bool names_result_of(JobKey key, std::string_view name) {
  const auto parsed = parse_staged_name(name);
  const auto* result = parsed ? std::get_if<ResultName>(&*parsed) : nullptr;
  return result != nullptr && result->key == key.value;
}

Ledger read_journals(const Stage& stage, std::uint64_t run, const ReadPatience& patience) {
  Ledger ledger;
  ReadPatience left = patience;
  for (const std::uint32_t number : outlast(left, [&] { return stage.journals(); })) {
    try {
      for (JournalRecord& each : read_journal(stage, {number}, left)) {
        if (each.run == run) ledger.by_run.insert(each.accepted.key);
        ledger.accepted[each.accepted.key] = std::move(each.accepted.output);
      }
    } catch (const Error& error) {
      log_warning("a journal is left out: " + std::string(error.what()));
      spend(left, error);
    }
  }
  return ledger;
}

JournalWriter open_journal(const Stage& stage) {
  for (;;) {
    const auto numbers = stage.journals();
    const JournalName name{numbers.empty() ? 1 : numbers.back() + 1};
    try {
      return JournalWriter(stage.path(name));
    } catch (const IoError& error) {
      if (error.error_number() != EEXIST) throw;  // otherwise another sink just took the number
    }
  }
}

}  // namespace meshfarm
