// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include <meshfarm/report/doctor.hpp>
#include <meshfarm/util/text.hpp>

#include "report/json.hpp"
#include "report/lines.hpp"

namespace meshfarm {
namespace {

/// Bytes of results relative to the parts, measured: at 1 % of the triangles, and at 50 %.
constexpr double k_results_of_small_run = 0.5;
constexpr double k_results_of_large_run = 5;
constexpr double k_much_skew_s = 2;
constexpr double k_slow_publish_ms = 200;
constexpr std::uint32_t k_small_transfer = 65'536;
constexpr std::uint64_t k_files_beside_workers = 50;

class Doctor {
 public:
  explicit Doctor(const DoctorFacts& facts) : facts_(facts) {}

  std::vector<Finding> diagnose() {
    look_at_type();
    if (facts_.mount.is_nfs()) look_at_nfs();
    look_at_probe();
    look_at_space();
    look_at_hosts();
    look_at_files();
    return std::move(findings_);
  }

 private:
  void say(std::string check, Verdict verdict, std::string found, std::string advice = {}) {
    findings_.push_back({std::move(check), verdict, std::move(found), std::move(advice)});
  }

  void look_at_type() {
    const Mount& mount = facts_.mount;
    const std::string what = mount.type + " at " + mount.point + " from " + mount.source;
    if (mount.type.empty()) {
      say("mount", Verdict::note, "the system does not tell what is mounted here");
    } else if (mount.is_nfs()) {
      say("mount", Verdict::good, what + ", vers=" + mount.value("vers").value_or("?"));
    } else if (mount.type == "cifs" || mount.type == "smb3" || mount.type.starts_with("fuse")) {
      say("mount", Verdict::note, what,
          "only NFS was tried; see that files appear on other hosts as soon as they are renamed");
    } else {
      say("mount", Verdict::note, what + ": seen by this host only, unless it is exported",
          "for workers on other hosts put the stage on NFS");
    }
    if (mount.has("ro")) {
      say("read-only", Verdict::bad, "the stage cannot be written to", "mount it with rw");
    }
  }

  void look_at_nfs() {
    const Mount& mount = facts_.mount;
    if (mount.has("soft") || mount.has("softerr")) {
      say("soft mount", Verdict::bad,
          "a server that is away for a while makes writes fail, and files end empty",
          "mount it with hard; runs refuse it unless they are told --allow-soft");
    } else {
      say("hard mount", Verdict::good, "reads and writes wait while the server is away");
    }
    if (mount.value("proto").value_or("tcp").starts_with("udp")) {
      say("transport", Verdict::bad, "UDP, which can damage data at high rates",
          "mount it with proto=tcp");
    }
    look_at_caches();
    for (const char* transfer : {"rsize", "wsize"}) {
      const std::string text = mount.value(transfer).value_or("");
      std::uint32_t size = k_small_transfer;
      std::from_chars(text.data(), text.data() + text.size(), size);
      if (size < k_small_transfer) {
        say(transfer, Verdict::note, text + " bytes a request are slow",
            std::string("mount it without ") + transfer + ", or with 1048576");
      }
    }
  }

  void look_at_caches() {
    const Mount& mount = facts_.mount;
    const std::string lookup = mount.value("lookupcache").value_or("all");
    if (lookup == "none" || mount.has("noac")) {
      say("caches", Verdict::note, "switched off, so every look at a file asks the server",
          "a run needs no lookupcache=none and no noac");
      return;
    }
    std::string found = "lookupcache=" + lookup;
    for (const char* option : {"actimeo", "acregmin", "acregmax", "acdirmin", "acdirmax"}) {
      if (const auto value = mount.value(option)) found += std::string(" ") + option + "=" + *value;
    }
    const bool version_3 = mount.value("vers").value_or("3").starts_with('3');
    if (version_3 && lookup == "all") {
      say("caches", Verdict::note,
          found + " on NFSv3: a name asked for too early can stay unseen for a minute",
          "meshfarm needs no change: it asks for no name before it is told of it; vers=4.2 or "
          "lookupcache=positive spare other programs the wait");
    } else {
      say("caches", Verdict::good, found);
    }
  }

