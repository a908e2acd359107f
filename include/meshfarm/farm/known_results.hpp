// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include <meshfarm/farm/job.hpp>

namespace meshfarm {

/// The results that a sink need not wait for, and how far it trusts each. Results in journals were
/// verified by the sink that wrote the record, or were large; their files may have been damaged
/// since. Checking their sizes is cheap and enough to go on; reading them all takes long.
class KnownResults {
 public:
  /// left: checked by size only, and verified by its readers.
  enum class Trust : std::uint8_t { journal, looked_at, left, verified };

  explicit KnownResults(std::map<JobKey, JobOutput>&& journal) {
    for (auto& [key, output] : journal) results_[key] = {std::move(output), Trust::journal};
  }

  /// The output, or null.
  const JobOutput* find(JobKey key) const {
    const auto found = results_.find(key);
    return found == results_.end() ? nullptr : &found->second.output;
  }
  /// Whether it may be accepted as it is.
  bool is_trusted(JobKey key) const {
    const auto found = results_.find(key);
    return found != results_.end() && found->second.trust != Trust::journal;
  }
  /// Number of results accepted by a size check alone that are still to be verified.
  std::uint64_t unverified() const { return unverified_; }

  /// A result from a journal, or a new one, that passed a size check; `left` to its readers, or to
  /// be verified.
  void looked_at(JobKey key, const JobOutput& output, bool left) {
    Known& known = results_[key];
    known.output = output;
    set(known, left ? Trust::left : Trust::looked_at);
  }
  void verified(JobKey key) { set(results_.at(key), Trust::verified); }
  /// A result that this sink verified. Does not replace what is already known of the job.
  void add(JobKey key, const JobOutput& output) {
    results_.try_emplace(key, Known{output, Trust::verified});
  }
  void forget(JobKey key) {
    const auto found = results_.find(key);
    if (found == results_.end()) return;
    set(found->second, Trust::journal);
    results_.erase(found);
  }

 private:
  struct Known {
    JobOutput output;
    Trust trust = Trust::journal;
  };
  void set(Known& known, Trust trust) {
    if (known.trust == Trust::looked_at) --unverified_;
    if (trust == Trust::looked_at) ++unverified_;
    known.trust = trust;
  }

  std::map<JobKey, Known> results_;
  std::uint64_t unverified_ = 0;
};

}  // namespace meshfarm
