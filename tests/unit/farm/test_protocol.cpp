// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/seeds.hpp"

namespace meshfarm {
namespace {

/// One of each message, with no field left at its default.
std::vector<Message> one_of_each() {
  const FileRef part{"parts/000001.part", 123, 456};
  JobOutput output;  // in steps: g++ 12 warns of an uninitialised value otherwise
  output.file = {"results/00000000000000ff.a2.0000000000000001", 9, 10};
  output.summary = "summary";
  const JobFailure failure{"the disk is full", FailureKind::no_space};
  Job job{"simplify", {part, part}, std::string("\0\1\2", 3), 77, 88, 99};
  job.sections = {{1, {16, 100, 789}}};
  return {Hello{Role::sink, 1, 2, 3, "host", "tcp://h:1", {4, 5, 6, 7}, 8},
          Welcome{{4}, 5, 6, "tcp://h:2", "tcp://h:3", 1000, 7},
          Refused{Refusal::replaced, "why"},
          Heartbeat{1, {2}, 3, 4, 5, {6}, 7, true, 8, true},
          Alive{7, "tcp://h:5", 8},
          Credit{1, {2}, 1ULL << 40},
          Release{1, {2}},
          Assignment{1, 2, 3, 4, job},
          Result{1, 2, {3}, 4, 5, {6}, output, {7, 8, 9, 10, 11}},
          Result{1, 2, {3}, 4, 5, {6}, failure, {7, 8, 9, 10, 11}},
          Accept{1, {2}, {3}, output, {4, 5, 6, 7, 8}, 9},
          Reject{1, {2}, 3, {4}, failure, {"results/x", 5, 6}},
          Ready{9, 10, 11},
          Done{{10}, 11},
          SinkAt{"tcp://h:4"},
          JobFailed{{11}, "poison", true},
          Complete{12},
          Failed{13, "no space", true},
          Stop{StopReason::leaving},
          TryRead{{12}, 13, part},
          TriedRead{1, {2}, {3}, 4, true}};
}

TEST_CASE("every message comes back as it was") {
  std::vector<bool> seen(std::variant_size_v<Message>, false);
  for (const Message& message : one_of_each()) {
    const std::string frame = encode(message);
    const Message back = decode(frame);
    CHECK(back.index() == message.index());
    CHECK(encode(back) == frame);
    seen[message.index()] = true;
  }
  for (const bool each : seen) CHECK(each);
}

TEST_CASE("the fuzzer begins from each message of this version") {
  const std::vector<std::string> names = {
      "hello",      "welcome",    "refused",       "heartbeat", "alive",  "credit",   "release",
      "assignment", "result_ok",  "result_failed", "accept",    "reject", "ready",    "done",
      "sink_at",    "job_failed", "complete",      "failed",    "stop",   "try_read", "tried_read"};
  const std::vector<Message> messages = one_of_each();
  REQUIRE(names.size() == messages.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    test::check_seed("message", names[i], encode(messages[i]));
  }
}

TEST_CASE("fields come back in their own places") {
  const Message message = decode(encode(one_of_each()[7]));
  const auto& assignment = std::get<Assignment>(message);
  CHECK(assignment.run == 1);
  CHECK(assignment.epoch == 2);
  CHECK(assignment.lane_seq == 3);
  CHECK(assignment.attempt == 4);
  CHECK(assignment.job.kind == "simplify");
  REQUIRE(assignment.job.inputs.size() == 2);
  CHECK(assignment.job.inputs[1] == FileRef{"parts/000001.part", 123, 456});
  REQUIRE(assignment.job.sections.size() == 1);
  CHECK(assignment.job.sections[0] == InputSection{1, {16, 100, 789}});
  CHECK(assignment.job.parameters == std::string("\0\1\2", 3));
  CHECK(assignment.job.cost == 77);
  CHECK(assignment.job.memory == 88);
  CHECK(assignment.job.algorithm == 99);
  const Message failed = decode(encode(one_of_each()[9]));
  const auto& failure = std::get<JobFailure>(std::get<Result>(failed).outcome);
  CHECK(failure.reason == "the disk is full");
  CHECK(failure.kind == FailureKind::no_space);
}

TEST_CASE("a section of an input that the job has not is refused") {
  Assignment assignment = std::get<Assignment>(one_of_each()[7]);
  assignment.job.sections[0].input = 2;
  CHECK_THROWS_AS(decode(encode(assignment)), DataError);
}

TEST_CASE("a frame cut at any byte, or longer by one, is refused") {
  for (const Message& message : one_of_each()) {
    const std::string frame = encode(message);
    for (std::size_t size = 0; size < frame.size(); ++size) {
      CHECK_THROWS_AS(decode(std::string_view(frame).substr(0, size)), DataError);
    }
    CHECK_THROWS_AS(decode(frame + '\0'), DataError);
  }
}

TEST_CASE("a frame with any byte changed is refused, or is another message in canonical form") {
  for (const Message& message : one_of_each()) {
    const std::string frame = encode(message);
    for (std::size_t i = 0; i < frame.size(); ++i) {
      for (const char flip : {'\1', '\x80', '\xff'}) {
        std::string changed = frame;
        changed[i] = static_cast<char>(changed[i] ^ flip);
        std::string again = changed;
        try {
          again = encode(decode(changed));
        } catch (const DataError&) {  // refused, as it should be unless it is a message
        }
        CHECK(again == changed);
      }
    }
  }
}

TEST_CASE("strangers' frames are refused with a reason") {
  const std::string frame = encode(Complete{1});
  std::string other_magic = frame;
  other_magic[0] = 'X';
  CHECK_THROWS_WITH_AS(decode(other_magic), doctest::Contains("not a message of ours"), DataError);
  std::string other_version = frame;
  other_version[4] = 2;
  CHECK_THROWS_WITH_AS(decode(other_version), doctest::Contains("version"), DataError);
  for (const char type : {'\0', '\x15', '\x7f'}) {
    std::string other_type = frame;
    other_type[6] = type;
    CHECK_THROWS_WITH_AS(decode(other_type), doctest::Contains("unknown type"), DataError);
  }
  CHECK_THROWS_AS(decode(std::string(k_max_frame_bytes + 1, 'x')), DataError);
}

TEST_CASE("who speaks another version is told so in a frame of that version") {
  CHECK_FALSE(other_version_of(encode(Complete{1})));
  CHECK_FALSE(other_version_of("MFMS"));
  CHECK_FALSE(other_version_of("GET / HTTP/1.1"));
  std::string frame = encode(Complete{1});
  frame[4] = 2;
  CHECK(other_version_of(frame) == 2);
  std::string refusal = encode_refusal(2, "why");
  CHECK(refusal == std::string("MFMS\2\0\3\0\3\3\0\0\0why", 16));
  refusal[4] = static_cast<char>(k_protocol_version);
  CHECK(std::get<Refused>(decode(refusal)).reason == "why");
}

TEST_CASE("numbers on the wire never change") {
  CHECK(encode(Stop{StopReason::leaving}) == std::string("MFMS\11\0\x12\0\2", 9));
  CHECK(encode(Credit{1, {2}, 3}) ==
        std::string("MFMS\11\0\6\0\1\0\0\0\2\0\0\0\3\0\0\0\0\0\0\0", 24));
}

TEST_CASE("what is too long for a message is refused by the sender") {
  Job job{"simplify", {}, std::string(k_max_parameters_bytes, 'p'), 1};
  CHECK(decode(encode(Assignment{1, 1, 1, 1, job})).index() == 7);
  job.parameters += 'p';
  CHECK_THROWS_AS(encode(Assignment{1, 1, 1, 1, job}), DataError);
  job.parameters.clear();
  job.inputs.assign(4000, FileRef{std::string(150, 'p'), 1, 2});
  CHECK_THROWS_AS(encode(Assignment{1, 1, 1, 1, job}), DataError);
  CHECK_THROWS_AS(encode(Refused{Refusal::full, std::string(k_max_text_bytes + 1, 'x')}),
                  DataError);
  CHECK(clipped(std::string(k_max_text_bytes + 1, 'x')).size() == k_max_text_bytes);
}

TEST_CASE("a forged count allocates nothing") {
  std::string frame = encode(Assignment{1, 2, 3, 4, {"k", {}, "", 1}});
  const std::size_t count_at = 8 + 8 + 4 + 8 + 4 + 5;
  frame[count_at] = '\xff';
  frame[count_at + 1] = '\x0f';
  CHECK_THROWS_WITH_AS(decode(frame), doctest::Contains("list too long"), DataError);
}

TEST_CASE("a job's key is its content") {
  const Job job{"simplify", {{"parts/000001.part", 1, 2}}, "p", 3};
  Job other = job;
  other.inputs[0].name = "parts/000002.part";
  other.cost = 4;
  CHECK(key_of(other) == key_of(job));
  CHECK(key_of(job).value ==
        13621565660128742218ULL);  // the recipe must not change: journals are keyed by it
  other = job;
  other.kind = "stitch";
  CHECK(key_of(other) != key_of(job));
  other = job;
  other.inputs[0].hash = 3;
  CHECK(key_of(other) != key_of(job));
  other = job;
  other.algorithm = 1;
  CHECK(key_of(other) != key_of(job));
  other = job;
  other.parameters = "q";
  CHECK(key_of(other) != key_of(job));
}

}  // namespace
}  // namespace meshfarm
