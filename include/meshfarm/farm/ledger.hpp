// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/staging/journal.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// A journal record of the sink: one accepted job.
std::string encode_accepted(const AcceptedJob& accepted);
/// Throws DataError naming `what`.
AcceptedJob decode_accepted(std::string_view record, std::string_view what);

/// Whether the name is that of a result of the job.
bool names_result_of(JobKey key, std::string_view name);

/// What all journals of a stage say was accepted, the last record of a key winning. Torn tails and
/// unreadable journals are logged and left out. Throws IoError if the folder cannot be listed.
std::map<JobKey, JobOutput> read_journals(const Stage& stage);

/// A new journal under the first number that nobody has taken.
JournalWriter open_journal(const Stage& stage);

}  // namespace meshfarm
