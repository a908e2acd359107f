// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <filesystem>

#include <doctest/doctest.h>

#include <meshfarm/farm/ledger.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/seeds.hpp"
#include "support/temp_folder.hpp"

namespace meshfarm {
namespace {

AcceptedJob accepted(std::uint64_t key, std::uint32_t attempt) {
  return {{key}, {{to_string(ResultName{key, attempt, 5}), 10, 20}, "summary"}};
}

std::string record_of(const AcceptedJob& job, std::uint64_t run = 7) {
  return encode_record({run, job});
}

TEST_CASE("a record comes back as it was, cut or forged not at all") {
  const std::string record = record_of(accepted(1, 2));
  const AcceptedJob back = decode_record(record, "r").accepted;
  CHECK(back.key == JobKey{1});
  CHECK(decode_record(record_of(accepted(1, 2), 9), "r").run == 9);
  CHECK(back.output.file == accepted(1, 2).output.file);
  CHECK(back.output.summary == "summary");
  for (std::size_t size = 0; size < record.size(); ++size) {
    CHECK_THROWS_AS(decode_record(record.substr(0, size), "r"), DataError);
  }
  AcceptedJob forged = accepted(1, 2);
  for (const std::string name : {"../../etc/passwd", "manifest", "", "results/x"}) {
    forged.output.file.name = name;
    CHECK_THROWS_AS(decode_record(record_of(forged), "r"), DataError);
  }
  forged.output.file.name = accepted(2, 2).output.file.name;  // another job's
  CHECK_THROWS_AS(decode_record(record_of(forged), "r"), DataError);
}

TEST_CASE("the fuzzer begins from records of this version") {
  const test::TempFolder folder;
  const std::vector<std::string> records = {record_of(accepted(255, 2)), record_of(accepted(1, 1))};
  JournalWriter(folder / "journal").append_all(records);
  test::check_seed("journal_record", "record", records[0]);
  test::check_seed("journal_record", "journal", read_file(folder / "journal"));
}

TEST_CASE("a record that does not decode is set aside, those after it count") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  const std::vector<std::string> records = {record_of(accepted(1, 1)), "of a version to come",
                                            record_of(accepted(2, 1))};
  open_journal(stage).append_all(records);
  CHECK(read_journals(stage, 7).accepted.size() == 2);
}

TEST_CASE("records of the version before, which tell of no run, are read") {
  std::string record = record_of(accepted(1, 2));
  record.erase(4, 8);
  record[0] = 1;
  const JournalRecord old = decode_record(record, "r");
  CHECK(old.run == 0);
  CHECK(old.accepted.output.file == accepted(1, 2).output.file);
}

TEST_CASE("a ledger tells what a run accepted itself") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  open_journal(stage).append(record_of(accepted(1, 1), 7));
  open_journal(stage).append(record_of(accepted(2, 1), 8));
  const Ledger ledger = read_journals(stage, 8);
  CHECK(ledger.accepted.size() == 2);
  CHECK(ledger.by_run == std::set<JobKey>{{2}});
}

TEST_CASE("the journals of a stage are read in order, torn and foreign ones as far as they go") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  open_journal(stage).append(record_of(accepted(1, 1)));
  const std::vector<std::string> records = {record_of(accepted(1, 2)), record_of(accepted(2, 1)),
                                            record_of(accepted(3, 1))};
  open_journal(stage).append_all(records);
  REQUIRE(stage.journals().size() == 2);
  const auto second = stage.path(JournalName{2});
  std::filesystem::resize_file(second, std::filesystem::file_size(second) - 1);
  stage.publish(JournalName{7}, "this is no journal");
  open_journal(stage).append("no record of ours");

  const auto all = read_journals(stage, 7).accepted;
  REQUIRE(all.size() == 2);
  CHECK(all.at({1}).file == accepted(1, 2).output.file);
  CHECK(all.at({2}).file == accepted(2, 1).output.file);
  CHECK(stage.journals().back() == 8);
}

}  // namespace
}  // namespace meshfarm
