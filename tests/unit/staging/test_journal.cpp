// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <csignal>
#include <filesystem>

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <meshfarm/staging/journal.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/temp_folder.hpp"

using namespace meshfarm;

TEST_CASE("records come back in order") {
  const test::TempFolder folder;
  const auto path = folder.path() / "journal";
  {
    JournalWriter writer(path);
    writer.append("one");
    writer.append("");
    writer.append(std::string(1000, 'x'));
  }
  const JournalContent content = parse_journal(read_file(path), "journal");
  CHECK(content.records == std::vector<std::string>{"one", "", std::string(1000, 'x')});
  CHECK(content.torn_bytes == 0);
}

TEST_CASE("a journal has one writer: a name that exists is refused") {
  const test::TempFolder folder;
  const JournalWriter writer(folder.path() / "journal");
  CHECK_THROWS_AS(JournalWriter(folder.path() / "journal"), IoError);
}

TEST_CASE("a journal whose head cannot be written is not left behind") {
  const test::TempFolder folder;
  const auto path = folder.path() / "journal";
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &before) == 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit none{0, before.rlim_max};
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &none) == 0);
  CHECK_THROWS_AS(JournalWriter{path}, IoError);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  CHECK_FALSE(std::filesystem::exists(path));
}

TEST_CASE("cut anywhere, the whole records before the cut are kept and the rest is counted") {
  const test::TempFolder folder;
  const auto path = folder.path() / "journal";
  {
    JournalWriter writer(path);
    writer.append("first record");
    writer.append("second record");
  }
  const std::string bytes = read_file(path);
  const std::size_t first_end = 8 + 12 + 12;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    CAPTURE(size);
    const JournalContent content = parse_journal(std::string_view(bytes).substr(0, size), "j");
    CHECK(content.records.size() == (size < first_end ? 0 : 1));
    const std::size_t whole = size < 8 ? 0 : size < first_end ? 8 : first_end;
    CHECK(content.torn_bytes == size - whole);
  }
}

TEST_CASE("a damaged record ends the journal there") {
  const test::TempFolder folder;
  const auto path = folder.path() / "journal";
  {
    JournalWriter writer(path);
    writer.append("first record");
    writer.append("second record");
  }
  std::string bytes = read_file(path);
  bytes[bytes.size() - 1] ^= 1;
  const JournalContent content = parse_journal(bytes, "j");
  CHECK(content.records == std::vector<std::string>{"first record"});
  CHECK(content.torn_bytes == 12 + 13);
  CHECK_THROWS_AS(parse_journal("no journal at all", "j"), DataError);
}

TEST_CASE("records that are appended together are records apart") {
  const test::TempFolder folder;
  const auto path = folder.path() / "journal";
  const std::vector<std::string> records = {"one", "", "three"};
  {
    JournalWriter writer(path);
    writer.append_all(records);
    writer.append_all({});
    writer.append("four");
  }
  CHECK(parse_journal(read_file(path), "journal").records ==
        std::vector<std::string>{"one", "", "three", "four"});
}
