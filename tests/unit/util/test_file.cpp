// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <atomic>
#include <fstream>
#include <stdexcept>

#include <doctest/doctest.h>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>
#include <meshfarm/util/parallel.hpp>

#include "support/temp_folder.hpp"

using namespace meshfarm;

TEST_CASE("a missing file is an error that names it") {
  const test::TempFolder folder;
  const auto path = folder.path() / "absent";
  CHECK_THROWS_WITH_AS(read_file(path),
                       ("cannot open " + path.string() + ": No such file or directory").c_str(),
                       IoError);
}

TEST_CASE("a file is read as a whole, and at any place of it") {
  const test::TempFolder folder;
  const auto path = folder.path() / "file";
  std::ofstream(path, std::ios::binary) << "twelve bytes";
  CHECK(read_file(path) == "twelve bytes");
  const Fd fd = open_for_read(path);
  std::string buffer(5, '.');
  CHECK(read_at(fd.get(), 7, buffer, path) == 5);
  CHECK(buffer == "bytes");
  CHECK(read_at(fd.get(), 10, buffer, path) == 2);
  CHECK(buffer == "estes");
  CHECK(read_at(fd.get(), 100, buffer, path) == 0);

  std::ofstream(folder.path() / "empty").flush();
  CHECK(read_file(folder.path() / "empty").empty());
  CHECK_THROWS_AS(read_at(-1, 0, buffer, path), IoError);
}

TEST_CASE("a scratch file has no name, is zero, and keeps what is written") {
  const test::TempFolder folder;
  MappedFile scratch = MappedFile::scratch(folder.path(), 4096 * sizeof(std::uint64_t));
  CHECK(std::filesystem::is_empty(folder.path()));
  const auto values = scratch.as_span<std::uint64_t>();
  CHECK(values.size() == 4096);
  CHECK(values[4095] == 0);
  values[4095] = 7;
  const MappedFile moved = std::move(scratch);
  CHECK(moved.as_span<std::uint64_t>()[4095] == 7);
}

TEST_CASE("memory of no file is zero, and keeps what is written") {
  const MappedFile memory = MappedFile::memory(std::uint64_t{1} << 30);  // most is never touched
  const auto values = memory.as_span<std::uint64_t>();
  CHECK(values.size() == std::size_t{1} << 27);
  CHECK(values.back() == 0);
  values.back() = 7;
  CHECK(memory.as_span<std::uint64_t>().back() == 7);
  CHECK(MappedFile::memory(0).bytes().empty());
}

TEST_CASE("parallel_for does each index once") {
  std::vector<std::atomic<int>> counts(1000);
  parallel_for(counts.size(), 4, [&](std::uint64_t i) { ++counts[i]; });
  for (const auto& count : counts) CHECK(count == 1);
  CHECK_NOTHROW(parallel_for(0, 4, [](std::uint64_t) { throw std::logic_error("called"); }));
}

TEST_CASE("parallel_for throws what a call threw") {
  CHECK_THROWS_WITH_AS(parallel_for(100, 3,
                                    [](std::uint64_t i) {
                                      if (i == 50) throw DataError("fifty");
                                    }),
                       "fifty", DataError);
}
