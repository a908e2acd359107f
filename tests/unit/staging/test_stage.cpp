// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include <doctest/doctest.h>

#include <meshfarm/staging/stage.hpp>
#include <meshfarm/staging/staged_writer.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

const ReadPatience k_no_patience = {.attempts = 1, .first_wait_ms = 0};

}  // namespace

TEST_CASE("a published file is read back by its reference") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path() / "stage");
  const FileRef file = stage.publish(PartName{3}, "content", "abc");
  CHECK(file.name == "parts/000003.part");
  CHECK(file.size == 7);
  CHECK(stage.read(file) == "content");
  CHECK(stage.read(PartName{3}) == "content");
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(stage.root() / "parts")) {
    CHECK(entry.path().filename() == "000003.part");  // no temporary file is left
    ++files;
  }
  CHECK(files == 1);
}

TEST_CASE("a folder without a manifest is no stage") {
  const test::TempFolder folder;
  CHECK_THROWS_AS(Stage::open(folder.path()), DataError);
  CHECK_THROWS_AS(Stage::open(folder.path() / "absent"), DataError);
  const Stage stage = Stage::create(folder.path());
  stage.publish(ManifestName{}, "m");
  CHECK_NOTHROW(Stage::open(folder.path()));
}

TEST_CASE("one flipped byte or a missing one is noticed by the reader") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  const FileRef file = stage.publish(PartName{0}, "content");
  const auto path = stage.path(PartName{0});
  std::ofstream(path) << "contenT";
  CHECK_THROWS_WITH_AS(stage.read(file, k_no_patience),
                       (path.string() + ": damaged (its checksum is not the promised one)").c_str(),
                       DataError);
  std::ofstream(path) << "conten";
  CHECK_THROWS_WITH_AS(stage.read(file, k_no_patience),
                       (path.string() + ": 6 bytes where 7 were promised").c_str(), DataError);
}

TEST_CASE("a section of a file is read by its own checksum, and as patiently") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  const FileRef file = stage.publish(PartName{0}, "head content tail");
  const FileSection content{5, 7, checksum("content")};
  CHECK(stage.read(file, content) == "content");
  CHECK(stage.read(file, {17, 0, checksum("")}).empty());
  const auto path = stage.path(PartName{0});
  for (const FileSection beyond : {FileSection{5, 13, 0}, FileSection{18, 0, 0},
                                   FileSection{UINT64_MAX, 2, 0}, FileSection{2, UINT64_MAX, 0}}) {
    CHECK_THROWS_AS(stage.read(file, beyond, k_no_patience), UnreadDataError);
  }
  std::ofstream(path) << "HEAD content tail";  // bytes outside the section are not checked
  CHECK(stage.read(file, content, k_no_patience) == "content");
  std::ofstream(path) << "head contenT tail";
  CHECK_THROWS_AS(stage.read(file, content, k_no_patience), UnreadDataError);
  int looks = 0;
  ReadPatience patience{.attempts = 10, .first_wait_ms = 1};
  patience.moved = [&](std::uint64_t) {
    if (++looks == 4) std::ofstream(path) << "head content tail";
  };
  CHECK(stage.read(file, content, patience) == "content");
  CHECK(looks > 4);
}

TEST_CASE("a file that comes late is waited for") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  FileRef file = stage.publish(PartName{1}, "late");
  std::filesystem::rename(stage.path(PartName{1}), folder.path() / "hidden");
  std::jthread writer([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    std::filesystem::rename(folder.path() / "hidden", stage.path(PartName{1}));
  });
  CHECK(stage.read(file, {.attempts = 10, .first_wait_ms = 10}) == "late");
}

TEST_CASE("only staged names are opened, and only beneath the stage") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path() / "stage");
  std::ofstream(folder.path() / "secret") << "secret";
  CHECK_THROWS_AS(stage.read(FileRef{"../secret", 6, 0}, k_no_patience), DataError);
  CHECK_THROWS_AS(stage.read(FileRef{"/etc/passwd", 6, 0}, k_no_patience), DataError);
  std::filesystem::create_symlink(folder.path() / "secret", stage.path(PartName{7}));
  CHECK_THROWS_AS(stage.read(PartName{7}), IoError);
}

