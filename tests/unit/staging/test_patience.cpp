// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cerrno>
#include <chrono>
#include <filesystem>

#include <doctest/doctest.h>

#include <meshfarm/staging/patience.hpp>
#include <meshfarm/staging/stage.hpp>

#include "support/temp_folder.hpp"

namespace meshfarm {
namespace {

using std::chrono::milliseconds;

/// Fails with `error` `times` times, then succeeds; counts its calls.
struct Failing {
  int error = 0;
  int times = 0;
  int calls = 0;
  int operator()() {
    if (++calls <= times) throw IoError("cannot read", "file", error);
    return 7;
  }
};

TEST_CASE("storage that fails for a while is outlasted") {
  for (const int error : {EIO, ESTALE, ETIMEDOUT}) {
    CAPTURE(error);
    Failing work{error, 3};
    CHECK(outlast({.first_wait_ms = 1}, [&] { return work(); }) == 7);
    CHECK(work.calls == 4);
  }
}

TEST_CASE("what is no failure of the storage is not waited for") {
  for (const int error : {EACCES, ENOSPC, ENOENT}) {
    CAPTURE(error);
    Failing work{error, 3};
    CHECK_THROWS_AS(outlast(patience_with_storage(), [&] { return work(); }), IoError);
    CHECK(work.calls == 1);
  }
  Failing now_or_never{EIO, 3};
  CHECK_THROWS_AS(outlast({.attempts = 1}, [&] { return now_or_never(); }), IoError);
  CHECK(now_or_never.calls == 1);
}

TEST_CASE("what is missing and what fails have patience of their own") {
  const ReadPatience patience = {
      .first_wait_ms = 1, .missing = milliseconds(0), .failing = milliseconds(5000)};
  Failing fails{ESTALE, 3};
  CHECK(outlast(patience, [&] { return fails(); }) == 7);
  Failing missing{ENOENT, 3};
  CHECK_THROWS_AS(outlast(patience, [&] { return missing(); }), IoError);
}

TEST_CASE("what was waited for in vain is not waited for again") {
  ReadPatience patience = {
      .first_wait_ms = 1, .missing = milliseconds(5000), .failing = milliseconds(1000)};
  Failing fails{EIO, 1'000'000};
  try {
    outlast(patience, [&] { return fails(); });
    FAIL("it fails for ever");
  } catch (const IoError& error) {
    spend(patience, error);
  }
  CHECK(fails.calls > 3);
  fails.calls = 0;
  CHECK_THROWS_AS(outlast(patience, [&] { return fails(); }), IoError);
  CHECK(fails.calls == 1);
  Failing missing{ENOENT, 3};
  CHECK(outlast(patience, [&] { return missing(); }) == 7);
  spend(patience, IoError("cannot open", "file", ENOENT));
  missing.calls = 0;
  CHECK_THROWS_AS(outlast(patience, [&] { return missing(); }), IoError);
  CHECK(missing.calls == 1);
}

TEST_CASE("who waits is told of it, and may end it") {
  struct Enough {};
  int told = 0;
  const ReadPatience patience = {.first_wait_ms = 1, .moved = [&](std::uint64_t) {
                                   if (++told == 3) throw Enough{};
                                 }};
  Failing fails{EIO, 1'000'000};
  CHECK_THROWS_AS(outlast(patience, [&] { return fails(); }), Enough);
  CHECK(fails.calls == 3);
}

TEST_CASE("a stage that cannot be looked at is not called missing") {
  const test::TempFolder folder;
  std::filesystem::create_symlink("loop", folder / "loop");
  CHECK_THROWS_AS(Stage::open(folder / "loop"), IoError);
  CHECK_THROWS_AS(Stage::open(folder / "nothing"), DataError);
  CHECK_THROWS_AS(Stage::open(folder.path()), DataError);
}

}  // namespace
}  // namespace meshfarm
