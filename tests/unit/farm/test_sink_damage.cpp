// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Results that the sink accepts after a mere look, and what it does when they prove to be damaged.
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "sink_bench.hpp"

namespace meshfarm::test {
namespace {

/// Two jobs of workers, a job that needs both, and one that needs that job.
JobSource chain() {
  return in_stages({{make_job("job 0"), make_job("job 1")}, {make_job("then")}, {make_job("end")}});
}

TEST_CASE("the run is not over before all is verified") {
  SinkBench bench(2, journal_of({"job 0", "job 1"}));
  const SinkActions looked = bench.look_at_all(bench.join(1));
  const auto reads = only<Check>(looked);
  REQUIRE(reads.size() == 2);
  CHECK(reads[0].what == Check::What::accepted);
  CHECK(said<Ready>(looked).at(0).accepted == 2);
  CHECK(said<Ready>(looked).at(0).unverified == 2);
  CHECK(only<MakeOutput>(looked).empty());
  CHECK(said<Ready>(bench.silence(FarmTime(1000))).at(0).unverified == 2);
  CHECK(bench.core.checked(reads[1], {}, bench.now).empty());
  const SinkActions all = bench.core.checked(reads[0], {}, bench.now);
  CHECK(said<Ready>(all).at(0).unverified == 0);
  CHECK(only<MakeOutput>(all).size() == 1);
}

TEST_CASE("a job of the sink waits until all is verified") {
  SinkBench bench(then_own(), journal_of({"job 0"}));
  const SinkActions looked = bench.look_at_all(bench.join(1));
  CHECK(only<DoHere>(looked).empty());
  CHECK(only<DoHere>(bench.verify(looked)).size() == 1);
}

TEST_CASE("what is damaged is taken back, as by a new sink that has the others") {
  SinkBench bench(chain(), journal_of({"job 0", "job 1", "then"}));
  SinkActions looked = bench.look_at_all(bench.join(1));
  for (SinkAction& each : bench.look_at_all(looked)) looked.push_back(std::move(each));
  const auto reads = only<Check>(looked);
  CHECK(bench.core.graph().jobs_accepted() == 3);
  bench.accept(key("end"));
  for (const Check& each : reads) {
    if (each.what != Check::What::accepted) continue;
    const bool damaged = each.key == key("job 1");
    CHECK(only<MakeOutput>(bench.core.checked(each, {damaged ? "it is damaged" : ""}, bench.now))
              .empty());
  }
  const SinkActions again = bench.core.tick(bench.now);
  CHECK(only<HangUp>(again).size() == 1);
  CHECK(only<Check>(again).empty());  // the other results are known to be whole
  CHECK(only<DoHere>(again).empty());
  const SinkActions told = bench.join(1);
  CHECK(said<Accept>(told).size() == 1);
  CHECK(said<Accept>(told).at(0).key == key("job 0"));
  CHECK(said<Ready>(told).at(0).accepted == 1);
  CHECK(said<Ready>(told).at(0).unverified == 0);
  // The damaged result is made again. Results made from it are kept, from the journal or not.
  const auto checks = only<Check>(bench.result(key("job 1"), 1, 2));
  REQUIRE(checks.size() == 1);
  const SinkActions rest = bench.core.checked(checks[0], {}, bench.now);
  CHECK(said<Accept>(rest).size() == 3);
  CHECK(said<Accept>(rest).at(0).output.file.name == checks[0].output.file.name);
  CHECK(only<MakeOutput>(rest).size() == 1);
}

TEST_CASE("a result that comes while what it needs is taken back is not lost") {
  SinkBench bench(chain(), journal_of({"job 0", "job 1"}));
  const auto reads = only<Check>(bench.look_at_all(bench.join(1)));
  REQUIRE(reads.size() == 2);
  const auto checks = only<Check>(bench.result(key("then")));
  REQUIRE(checks.size() == 1);
  bench.core.checked(reads[0], {"it is damaged"}, bench.now);
  bench.core.checked(reads[1], {}, bench.now);
  bench.core.tick(bench.now);
  bench.join(1);
  CHECK(bench.result(key("then")).empty());  // not wanted yet
  CHECK(said<Accept>(bench.core.checked(checks[0], {}, bench.now)).empty());
  CHECK(said<Accept>(bench.accept(reads[0].key)).size() == 2);
  CHECK(bench.core.graph().accepted(key("then")) != nullptr);
}

JobOutput large(JobOutput output) {
  output.file.size = std::uint64_t{1} << 20;
  return output;
}

/// Its file exists and has the right size. Returns what is to be read next.
Check accept_large(SinkBench& bench, JobKey of) {
  const auto looks = only<Check>(
      bench.core.on_result(Result{7, 1, {3}, 5, 1, of, large(result_of(of)), {1, 2, 3, 4}}));
  REQUIRE(looks.size() == 1);
  CHECK(looks[0].what == Check::What::large);
  const SinkActions told = bench.core.checked(looks[0], {}, bench.now);
  REQUIRE(said<Accept>(told).size() == 1);
  CHECK(said<Accept>(told)[0].worker == WorkerId{3});
  CHECK(said<Accept>(told)[0].times.compute_ms == 3);
  CHECK(said<Accept>(told)[0].unverified > 0);
  CHECK(only<MakeOutput>(told).empty());
  const auto reads = only<Check>(told);
  REQUIRE(reads.size() == 1);
  CHECK(reads[0].what == Check::What::accepted);
  return reads[0];
}

TEST_CASE("a large result is told after a look, and the run is over once it is verified") {
  SinkBench bench(1);
  bench.join(1);
  const Check read = accept_large(bench, key("job 0"));
  CHECK(bench.core.unverified() == 1);
  CHECK(only<MakeOutput>(bench.core.checked(read, {}, bench.now)).size() == 1);
}

TEST_CASE("a large result that is not there is rejected") {
  SinkBench bench(1);
  bench.join(1);
  const auto looks = only<Check>(bench.core.on_result(
      Result{7, 1, {3}, 5, 1, key("job 0"), large(result_of(key("job 0"))), {}}));
  const SinkActions told = bench.core.checked(looks.at(0), {"cut short"}, bench.now);
  CHECK(said<Reject>(told).size() == 1);
  CHECK(bench.core.unverified() == 0);
}

TEST_CASE("a large result that is damaged is taken back, and what comes then is verified first") {
  SinkBench bench(chain());
  bench.join(1);
  bench.accept(key("job 0"));
  const Check read = accept_large(bench, key("job 1"));
  CHECK(said<Accept>(bench.accept(key("then"))).size() == 1);
  bench.core.checked(read, {"it is damaged"}, bench.now);
  CHECK(only<HangUp>(bench.core.tick(bench.now)).size() == 1);
  CHECK(said<Ready>(bench.join(1)).at(0).accepted == 1);
  const auto checks = only<Check>(bench.core.on_result(
      Result{7, 1, {3}, 5, 2, key("job 1"), large(result_of(key("job 1"), 2)), {}}));
  REQUIRE(checks.size() == 1);
  CHECK(checks[0].what == Check::What::result);
  CHECK(said<Accept>(bench.core.checked(checks[0], {}, bench.now)).size() == 2);
  CHECK(bench.core.unverified() == 0);
}

TEST_CASE("a worker that reads a damaged result first costs its host nothing") {
  SinkBench bench(chain(), journal_of({"job 0", "job 1"}));
  const auto reads = only<Check>(bench.look_at_all(bench.join(1)));
  REQUIRE(reads.size() == 2);
  const JobFailure failure{"damaged", FailureKind::damaged_input};
  const Message failed = Result{7, 1, {3}, 5, 1, key("then"), failure, {}};
  CHECK(bench.core.on_result(failed).empty());  // the worker repeats it
  bool damaged = false;
  SUBCASE("its host reads what is whole") {}
  SUBCASE("it is damaged") {
    damaged = true;
  }
  bench.core.checked(reads[0], {damaged ? "damaged" : ""}, bench.now);
  bench.core.checked(reads[1], {}, bench.now);
  bench.core.tick(bench.now);
  if (damaged) {
    bench.join(1);
    CHECK(bench.core.on_result(failed).empty());  // not wanted at the moment
    bench.accept(reads[0].key);
  }
  const auto told = said<Reject>(bench.core.on_result(failed));
  REQUIRE(told.size() == 1);
  CHECK(told[0].failure.kind == (damaged ? FailureKind::unread : FailureKind::damaged_input));
}

TEST_CASE("an input that is no result may be damaged: nobody waits to say so") {
  SinkBench bench(chain(), journal_of({"job 0"}));
  bench.look_at_all(bench.join(1));
  const JobFailure failure{"damaged", FailureKind::damaged_input};
  const Message failed = Result{7, 1, {3}, 5, 1, key("job 1"), failure, {}};
  CHECK(said<Reject>(bench.core.on_result(failed)).size() == 1);
}

// --- results that are checked by their readers

/// The first jobs' results are read by workers only.
JobSource chain_of_sections() {
  std::vector<Job> first = {make_job("job 0"), make_job("job 1")};
  for (Job& each : first) each.left_to_readers = true;
  return in_stages({first, {make_job("then")}, {make_job("end")}});
}

/// Its file exists and has the right size: nothing is read.
void leave_large(SinkBench& bench, JobKey of) {
  const auto looks = only<Check>(
      bench.core.on_result(Result{7, 1, {3}, 5, 1, of, large(result_of(of)), {1, 2, 3, 4}}));
  REQUIRE(looks.size() == 1);
  CHECK(looks[0].what == Check::What::large);
  const SinkActions told = bench.core.checked(looks[0], {}, bench.now);
  REQUIRE(said<Accept>(told).size() == 1);
  CHECK(said<Accept>(told)[0].unverified == 0);
  CHECK(only<Check>(told).empty());
  CHECK(bench.core.leaves_to_readers(of));
}

TEST_CASE("what is left to its readers is not read by the sink, of a journal neither") {
  SinkBench bench(chain_of_sections(), journal_of({"job 0"}));
  const SinkActions looked = bench.look_at_all(bench.join(1));
  CHECK(only<Check>(looked).empty());
  CHECK(said<Ready>(looked).at(0).unverified == 0);
  leave_large(bench, key("job 1"));
  bench.accept(key("then"));
  CHECK(only<MakeOutput>(bench.accept(key("end"))).size() == 1);
}

TEST_CASE("what was left to its readers is read once one of them finds damage") {
  SinkBench bench(chain_of_sections());
  bench.join(1);
  leave_large(bench, key("job 0"));
  leave_large(bench, key("job 1"));
  const JobFailure failure{"damaged", FailureKind::damaged_input};
  const Message failed = Result{7, 1, {3}, 5, 1, key("then"), failure, {}};
  const SinkActions asked = bench.core.on_result(failed);
  CHECK(said<Reject>(asked).empty());  // nobody is blamed yet
  const auto reads = only<Check>(asked);
  REQUIRE(reads.size() == 2);
  CHECK(reads[0].what == Check::What::accepted);
  CHECK(bench.core.unverified() == 2);
  SUBCASE("that is there") {
    bench.core.checked(reads[0], {"damaged"}, bench.now);
    bench.core.checked(reads[1], {}, bench.now);
    CHECK(only<HangUp>(bench.core.tick(bench.now)).size() == 1);
    CHECK(said<Ready>(bench.join(1)).at(0).accepted == 1);
    // From now on everything is verified first.
    const auto checks = only<Check>(bench.core.on_result(
        Result{7, 1, {3}, 5, 2, reads[0].key, large(result_of(reads[0].key, 2)), {}}));
    REQUIRE(checks.size() == 1);
    CHECK(checks[0].what == Check::What::result);
    bench.core.checked(checks[0], {}, bench.now);
    const auto told = said<Reject>(bench.core.on_result(failed));
    REQUIRE(told.size() == 1);
    CHECK(told[0].failure.kind == FailureKind::unread);
  }
  SUBCASE("that its host alone sees") {
    bench.verify(asked);
    const auto told = said<Reject>(bench.core.on_result(failed));
    REQUIRE(told.size() == 1);
    CHECK(told[0].failure.kind == FailureKind::damaged_input);
    CHECK(only<Check>(bench.core.on_result(failed)).empty());
  }
}

TEST_CASE("what was left to its readers is read once anything is found damaged") {
  Job of_readers = make_job("job 0");
  of_readers.left_to_readers = true;
  SinkBench bench(in_stages({{of_readers, make_job("job 1")}, {make_job("then")}}));
  bench.join(1);
  leave_large(bench, key("job 0"));
  const Check read = accept_large(bench, key("job 1"));
  const auto reads = only<Check>(bench.core.checked(read, {"it is damaged"}, bench.now));
  REQUIRE(reads.size() == 1);
  CHECK(reads[0].key == key("job 0"));
  CHECK_FALSE(bench.core.leaves_to_readers(key("job 0")));
}

}  // namespace
}  // namespace meshfarm::test
