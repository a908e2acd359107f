// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include <doctest/doctest.h>

#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/farm/ledger.hpp>
#include <meshfarm/pipeline/clean_stage.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/temp_folder.hpp"

using namespace meshfarm;
namespace fs = std::filesystem;

namespace {

/// A stage, and what runs leave in it. Everything counts as old at once.
struct CleanBench {
  test::TempFolder folder;
  Stage stage = Stage::create(folder / "stage");
  CleanOptions options{CleanWhat::finished_runs, false, std::chrono::seconds(0),
                       std::chrono::seconds(0)};

  /// Publishes a result file of this worker, and returns its name.
  std::string result(std::uint64_t key, std::uint64_t worker) const {
    const ResultName name{key, 1, worker};
    stage.publish(name, "result");
    return to_string(name);
  }
  /// A run with one journal that accepted such a result of each job.
  void run(std::uint64_t run, const std::vector<std::uint64_t>& keys) const {
    JournalWriter journal = open_journal(stage);
    for (const std::uint64_t key : keys) {
      const std::string name = result(key, run);
      journal.append(encode_record({run, {{key}, {{name, 6, checksum("result")}, {}}}}));
    }
  }
  std::uint32_t endpoint(std::uint64_t run, const std::string& address, bool done = false) const {
    Endpoint endpoint{0, run, address, "host", 1, {}};
    endpoint.done = done;
    return publish_endpoint(stage, endpoint, "u").epoch;
  }
  bool has(std::uint64_t key, std::uint64_t worker) const {
    return fs::exists(stage.path(ResultName{key, 1, worker}));
  }
  std::uint64_t removed(const CleanReport& report, const std::string& what) const {
    for (const auto& each : report.removed) {
      if (each.what.find(what) != std::string::npos) return each.files;
    }
    return 0;
  }
};

}  // namespace

TEST_CASE("of a finished run nothing but the newest numbers stays") {
  const CleanBench bench;
  bench.endpoint(7, "tcp://a");
  bench.run(7, {1, 2});
  bench.endpoint(7, "", true);
  std::ofstream(bench.stage.root() / "results" / "notes.txt") << "not ours";
  const CleanReport report = clean_stage(bench.stage, bench.options);
  CHECK(bench.removed(report, "results of finished runs") == 2);
  CHECK(bench.removed(report, "journals") == 1);
  CHECK(bench.removed(report, "addresses") == 1);
  CHECK(report.kept.empty());
  CHECK_FALSE(bench.has(1, 7));
  CHECK(read_journals(bench.stage, 7).accepted.empty());
  CHECK(bench.stage.journals() == std::vector<std::uint32_t>{2});
  CHECK(bench.stage.epochs() == std::vector<std::uint32_t>{2});
  CHECK(fs::exists(bench.stage.root() / "results" / "notes.txt"));
  CHECK(clean_stage(bench.stage, bench.options).removed.empty());
}

TEST_CASE("what a run has that can be taken up is kept, shared or not") {
  const CleanBench bench;
  bench.endpoint(7, "", true);
  bench.run(7, {1, 2});
  const auto live = bench.endpoint(8, "tcp://b");
  bench.run(8, {3});
  // The run takes up a result of the finished one.
  const ResultName shared{1, 1, 7};
  open_journal(bench.stage)
      .append(encode_record({8, {{1}, {{to_string(shared), 6, checksum("result")}, {}}}}));
  SUBCASE("its ventilator may live") {}
  SUBCASE("it ended, but not because all was done") {
    bench.endpoint(8, "");
  }
  const CleanReport report = clean_stage(bench.stage, bench.options);
  CHECK(bench.has(1, 7));
  CHECK_FALSE(bench.has(2, 7));
  CHECK(bench.has(3, 8));
  CHECK(read_journals(bench.stage, 8).by_run.size() == 2);
  CHECK(read_journals(bench.stage, 8).accepted.size() == 2);
  REQUIRE(report.kept.size() == 1);
  CHECK(report.kept[0].find(to_hex(8)) != std::string::npos);
  CHECK((bench.stage.epochs().back() >= live));
}

