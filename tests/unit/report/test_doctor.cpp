// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <functional>

#include <doctest/doctest.h>

#include <meshfarm/report/doctor.hpp>

using namespace meshfarm;

namespace {

/// A healthy stage: a hard NFSv4.2 mount with room, quick, one host.
DoctorFacts healthy() {
  DoctorFacts facts;
  facts.stage = "/nfs/stage";
  facts.mount = {"/nfs",
                 "nfs4",
                 "server:/x",
                 {"rw", "vers=4.2", "hard", "proto=tcp", "rsize=1048576", "wsize=1048576"}};
  facts.free_bytes = 1'000'000'000;
  facts.part_bytes = 1'000'000;
  facts.probe.trips = {{1, 2, 3, 4}, {1, 2, 3, 4}, {100, 200, 300, 400}};
  facts.probe.keeps_private = true;
  facts.probe.has_links = true;
  facts.host = "pc1";
  facts.hosts = {"pc1", "pc2"};
  facts.file_limit = 1024;
  facts.workers = 24;
  facts.files_per_worker = 6;
  return facts;
}

/// The worst verdict of a check; good if there is none of that name.
Verdict verdict_on(const std::string& check, const std::function<void(DoctorFacts&)>& change) {
  DoctorFacts facts = healthy();
  change(facts);
  Verdict worst = Verdict::good;
  for (const Finding& each : diagnose(facts)) {
    if (each.check != check) continue;
    worst = std::max(worst, each.verdict);
    if (each.verdict == Verdict::bad) CHECK_FALSE(each.advice.empty());
  }
  return worst;
}

void set_option(DoctorFacts& facts, const std::string& name, const std::string& option) {
  std::erase_if(facts.mount.options, [&](const std::string& o) { return o.starts_with(name); });
  facts.mount.options.push_back(option);
}

}  // namespace

TEST_CASE("a stage as it should be is found so") {
  const auto findings = diagnose(healthy());
  CHECK(is_healthy(findings));
  for (const Finding& each : findings) {
    CAPTURE(each.check);
    CHECK(each.verdict == Verdict::good);
    CHECK(each.advice.empty());
  }
  CHECK(render(healthy(), findings, Format::text).find("sync 2.0 ms") != std::string::npos);
}

TEST_CASE("what loses data is bad") {
  using F = DoctorFacts;
  CHECK(verdict_on("soft mount", [](F& f) { set_option(f, "hard", "soft"); }) == Verdict::bad);
  CHECK(verdict_on("soft mount", [](F& f) { set_option(f, "hard", "softerr"); }) == Verdict::bad);
  CHECK(verdict_on("transport", [](F& f) { set_option(f, "proto", "proto=udp"); }) == Verdict::bad);
  CHECK(verdict_on("read-only", [](F& f) { set_option(f, "rw", "ro"); }) == Verdict::bad);
  CHECK(verdict_on("publishing", [](F& f) { f.probe.problem = "no"; }) == Verdict::bad);
  CHECK(verdict_on("space", [](F& f) { f.free_bytes = 400'000; }) == Verdict::bad);
  CHECK(verdict_on("host name", [](F& f) { f.host = "localhost.localdomain"; }) == Verdict::bad);
  CHECK(verdict_on("host name", [](F& f) { f.doubled_names = {"pc"}; }) == Verdict::bad);
  CHECK(verdict_on("open files", [](F& f) { f.workers = 1'000; }) == Verdict::bad);
  CHECK(verdict_on("private files", [](F& f) { f.probe.keeps_private = false; }) == Verdict::bad);
}

TEST_CASE("what costs time, or only looks odd, is noted") {
  using F = DoctorFacts;
  CHECK(verdict_on("caches", [](F& f) { f.mount.options.push_back("noac"); }) == Verdict::note);
  CHECK(verdict_on("caches", [](F& f) { set_option(f, "vers", "vers=3"); }) == Verdict::note);
  CHECK(verdict_on("caches", [](F& f) {
          set_option(f, "vers", "vers=3");
          f.mount.options.push_back("lookupcache=positive");
        }) == Verdict::good);
  CHECK(verdict_on("wsize", [](F& f) { set_option(f, "wsize", "wsize=8192"); }) == Verdict::note);
  CHECK(verdict_on("clock", [](F& f) { f.probe.clock_ahead_s = -30; }) == Verdict::note);
  CHECK(verdict_on("space", [](F& f) { f.free_bytes = 2'000'000; }) == Verdict::note);
  CHECK(verdict_on("space", [](F& f) { f.part_bytes = 0; }) == Verdict::note);
  CHECK(verdict_on("mount", [](F& f) { f.mount.type = "cifs"; }) == Verdict::note);
  CHECK(verdict_on("mount", [](F& f) { f.mount.type = "ext4"; }) == Verdict::note);
  CHECK(verdict_on("hard links", [](F& f) { f.probe.has_links = false; }) == Verdict::note);
  CHECK(verdict_on("publishing", [](F& f) { f.probe.trips = {{0, 300, 0, 0}}; }) == Verdict::note);
}

TEST_CASE("the same for programs") {
  DoctorFacts facts = healthy();
  facts.doubled_names = {"pc\xff"};  // a host card may contain any bytes
  const std::string json = render(facts, diagnose(facts), Format::json);
  CHECK(json.find("\"healthy\": false") != std::string::npos);
  CHECK(json.find("\"verdict\": \"bad\"") != std::string::npos);
  CHECK(json.find("\"sync_ms\": 2.0") != std::string::npos);
}
