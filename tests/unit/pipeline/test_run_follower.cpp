// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <fstream>

#include <doctest/doctest.h>

#include <meshfarm/pipeline/run_follower.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/temp_folder.hpp"

namespace meshfarm {
namespace {

void append(const Stage& stage, std::uint32_t epoch, const std::string& text) {
  std::filesystem::create_directory(stage.root() / "log");
  std::ofstream(stage.path(TraceName{epoch}), std::ios::binary | std::ios::app) << text;
}

std::string head_line(std::uint32_t epoch) {
  TraceHead head;
  head.epoch = epoch;
  return to_line(head) + "\n";
}

TEST_CASE("who follows a stage sees what is added, line by line, and the next run") {
  test::TempFolder folder;
  const Stage stage = Stage::create(folder / "stage");
  RunFollower follower(stage);
  std::optional<Trace> trace;
  follower.look(trace);
  CHECK_FALSE(trace);
  append(stage, 1, head_line(1).substr(0, 10));
  follower.look(trace);
  CHECK_FALSE(trace);
  append(stage, 1, head_line(1).substr(10));
  follower.look(trace);
  REQUIRE(trace);
  CHECK(trace->head.epoch == 1);

  const std::string joined = to_line(TraceJoined{1, 7, "host"}) + "\n";
  append(stage, 1, joined + joined.substr(0, 5));
  follower.look(trace);
  CHECK(trace->joined.size() == 1);
  follower.look(trace);
  CHECK(trace->joined.size() == 1);
  append(stage, 1, joined.substr(5));
  follower.look(trace);
  CHECK(trace->joined.size() == 2);

  append(stage, 2, "");  // the next epoch has begun, and told nothing yet
  follower.look(trace);
  CHECK(trace->head.epoch == 1);
  append(stage, 2, head_line(2));
  follower.look(trace);
  CHECK(trace->head.epoch == 2);
  CHECK(trace->joined.empty());
}

TEST_CASE("a follower that read damage starts anew") {
  test::TempFolder folder;
  const Stage stage = Stage::create(folder / "stage");
  RunFollower follower(stage);
  std::optional<Trace> trace;
  append(stage, 1, head_line(1));
  follower.look(trace);
  append(stage, 1, "no JSON\n");
  CHECK_THROWS_AS(follower.look(trace), DataError);
  std::ofstream(stage.path(TraceName{1}), std::ios::binary)
      << head_line(1) << to_line(TraceEnd{3, ""}) << "\n";
  follower.look(trace);
  CHECK(trace->end);
}

}  // namespace
}  // namespace meshfarm
