// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <atomic>
#include <string>
#include <variant>

#include <doctest/doctest.h>
#include <poll.h>

#include <meshfarm/staging/sections.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/temp_folder.hpp"
#include "transport/job_slot.hpp"

namespace meshfarm::test {
namespace {

/// The slot's outcome for a job that publishes what it reads, section after section.
JobOutcome outcome_of(const Stage& stage, const Job& job) {
  const JobFunction work = [](const Job& given, const JobContext& context) {
    std::string read;
    for (std::size_t i = 0; i < given.sections.size(); ++i) {
      read += context.read_section(given, i) + "|";
    }
    if (given.sections.empty()) read = context.read(given.inputs.at(0));
    const ResultName name{key_of(given).value, context.attempt, context.incarnation};
    return JobOutput{context.publish(name, read), {}};
  };
  WorkerGates gates(1);
  JobSlot slot(stage, work, gates, 7);
  slot.begin({0, 1, key_of(job), job});
  pollfd finished{slot.fd(), POLLIN, 0};
  REQUIRE(::poll(&finished, 1, 10'000) == 1);
  REQUIRE(slot.take_finished());
  return slot.outcome();
}

TEST_CASE("a job reads the sections of its inputs, empty ones and those beside them, too") {
  const TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  std::string bytes;
  SectionWriter writer([&](std::string_view more) { bytes += more; });
  const FileSection head = writer.add("head");
  const FileSection empty = writer.add("");
  const FileSection tail = writer.add("tail");
  Job job{"read", {stage.publish(PartName{0}, bytes)}, {}, 1};
  for (const std::uint64_t ahead : {1'000, 0}) {  // with room to read ahead, and without
    CAPTURE(ahead);
    job.memory = ahead;
    job.sections = {{0, empty}, {0, tail}, {0, head}, {0, tail}};
    const JobOutcome made = outcome_of(stage, job);
    REQUIRE(std::holds_alternative<JobOutput>(made));
    CHECK(stage.read(std::get<JobOutput>(made).file) == "|tail|head|tail|");
    job.sections.clear();
    const JobOutcome whole = outcome_of(stage, job);
    REQUIRE(std::holds_alternative<JobOutput>(whole));
    CHECK(stage.read(std::get<JobOutput>(whole).file) == "headtail");
  }
}

TEST_CASE("a section that is damaged is the fault of the input") {
  const TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  Job job{"read", {stage.publish(PartName{0}, "content")}, {}, 1};
  job.sections = {{0, {0, 4, 1}}};
  const JobOutcome made = outcome_of(stage, job);
  REQUIRE(std::holds_alternative<JobFailure>(made));
  CHECK(std::get<JobFailure>(made).kind == FailureKind::damaged_input);
}

TEST_CASE("a job that reads much waits for its turn, one that reads little does not") {
  const TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  const JobFunction work = [](const Job& given, const JobContext& context) {
    const ResultName name{key_of(given).value, context.attempt, context.incarnation};
    return JobOutput{context.publish(name, std::to_string(context.read(given.inputs[0]).size())),
                     {}};
  };
  WorkerGates gates(1);
  const std::atomic<bool> never{false};
  REQUIRE(gates.reading.enter(never));  // like another slot that reads a lot
  JobSlot slot(stage, work, gates, 7);
  const auto begin = [&](std::size_t bytes) {
    Job job{"read", {stage.publish(PartName{0}, std::string(bytes, 'x'))}, {}, 1};
    job.memory = 2 * bytes;
    slot.begin({0, 1, key_of(job), job});
  };
  const auto ends_within = [&](int ms) {
    pollfd finished{slot.fd(), POLLIN, 0};
    return ::poll(&finished, 1, ms) == 1 && slot.take_finished();
  };
  begin(k_much_input - 1);
  REQUIRE(ends_within(10'000));
  CHECK(std::holds_alternative<JobOutput>(slot.outcome()));

  begin(k_much_input);
  CHECK_FALSE(ends_within(100));
  CHECK(slot.pulse().phase == JobPhase::waiting);
  SUBCASE("until the turn comes") {
    gates.reading.leave();
    REQUIRE(ends_within(10'000));
    CHECK(std::holds_alternative<JobOutput>(slot.outcome()));
    CHECK(gates.reading.enter(never));  // it has left
  }
  SUBCASE("or it is given up") {
    slot.give_up();
    REQUIRE(ends_within(10'000));
    CHECK(std::holds_alternative<JobFailure>(slot.outcome()));
    gates.reading.leave();
    CHECK(gates.reading.enter(never));  // it took no place
  }
}

}  // namespace
}  // namespace meshfarm::test
