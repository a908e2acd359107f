// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <unistd.h>

#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/temp_folder.hpp"

using namespace meshfarm;

TEST_CASE("nothing is to be seen before commit, and nothing is left without it") {
  const test::TempFolder folder;
  const auto path = folder.path() / "file";
  {
    AtomicFile file(path);
    file.write("abandoned");
    CHECK_FALSE(std::filesystem::exists(path));
  }
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("commit publishes all that was written") {
  const test::TempFolder folder;
  const auto path = folder.path() / "file";
  AtomicFile file(path, "writer1");
  file.write("head");
  const std::string large(3'000'000, 'x');
  file.write(large);
  file.write("tail");
  CHECK(file.size() == 8 + large.size());
  file.commit();
  CHECK(read_file(path) == "head" + large + "tail");
}

TEST_CASE("what is synced is in the temporary file, and not published") {
  const test::TempFolder folder;
  AtomicFile file(folder / "file");
  file.write("all of it");
  file.sync();
  CHECK_FALSE(std::filesystem::exists(folder / "file"));
  CHECK(read_file(std::filesystem::directory_iterator(folder.path())->path()) == "all of it");
  file.write(", and more");
  file.commit();
  CHECK(read_file(folder / "file") == "all of it, and more");
}

TEST_CASE("what was written can be replaced, whether it is buffered or not") {
  const test::TempFolder folder;
  const auto path = folder.path() / "file";
  AtomicFile file(path);
  const std::string large(3'000'000, 'x');
  file.write("head" + large);
  file.write("tail");
  file.overwrite(1, "EA");
  file.overwrite(4 + large.size(), "T");
  file.write("!");
  CHECK(file.size() == 9 + large.size());
  file.commit();
  CHECK(read_file(path) == "hEAd" + large + "Tail!");
}

TEST_CASE("processes of equal numbers in two containers write under names of their own") {
  const test::TempFolder folder;
  const AtomicFile file(folder / "file");
  const auto name = std::filesystem::directory_iterator(folder.path())->path().filename().string();
  const auto dash = name.find(std::to_string(::getpid()) + "-");
  REQUIRE(dash != std::string::npos);
  // The process id is followed by a random number: sixteen hexadecimal digits.
  const auto drawn = name.substr(name.find('-', dash) + 1, 16);
  CHECK(drawn.size() == 16);
  CHECK(drawn.find_first_not_of("0123456789abcdef") == std::string::npos);
}

TEST_CASE("a temporary file left by a dead writer of our name is no obstacle") {
  const test::TempFolder folder;
  const auto path = folder.path() / "file";
  {
    AtomicFile dead(path, "same");
    dead.write("dead");
    AtomicFile living(path, "same");
    living.write("living");
    living.commit();
  }
  CHECK(read_file(path) == "living");
}

TEST_CASE("a rename that answers ENOENT though it was done is no failure") {
  const test::TempFolder folder;
  AtomicFile file(folder.path() / "to");
  file.write("done");
  file.commit();
  CHECK_NOTHROW(rename_checked(folder.path() / "gone", folder.path() / "to", 4));
  CHECK_THROWS_AS(rename_checked(folder.path() / "gone", folder.path() / "to", 5), IoError);
  CHECK_THROWS_AS(rename_checked(folder.path() / "gone", folder.path() / "absent", 4), IoError);
}

TEST_CASE("a folder that is not there is an error that names the file") {
  const test::TempFolder folder;
  CHECK_THROWS_AS(AtomicFile(folder.path() / "absent" / "file"), IoError);
}

TEST_CASE("what killed writers left of a file is removed, and nothing else") {
  const test::TempFolder folder;
  const auto put = [&](const std::string& name) { std::ofstream(folder.path() / name) << 'x'; };
  const std::vector<std::string> left = {".a.ply.17-0123456789abcdef.tmp",
                                         ".a.ply.4294967-ffffffffffffffff.tmp"};
  const std::vector<std::string> others = {"a.ply",
                                           ".a.ply.tmp",
                                           ".a.ply.17.tmp",
                                           ".a.ply.-0123456789abcdef.tmp",
                                           ".a.ply.17-0123456789abcde.tmp",
                                           ".a.ply.17-0123456789abcdeg.tmp",
                                           ".a.ply.17-0123456789abcdef.part",
                                           ".b.ply.17-0123456789abcdef.tmp",
                                           ".a.ply.b.17-0123456789abcdef.tmp"};
  for (const std::string& name : left) put(name);
  for (const std::string& name : others) put(name);
  AtomicFile unfinished(folder.path() / "a.ply");
  remove_unfinished(folder.path() / "a.ply");
  for (const std::string& name : left) CHECK_FALSE(std::filesystem::exists(folder.path() / name));
  for (const std::string& name : others) CHECK(std::filesystem::exists(folder.path() / name));
  const auto entries = std::filesystem::directory_iterator(folder.path());
  CHECK(static_cast<std::size_t>(std::distance(begin(entries), end(entries))) == others.size());
  CHECK_NOTHROW(remove_unfinished(folder.path() / "absent" / "a.ply"));
}

TEST_CASE("the first of two has the name, the second is told so") {
  const test::TempFolder folder;
  const auto path = folder.path() / "file";
  AtomicFile first(path, "1", AtomicFile::Readers::owner);
  first.write("first");
  AtomicFile second(path, "2", AtomicFile::Readers::owner);
  second.write("second");
  CHECK(first.commit_new());
  CHECK_FALSE(second.commit_new());
  CHECK(read_file(path) == "first");
  CHECK(std::filesystem::hard_link_count(path) == 1);
  const auto entries = std::filesystem::directory_iterator(folder.path());
  CHECK(std::distance(begin(entries), end(entries)) == 1);
}

TEST_CASE("what only its owner may read is so from the start") {
  const test::TempFolder folder;
  const auto path = folder.path() / "file";
  AtomicFile file(path, "1", AtomicFile::Readers::owner);
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    CHECK(entry.status().permissions() ==
          (std::filesystem::perms::owner_read | std::filesystem::perms::owner_write));
  }
  file.commit();
  CHECK(std::filesystem::status(path).permissions() ==
        (std::filesystem::perms::owner_read | std::filesystem::perms::owner_write));
}
