// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include <meshfarm/farm/job.hpp>

namespace meshfarm {

/// The results that a sink need not wait for, and how far it trusts each. Those of journals were
/// verified once, by the sink that wrote the record, or were large; but their files may have
/// suffered since. A look at their sizes is cheap, and enough to go on with; to read them all takes
/// long.
class KnownResults {
 public:
  /// left: looked at, and to be checked by those who read it.
  enum class Trust : std::uint8_t { journal, looked_at, left, verified };

  explicit KnownResults(std::map<JobKey, JobOutput>&& journal) {
    for (auto& [key, output] : journal) results_[key] = {std::move(output), Trust::journal};
  }

  /// Null if there is none.
  const JobOutput* find(JobKey key) const {
    const auto found = results_.find(key);
    return found == results_.end() ? nullptr : &found->second.output;
  }
  /// Whether it may be accepted as it is.
  bool is_trusted(JobKey key) const {
    const auto found = results_.find(key);
    return found != results_.end() && found->second.trust != Trust::journal;
  }
  /// How many are trusted by a look alone, and are to be verified.
  std::uint64_t unverified() const { return unverified_; }

  /// One of a journal, or that came just now; it is left, or to be verified.
  void looked_at(JobKey key, const JobOutput& output, bool left) {
    Known& known = results_[key];
    known.output = output;
    set(known, left ? Trust::left : Trust::looked_at);
  }
  void verified(JobKey key) { set(results_.at(key), Trust::verified); }
  /// One that this sink verified. What is known of the job already stays.
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
