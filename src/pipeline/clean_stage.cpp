// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A run is complete if its newest endpoint says so. Everything that a journal holds for another
// run, or for a run that it does not name, is needed. Processes working right now may need files
// that are in no journal yet: while there is a sink, results and journals are left alone, and files
// that nobody is known to need are removed only when they are old.
#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/farm/ledger.hpp>
#include <meshfarm/pipeline/clean_stage.hpp>
#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view k_sink_claim = ".sink.";
constexpr std::string_view k_claim_end = ".claim";

fs::path cleaning_claim(const Stage& stage) {
  return stage.root() / "control" / ".clean.claim";
}

bool is_sink_claim(const std::string& name) {
  return name.starts_with(k_sink_claim) && name.ends_with(k_claim_end);
}

struct ListedFile {
  fs::path path;
  std::string name;  // in its folder
  std::uint64_t bytes = 0;
  fs::file_time_type changed;
};

/// Lists the files that still exist when they are looked at.
std::vector<ListedFile> files_in(const fs::path& folder) {
  std::vector<ListedFile> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::error_code gone;
    if (!entry.is_regular_file(gone) || gone) continue;
    ListedFile file{entry.path(), entry.path().filename().string(), entry.file_size(gone),
                    entry.last_write_time(gone)};
    if (!gone) files.push_back(std::move(file));
  }
  std::sort(files.begin(), files.end(),
            [](const ListedFile& a, const ListedFile& b) { return a.name < b.name; });
  return files;
}

class Cleaning {
 public:
  Cleaning(const Stage& stage, const CleanOptions& options) : stage_(stage), options_(options) {
    report_.stage = stage.root().string();
    report_.dry_run = options.dry_run;
    now_ = clock_of(stage.root() / "control");
  }

  CleanReport clean() {
    look_for_sinks();
    look_at_runs();
    look_at_journals();
    remove_journals();
    remove_results();
    remove_endpoints();
    remove_temporaries();
    say_what_stays();
    return std::move(report_);
  }

 private:
  struct Run {
    std::uint32_t newest = 0;  // epoch
    bool complete = false;
  };
  struct Journal {
    std::uint32_t number = 0;
    std::vector<JournalRecord> records;
    bool readable = false;
  };

  void look_for_sinks() {
    for (const ListedFile& file : files_in(stage_.root() / "control")) {
      if (!is_sink_claim(file.name)) continue;
      if (const auto holder = holder_of(file.path)) {
        sinks_.push_back(*holder + " (if it is gone, remove " + file.path.string() + ")");
      } else {
        remove(file, "claims of processes that died");
      }
    }
  }

  void look_at_runs() {
    for (const Endpoint& each : endpoints_.look(stage_)) {
      Run& run = runs_[each.run];
      run.newest = std::max(run.newest, each.epoch);
      run.complete = each.done;  // that of the newest, as they come in order
    }
  }

  bool is_complete(std::uint64_t run) const {
    const auto found = runs_.find(run);
    return found != runs_.end() && found->second.complete;
  }

  bool goes(const JournalRecord& record) const {
    return options_.what == CleanWhat::finished_runs && is_complete(record.run);
  }

  void look_at_journals() {
    for (const std::uint32_t number : stage_.journals()) {
      Journal journal{number, {}, false};
      try {
        journal.records = read_journal(stage_, {number});
        journal.readable = true;
      } catch (const Error& error) {
        log_debug(error.what());
      }
      for (const JournalRecord& each : journal.records) {
        keys_.insert(each.accepted.key);
        known_.insert(each.accepted.output.file.name);
        if (!goes(each)) needed_.insert(each.accepted.output.file.name);
      }
      journals_.push_back(std::move(journal));
    }
  }

  /// Journals are removed before the results: nobody uses a result that is in no journal.
  void remove_journals() {
    if (!sinks_.empty() || options_.what != CleanWhat::finished_runs) return;
    std::uint32_t removed = 0;
    for (const ListedFile& file : files_in(stage_.root() / "journal")) {
      const auto name = parse_staged_name("journal/" + file.name);
      const auto* number = name ? std::get_if<JournalName>(&*name) : nullptr;
      const auto found = std::find_if(journals_.begin(), journals_.end(), [&](const Journal& j) {
        return number != nullptr && j.number == number->number;
      });
      if (found == journals_.end() || !found->readable) continue;
      const auto stays = [&](const JournalRecord& each) { return !goes(each); };
      if (std::any_of(found->records.begin(), found->records.end(), stays)) continue;
      const bool is_place_holder =
          found->records.empty() && found->number == journals_.back().number;
      if (is_place_holder || (found->records.empty() && !is_old(file))) continue;
      if (found->number == journals_.back().number) removed = found->number;
      remove(file, "journals of finished runs");
    }
    // Ensures that no name is used twice.
    if (removed != 0 && !options_.dry_run) JournalWriter(stage_.path(JournalName{removed + 1}));
  }

