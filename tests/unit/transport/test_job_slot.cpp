// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
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

/// What the slot makes of a job that publishes what it reads, one section behind the other.
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
  ComputeGate gate(1);
  JobSlot slot(stage, work, gate, 7);
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

}  // namespace
}  // namespace meshfarm::test