TEST_CASE("records that name no run are kept, as their run is not known to be over") {
  const CleanBench bench;
  bench.endpoint(7, "", true);
  bench.run(0, {1});
  clean_stage(bench.stage, bench.options);
  CHECK(bench.has(1, 0));
}

TEST_CASE("losers, and files of the dead, go; young ones stay") {
  CleanBench bench;
  bench.endpoint(7, "tcp://a");
  bench.run(7, {1});
  bench.result(1, 99);  // a second attempt that came too late
  bench.result(2, 99);  // of a job that is not done
  std::ofstream(bench.stage.root() / "parts" / ".000001.part.x.tmp") << "torn";
  std::ofstream(bench.stage.root() / "results" / ".x.tmp") << "torn";
  SUBCASE("old") {
    const CleanReport report = clean_stage(bench.stage, bench.options);
    CHECK(bench.removed(report, "no run took") == 2);
    CHECK(bench.removed(report, "unfinished") == 2);
    CHECK_FALSE(bench.has(1, 99));
    CHECK_FALSE(bench.has(2, 99));
  }
  SUBCASE("young") {
    bench.options.least_age = bench.options.least_age_in_run = std::chrono::seconds(1000);
    const CleanReport report = clean_stage(bench.stage, bench.options);
    CHECK(bench.removed(report, "no run took") == 1);
    CHECK_FALSE(bench.has(1, 99));  // whatever its age: another was accepted
    CHECK(bench.has(2, 99));
    CHECK(bench.removed(report, "unfinished") == 0);
  }
  CHECK(bench.has(1, 7));
}

TEST_CASE("while a sink is at work results and journals are left alone") {
  const CleanBench bench;
  bench.endpoint(7, "tcp://a");
  bench.run(7, {1});
  bench.endpoint(7, "", true);
  bench.result(1, 99);
  std::optional<SinkPresence> sink(bench.stage);
  const CleanReport report = clean_stage(bench.stage, bench.options);
  CHECK(bench.has(1, 7));
  CHECK(bench.has(1, 99));
  CHECK(read_journals(bench.stage, 7).accepted.size() == 1);
  REQUIRE(report.kept.size() == 1);
  CHECK(report.kept[0].find("a sink is at work") != std::string::npos);
  sink.reset();
  clean_stage(bench.stage, bench.options);
  CHECK_FALSE(bench.has(1, 7));
}

TEST_CASE("after a run only what nobody can need goes by itself") {
  CleanBench bench;
  bench.options.what = CleanWhat::leftovers;
  bench.run(7, {1});
  bench.endpoint(7, "", true);
  bench.result(1, 99);
  clean_stage(bench.stage, bench.options);
  CHECK(bench.has(1, 7));
  CHECK_FALSE(bench.has(1, 99));
  CHECK(read_journals(bench.stage, 7).accepted.size() == 1);
}

TEST_CASE("a dry run removes nothing and tells the same") {
  CleanBench bench;
  bench.endpoint(7, "tcp://a");
  bench.run(7, {1, 2});
  bench.endpoint(7, "", true);
  bench.options.dry_run = true;
  const CleanReport told = clean_stage(bench.stage, bench.options);
  CHECK(bench.has(1, 7));
  CHECK(bench.stage.journals().size() == 1);
  bench.options.dry_run = false;
  const CleanReport done = clean_stage(bench.stage, bench.options);
  REQUIRE(told.removed.size() == done.removed.size());
  for (std::size_t i = 0; i < told.removed.size(); ++i) {
    CHECK(told.removed[i].files == done.removed[i].files);
    CHECK(told.removed[i].bytes == done.removed[i].bytes);
  }
  CHECK(render(told, Format::text).find("would remove") != std::string::npos);
  CHECK(render(done, Format::json).find("\"dry_run\": false") != std::string::npos);
}

TEST_CASE("two do not clean one stage at once") {
  const CleanBench bench;
  const Claim other(bench.stage.root() / "control" / ".clean.claim", "cleaning");
  CHECK_THROWS_WITH_AS(clean_stage(bench.stage, bench.options),
                       doctest::Contains("is being cleaned"), DataError);
}