  void look_at_probe() {
    const FolderProbe& probe = facts_.probe;
    if (!probe.problem.empty()) {
      say("publishing", Verdict::bad, probe.problem,
          "writing, syncing, renaming and reading back must work for the user of the run");
      return;
    }
    const double publish =
        median(&RoundTrip::write) + median(&RoundTrip::sync) + median(&RoundTrip::rename);
    const std::string times = "write " + ms(median(&RoundTrip::write)) + ", sync " +
                              ms(median(&RoundTrip::sync)) + ", rename " +
                              ms(median(&RoundTrip::rename)) + ", read back " +
                              ms(median(&RoundTrip::read)) + " (medians of " +
                              std::to_string(probe.trips.size()) + " files of 100 kB)";
    if (publish > k_slow_publish_ms) {
      say("publishing", Verdict::note, times,
          "slow: a farther server, or a 'sync' export on slow disks; larger parts (cut with fewer "
          "--parts) wait less often");
    } else {
      say("publishing", Verdict::good, times);
    }
    const std::string skew = number(probe.clock_ahead_s, "%+.1f") + " s against this host";
    if (std::abs(probe.clock_ahead_s) > k_much_skew_s) {
      say("clock", Verdict::note, "the server's is at " + skew,
          "runs do not depend on it, but logs and make do: set the clocks by NTP");
    } else {
      say("clock", Verdict::good, "the server's is at " + skew);
    }
    if (!probe.keeps_private) {
      say("private files", Verdict::bad, "whatever is written here can be read by others",
          "keep the run's keys elsewhere with --key-file");
    }
    if (!probe.has_links) {
      say("hard links", Verdict::note, "this file system does not support them",
          "start no two ventilators of a run at the same moment");
    }
  }

  void look_at_space() {
    const std::string free = with_unit(facts_.free_bytes) + " free";
    if (facts_.part_bytes == 0) {
      say("space", Verdict::note, free + "; nothing is cut yet",
          "a cut takes about 20 bytes a triangle");
      return;
    }
    const auto parts = static_cast<double>(facts_.part_bytes);
    const auto least = static_cast<std::uint64_t>(k_results_of_small_run * parts);
    const auto most = static_cast<std::uint64_t>(k_results_of_large_run * parts);
    const std::string wanted =
        ", a run to 1 % takes about " + with_unit(least) + ", one to 50 % about " + with_unit(most);
    if (facts_.free_bytes < least) {
      say("space", Verdict::bad, free + wanted, "make room; a full disk stops a run, resumable");
    } else if (facts_.free_bytes < most) {
      say("space", Verdict::note, free + wanted, "make room before runs to many triangles");
    } else {
      say("space", Verdict::good, free + wanted);
    }
  }

  void look_at_hosts() {
    if (facts_.host.empty() || facts_.host.starts_with("localhost")) {
      say("host name", Verdict::bad, "this host is called '" + facts_.host + "', as others may be",
          "give it a name of its own: an NFSv4 server takes hosts of one name for one client");
    }
    for (const std::string& name : facts_.doubled_names) {
      say("host name", Verdict::bad, "two hosts are called '" + name + "'",
          "rename one (or set nfs.nfs4_unique_id): an NFSv4 server takes them for one client, "
          "which "
          "stalls renames and loses state");
    }
    if (facts_.doubled_names.empty()) {
      say("hosts", Verdict::good,
          std::to_string(facts_.hosts.size()) + " known to this stage" +
              (facts_.hosts.empty() ? "" : ": " + joined(facts_.hosts)));
    }
  }