TEST_CASE("numbers of journals and epochs are listed in order; strangers are passed over") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  for (const std::uint32_t n : {12U, 2U, 1'000'001U}) stage.publish(JournalName{n}, "x");
  stage.publish(EndpointName{4}, "x");
  std::ofstream(stage.root() / "journal" / "notes.txt") << "x";
  CHECK(stage.journals() == std::vector<std::uint32_t>{2, 12, 1'000'001});
  CHECK(stage.epochs() == std::vector<std::uint32_t>{4});
}

TEST_CASE("removing a stage leaves what is not its own") {
  const test::TempFolder folder;
  const auto root = folder.path() / "stage";
  const Stage stage = Stage::create(root);
  stage.publish(PartName{1}, "x");
  stage.publish(ManifestName{}, "x");
  stage.publish(ChannelsName{}, "x");
  std::ofstream(root / ".manifest.0.tmp") << "x";
  std::ofstream(root / "mine.ply") << "x";
  std::ofstream(root / ".mine.ply.0.tmp") << "x";
  remove_stage(root);
  CHECK_FALSE(std::filesystem::exists(root / "parts"));
  CHECK_FALSE(std::filesystem::exists(root / ".manifest.0.tmp"));
  for (const char* const mine : {"mine.ply", ".mine.ply.0.tmp"}) {
    CHECK(std::filesystem::exists(root / mine));
    std::filesystem::remove(root / mine);
  }
  remove_stage(root);
  CHECK_FALSE(std::filesystem::exists(root));
}

TEST_CASE("a file written in pieces is there only when it is whole") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  const std::string piece(700'000, 'x');
  FileRef file;
  {
    StagedWriter writer(stage, PartName{3}, "abc");
    for (int i = 0; i < 3; ++i) writer.write(piece);
    CHECK_FALSE(std::filesystem::exists(stage.path(PartName{3})));
    file = writer.commit();
  }
  CHECK(file == stage.publish(PartName{3}, piece + piece + piece, "def"));
  CHECK_NOTHROW(stage.verify(file));
  { StagedWriter(stage, PartName{4}).write(piece + piece); }
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path() / "parts"), {}) == 1);
}

TEST_CASE("who only verifies a file notices the same damage") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  const FileRef file = stage.publish(PartName{0}, std::string(3'000'000, 'x'));
  CHECK_NOTHROW(stage.verify(file, k_no_patience));
  std::fstream(stage.path(PartName{0}), std::ios::in | std::ios::out).seekp(2'500'000).put('y');
  CHECK_THROWS_WITH_AS(
      stage.verify(file, k_no_patience),
      (stage.path(PartName{0}).string() + ": damaged (its checksum is not the promised one)")
          .c_str(),
      DataError);
  std::filesystem::resize_file(stage.path(PartName{0}), 2'000'000);
  CHECK_THROWS_AS(stage.verify(file, k_no_patience), DataError);
}

TEST_CASE("a file that is missing is waited for by the clock, and every look is a sign of life") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  const FileRef file = stage.publish(PartName{1}, "content");
  const auto hidden = folder / "hidden";
  std::filesystem::rename(stage.path(PartName{1}), hidden);
  ReadPatience patience{.first_wait_ms = 10, .missing = std::chrono::seconds(20)};
  int looks = 0;
  std::uint64_t bytes = 0;
  patience.moved = [&](std::uint64_t more) {
    bytes += more;
    // It appears later than five attempts would last, as after a negative lookup cached by NFS.
    if (++looks == 8) std::filesystem::rename(hidden, stage.path(PartName{1}));
  };
  CHECK(stage.read(file, patience) == "content");
  CHECK(looks >= 8);
  CHECK(bytes == 7);

  std::filesystem::remove(stage.path(PartName{1}));
  patience.missing = std::chrono::milliseconds(300);
  const auto begin = std::chrono::steady_clock::now();
  CHECK_THROWS_AS(stage.read(file, patience), IoError);
  const auto took = std::chrono::steady_clock::now() - begin;
  CHECK(took >= std::chrono::milliseconds(300));
  CHECK(took < std::chrono::seconds(10));
}
