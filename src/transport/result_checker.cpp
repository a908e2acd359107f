// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "transport/result_checker.hpp"

#include <new>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

namespace meshfarm {

namespace {

bool is_fresh(const Check& check) {
  return check.what == Check::What::result || check.what == Check::What::large;
}

}  // namespace

void ResultChecker::check_all(std::vector<CheckedResult>& batch, ReadPatience& fresh,
                              ReadPatience& known, unsigned threads) const {
  std::mutex mutex;
  parallel_for(batch.size(), threads, [&](std::uint64_t i) {
    CheckedResult& each = batch[i];
    check(each, is_fresh(each.check) ? fresh : known, mutex);
  });
}

/// Runs on several threads, which share one patience.
void ResultChecker::check(CheckedResult& each, ReadPatience& shared, std::mutex& mutex) const {
  const Check& check = each.check;
  const bool known = check.what == Check::What::known;
  try {
    if (options_.inspect) options_.inspect(check.kind, check.output);
    const ReadPatience patience = [&] {
      const std::lock_guard lock(mutex);
      return shared;
    }();
    if (known || check.what == Check::What::large) {
      stage_.open_told(check.output.file, patience);
    } else {
      stage_.verify(check.output.file, patience);
    }
    // What another run accepted is recorded as accepted by this run, too.
    each.to_record = is_fresh(check) || (known && !recorded_.contains(check.key));
  } catch (const IoError& error) {
    each.problem = {error.what(), FailureKind::unread};
    const std::lock_guard lock(mutex);
    spend(shared, error);
  } catch (const Error& error) {
    each.problem = {error.what()};
  } catch (const std::bad_alloc&) {
    each.problem = {"out of memory while reading " + check.output.file.name, FailureKind::unread};
  }
}

}  // namespace meshfarm