  void look_at_files() {
    const std::uint64_t wanted =
        k_files_beside_workers + std::uint64_t{facts_.files_per_worker} * facts_.workers;
    const std::string found = "a process may open " + std::to_string(facts_.file_limit) +
                              " files, a ventilator of " + std::to_string(facts_.workers) +
                              " workers opens " + std::to_string(wanted);
    if (wanted > facts_.file_limit) {
      say("open files", Verdict::bad, found,
          "raise the hard limit ('ulimit -Hn', limits.conf), or start fewer workers with more "
          "--threads");
    } else {
      say("open files", Verdict::good, found);
    }
  }

  double median(double RoundTrip::*step) const {
    std::vector<double> times;
    for (const RoundTrip& trip : facts_.probe.trips) times.push_back(trip.*step);
    std::sort(times.begin(), times.end());
    return times.empty() ? 0 : times[times.size() / 2];
  }
  static std::string ms(double value) { return number(value, "%.1f") + " ms"; }
  static std::string with_unit(std::uint64_t bytes) {
    constexpr std::array k_units = {"B", "kB", "MB", "GB", "TB", "PB"};
    auto value = static_cast<double>(bytes);
    std::size_t unit = 0;
    for (; value >= 999.5 && unit + 1 < k_units.size(); ++unit) value /= 1000;
    return number(value, value < 10 && unit > 0 ? "%.1f " : "%.0f ") + k_units.at(unit);
  }

  const DoctorFacts& facts_;
  std::vector<Finding> findings_;
};

std::string word_for(Verdict verdict) {
  switch (verdict) {
    case Verdict::good:
      return "good";
    case Verdict::note:
      return "note";
    case Verdict::bad:
      return "BAD";
  }
  return {};
}

std::string render_json(const DoctorFacts& facts, const std::vector<Finding>& findings) {
  Json list = Json::array();
  for (const Finding& each : findings) {
    Json json = {{"check", each.check},
                 {"verdict", each.verdict == Verdict::bad ? "bad" : word_for(each.verdict)},
                 {"found", each.found}};
    if (!each.advice.empty()) json["advice"] = each.advice;
    list.push_back(std::move(json));
  }
  Json trips = Json::array();
  for (const RoundTrip& trip : facts.probe.trips) {
    trips.push_back({{"write_ms", trip.write},
                     {"sync_ms", trip.sync},
                     {"rename_ms", trip.rename},
                     {"read_ms", trip.read}});
  }
  const Json json = {{"stage", facts.stage},
                     {"healthy", is_healthy(findings)},
                     {"mount",
                      {{"type", facts.mount.type},
                       {"source", facts.mount.source},
                       {"point", facts.mount.point},
                       {"options", facts.mount.options}}},
                     {"free_bytes", facts.free_bytes},
                     {"clock_ahead_s", facts.probe.clock_ahead_s},
                     {"hosts", facts.hosts},
                     {"file_limit", facts.file_limit},
                     {"round_trips", std::move(trips)},
                     {"findings", std::move(list)}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::vector<Finding> diagnose(const DoctorFacts& facts) {
  return Doctor(facts).diagnose();
}

bool is_healthy(const std::vector<Finding>& findings) {
  return std::none_of(findings.begin(), findings.end(),
                      [](const Finding& each) { return each.verdict == Verdict::bad; });
}

std::string render(const DoctorFacts& facts, const std::vector<Finding>& findings, Format format) {
  if (format == Format::json) return render_json(facts, findings);
  std::string text;
  for (const Finding& each : findings) {
    std::string check = each.check;
    check.resize(std::max<std::size_t>(check.size(), 14), ' ');
    text += word_for(each.verdict) + (each.verdict == Verdict::bad ? "   " : "  ") + check + " " +
            each.found + "\n";
    if (!each.advice.empty()) text += std::string(21, ' ') + "-> " + each.advice + "\n";
  }
  return text;
}

}  // namespace meshfarm
