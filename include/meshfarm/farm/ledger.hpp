// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/staging/journal.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// A journal record of the sink: one job accepted by a run.
struct JournalRecord {
  std::uint64_t run = 0;  // 0: unknown, from an older version
  AcceptedJob accepted;
};

std::string encode_record(const JournalRecord& record);
/// Throws DataError naming `what`.
JournalRecord decode_record(std::string_view bytes, std::string_view what);

/// Whether the name is that of a result of this job.
bool names_result_of(JobKey key, std::string_view name);

/// The readable records of one journal. Throws IoError, DataError.
std::vector<JournalRecord> read_journal(const Stage& stage, JournalName name,
                                        const ReadPatience& patience = {.attempts = 1});

/// The content of all journals of a stage.
struct Ledger {
  std::map<JobKey, JobOutput> accepted;  // the last record of a key wins
  std::set<JobKey> by_run;               // accepted by the given run itself
};
/// The patience for failing storage is shared by all journals. Torn tails, and journals that still
/// cannot be read, are logged and left out. Throws IoError if the folder cannot be listed.
Ledger read_journals(const Stage& stage, std::uint64_t run,
                     const ReadPatience& patience = {.attempts = 1});

/// A new journal under the first free number.
JournalWriter open_journal(const Stage& stage);

}  // namespace meshfarm
