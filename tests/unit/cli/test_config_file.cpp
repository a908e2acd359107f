// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <fstream>
#include <string>

#include <boost/program_options.hpp>
#include <doctest/doctest.h>

#include <meshfarm/util/errors.hpp>

#include "cli/config_file.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

class Bench {
 public:
  Bench() {
    options_.add_options()("ratio", po::value(&ratio), "")("parts", po::value(&parts), "")(
        "quiet,q", po::bool_switch(&quiet), "");
  }
  ConfigFile read(const std::string& text) {
    std::ofstream(path(), std::ios::binary) << text;
    return {path(), options_};
  }
  void fill(const std::string& text) {
    po::variables_map values;
    read(text).store(values);
    po::notify(values);
  }
  std::string path() const { return (folder_.path() / "run.conf").string(); }
  /// The usage error's message, without the folder; empty if there is none.
  std::string error_of(const std::string& text) {
    try {
      fill(text);
    } catch (const UsageError& error) {
      return std::string(error.what()).substr(folder_.path().string().size() + 1);
    }
    return {};
  }
  const po::options_description& options() const { return options_; }
  std::string folder() const { return folder_.path().string(); }

  std::string ratio;
  std::uint32_t parts = 0;
  bool quiet = false;

 private:
  test::TempFolder folder_;
  po::options_description options_;
};

}  // namespace

TEST_CASE("a config file says options, a line each, and comments") {
  Bench bench;
  bench.fill("# of a scan\n\nratio = 1%   # a share\n  parts=7\nquiet = true");
  CHECK(bench.ratio == "1%");
  CHECK(bench.parts == 7);
  CHECK(bench.quiet);
  CHECK(bench.error_of("").empty());
}

TEST_CASE("an error of a config file names the file and the line") {
  Bench bench;
  const auto begins = [&](const std::string& text, const std::string& place) {
    const std::string error = bench.error_of(text);
    CAPTURE(error);
    CHECK(error.starts_with("run.conf: line " + place));
  };
  begins("ratio = 1\nrato = 1\n", "2: unrecognised option 'rato'");
  begins("ratio 0.5\n", "1: no NAME = VALUE: 'ratio 0.5'");
  begins("\n[simplify]\nratio = 1\n", "2: there are no sections");
  begins("ratio = 1\n\nparts = many\n", "3: ");
  begins("quiet = perhaps\n", "1: ");
  begins("parts = 1\nparts = 2\n", "1: ");
}

TEST_CASE("an error that names an option of the file is placed, unless it was given") {
  Bench bench;
  const ConfigFile file = bench.read("\nratio = 2\n");
  const std::string place = bench.path() + ": line 2: ";
  CHECK(file.placed("--ratio takes a share", {}) == place + "--ratio takes a share");
  CHECK(file.placed("one of --parts and --ratio", {}) == place + "one of --parts and --ratio");
  CHECK(file.placed("--ratio takes a share", {"ratio"}) == "--ratio takes a share");
  CHECK(file.placed("--ratios", {}) == "--ratios");
  CHECK(file.placed("no mesh -- none", {}) == "no mesh -- none");
  CHECK(ConfigFile().placed("--ratio", {}) == "--ratio");
}

TEST_CASE("a folder is no config file, nor is what is not there") {
  Bench bench;
  CHECK_THROWS_AS(ConfigFile(bench.folder(), bench.options()), IoError);
  CHECK_THROWS_AS(ConfigFile(bench.folder() + "/none.conf", bench.options()), IoError);
}
