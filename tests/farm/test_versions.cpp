// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A stage that contains results of another version of the algorithm.
#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/farm/ledger.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/algorithm.hpp>
#include <meshfarm/pipeline/job_table.hpp>
#include <meshfarm/pipeline/run_graph.hpp>

#include "support/farm_bench.hpp"
#include "support/next_jobs.hpp"

namespace meshfarm::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* k_ratio = "0.05";

class Bench : public FarmBench {
 public:
  Bench() : FarmBench("20000"), cut_(cut({"--parts", "4"})) {
    const std::string stage = copied_stage("quiet");
    expect(replay(stage), stage + ".ply");
  }

  std::string copied_stage(const std::string& name) {
    fs::copy(cut_, path(name), fs::copy_options::recursive);
    return path(name);
  }
  Ran replay(const std::string& stage) {
    return meshfarm({"replay", stage, "--ratio", k_ratio, "-o", stage + ".ply", "-q"});
  }

 private:
  std::string cut_;
};

/// Journals results of all parts as that version would, but each is another part's result: whoever
/// uses one does not make the expected mesh.
void work_with_version(const std::string& folder, std::uint32_t version) {
  const Stage stage = Stage::open(folder);
  const Manifest manifest = decode_manifest(stage.read(ManifestName{}), folder);
  RunOptions run;
  run.ratio = std::stod(k_ratio);
  const std::vector<Job> jobs = test::next_jobs(make_job_source(manifest, run), {});
  REQUIRE(jobs.size() == 4);
  const JobContext context{stage, 1, 7, [](std::uint64_t) { return true; }};
  std::vector<std::string> records;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    JobOutput output = do_job(jobs[(i + 1) % jobs.size()], context);
    Job job = jobs[i];
    job.algorithm = version;
    const JobKey key = key_of(job);
    output.file = stage.publish(ResultName{key.value, 1, 9}, stage.read(output.file));
    records.push_back(encode_record({run_key(manifest, run), {key, output}}));
  }
  open_journal(stage).append_all(records);
}

TEST_CASE("results of another version of the algorithm are made again") {
  Bench bench;
  for (const std::uint32_t version : {k_algorithm_version - 1, k_algorithm_version + 1}) {
    CAPTURE(version);
    const std::string stage = bench.copied_stage("stage of " + std::to_string(version));
    work_with_version(stage, version);
    CHECK(bench.replay(stage).code == 0);
    bench.check_result(stage + ".ply");
  }
  // Results of this version are used, and do not fit each other.
  const std::string stage = bench.copied_stage("stage of this version");
  work_with_version(stage, k_algorithm_version);
  const bool made_again =
      bench.replay(stage).code == 0 && read_text(stage + ".ply") == bench.expected();
  CHECK_FALSE(made_again);
}

TEST_CASE("a journal record of another format is set aside with a word, and its sink goes on") {
  Bench bench;
  const std::string stage = bench.copied_stage("stage");
  open_journal(Stage::open(stage)).append("a record of a version to come");
  const Ran ran = bench.replay(stage);
  CHECK(ran.code == 0);
  CHECK(ran.err.find("set aside: ") != std::string::npos);
  CHECK(ran.err.find("a record of an unknown version") != std::string::npos);
  bench.check_result(stage + ".ply");
}

}  // namespace
}  // namespace meshfarm::test
