// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <fstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/staging/file_ref.hpp>
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

struct Written {
  FileRef file;
  std::vector<FileSection> sections;
};

Written write(const Stage& stage, const std::vector<std::string>& sections) {
  std::string bytes;
  Written written;
  SectionWriter writer([&](std::string_view more) { bytes += more; });
  for (const std::string& each : sections) written.sections.push_back(writer.add(each));
  written.file = stage.publish(ResultName{1, 1, 1}, bytes);
  return written;
}

}  // namespace

TEST_CASE("sections of a file are read on their own, in any order") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  const Written written = write(stage, {"first", "", "third one"});
  const SectionedFile file(stage, written.file);
  CHECK(file.read(written.sections[2]) == "third one");
  CHECK(file.read(written.sections[0]) == "first");
  CHECK(file.read(written.sections[1]).empty());
  CHECK(written.sections[2].offset == 5);
}

TEST_CASE("a section that is damaged or beyond the end is refused, the others are not") {
  const test::TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  const Written written = write(stage, {"first", "second"});
  const auto path = stage.root() / written.file.name;
  std::ofstream(path) << "firstseXond";
  const SectionedFile file(stage, written.file);
  CHECK(file.read(written.sections[0]) == "first");
  CHECK_THROWS_WITH_AS(file.read(written.sections[1]),
                       (path.string() + ": damaged, or cut short, at byte 5").c_str(),
                       UnreadDataError);
  for (const FileSection& beyond :
       {FileSection{12, 0, 0}, FileSection{5, 7, 0}, FileSection{~std::uint64_t{0}, 2, 0},
        FileSection{2, ~std::uint64_t{0}, 0}}) {
    CHECK_THROWS_AS(file.read(beyond), UnreadDataError);
  }
  std::ofstream(path) << "firs";
  CHECK_THROWS_AS(SectionedFile(stage, written.file), DataError);
}

TEST_CASE("a reference to a file is the same after it was written and read") {
  ByteWriter out;
  const FileRef file{"parts/000001.part", 12, 0xfeed};
  put_file(out, file);
  ByteReader in(out.bytes(), "bytes");
  CHECK(get_file(in) == file);
  in.expect_end();
}