  void remove_results() {
    if (!sinks_.empty()) return;
    for (const ListedFile& file : files_in(stage_.root() / "results")) {
      const std::string staged = "results/" + file.name;
      const auto name = parse_staged_name(staged);
      const auto* result = name ? std::get_if<ResultName>(&*name) : nullptr;
      if (result == nullptr || needed_.contains(staged)) continue;
      if (known_.contains(staged)) {
        remove(file, "results of finished runs");
      } else if (keys_.contains({result->key}) || is_old(file)) {
        remove(file, "results that no run took");
      }
    }
  }

  void remove_endpoints() {
    const auto epochs = stage_.epochs();
    std::set<std::uint32_t> read;
    std::set<std::uint32_t> stale;
    for (const Endpoint& each : endpoints_.look(stage_)) {
      const Run& run = runs_[each.run];
      read.insert(each.epoch);
      // The newest endpoint tells late workers that the run is over, and us that it is complete.
      const bool last_word = run.complete && sinks_.empty();
      const bool finished = last_word && options_.what == CleanWhat::finished_runs;
      if (each.epoch != run.newest || finished) stale.insert(each.epoch);
    }
    for (const ListedFile& file : files_in(stage_.root() / "control")) {
      const auto name = parse_staged_name("control/" + file.name);
      const auto* endpoint = name ? std::get_if<EndpointName>(&*name) : nullptr;
      // The highest number stays, so that no number is used twice.
      if (endpoint == nullptr || endpoint->epoch == epochs.back() || !is_old(file)) continue;
      const bool unreadable = !read.contains(endpoint->epoch);
      if (unreadable || stale.contains(endpoint->epoch)) {
        remove(file, "addresses of ventilators that are gone");
      }
    }
  }

  void remove_temporaries() {
    const bool in_run =
        !sinks_.empty() ||
        std::any_of(runs_.begin(), runs_.end(), [](const auto& r) { return !r.second.complete; });
    const auto age =
        in_run ? std::max(options_.least_age, options_.least_age_in_run) : options_.least_age;
    std::vector<fs::path> folders = {stage_.root()};
    for (const std::string_view each : k_stage_folders) folders.push_back(stage_.root() / each);
    for (const fs::path& folder : folders) {
      for (const ListedFile& file : files_in(folder)) {
        const bool temporary = file.name.starts_with('.') && file.name.ends_with(".tmp");
        if (temporary && now_ - file.changed >= age) {
          remove(file, "unfinished files of processes that died");
        }
      }
    }
  }

  void say_what_stays() {
    for (const std::string& each : sinks_) {
      report_.kept.push_back("results and journals, as a sink is at work: " + each);
    }
    for (const auto& [run, state] : runs_) {
      if (state.complete) continue;
      report_.kept.push_back("files of run " + to_hex(run) +
                             ", which is running or can be continued");
    }
  }

  bool is_old(const ListedFile& file) const { return now_ - file.changed >= options_.least_age; }

  void remove(const ListedFile& file, const std::string& what) {
    std::error_code error;
    if (!options_.dry_run && !fs::remove(file.path, error)) {
      if (error) log_warning("cannot remove " + file.path.string() + ": " + error.message());
      return;
    }
    auto& removed = report_.removed;
    auto found = std::find_if(removed.begin(), removed.end(),
                              [&](const auto& each) { return each.what == what; });
    if (found == removed.end()) found = removed.insert(removed.end(), {what, 0, 0});
    ++found->files;
    found->bytes += file.bytes;
  }

  const Stage& stage_;
  const CleanOptions& options_;
  CleanReport report_;
  fs::file_time_type now_;
  std::vector<std::string> sinks_;  // working now
  EndpointList endpoints_;
  std::map<std::uint64_t, Run> runs_;
  std::vector<Journal> journals_;
  std::set<JobKey> keys_;         // in any journal
  std::set<std::string> known_;   // results in any journal
  std::set<std::string> needed_;  // those for a run that is not complete
};

}  // namespace

CleanReport clean_stage(const Stage& stage, const CleanOptions& options) {
  if (options.dry_run) return Cleaning(stage, options).clean();
  const Claim claim(cleaning_claim(stage), stage.root().string() + ": is being cleaned");
  return Cleaning(stage, options).clean();
}

SinkPresence::SinkPresence(const Stage& stage) {
  std::random_device device;
  const std::uint64_t random = (std::uint64_t{device()} << 32) | device();
  try {
    claim_ = std::make_unique<Claim>(
        stage.root() / "control" /
            (std::string(k_sink_claim) + to_hex(random) + std::string(k_claim_end)),
        "a sink is at work");
  } catch (const IoError& error) {
    log_debug(error.what());  // on a full disk a run continues, and nothing is cleaned
  }
  // Whoever begins to clean from now on sees this.
  for (bool told = false; const auto holder = holder_of(cleaning_claim(stage)); told = true) {
    if (!told) log_info("the stage is being cleaned by " + *holder + "; waiting for its end");
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
}

}  // namespace meshfarm
