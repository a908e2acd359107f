// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdint>

#include <doctest/doctest.h>

#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/run_graph.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>
#include <meshfarm/pipeline/sweep_job.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/next_jobs.hpp"

using namespace meshfarm;

namespace {

Rung rung(std::int32_t level, std::uint64_t triangles) {
  return {level, triangles / 2, triangles, triangles};
}

Manifest manifest_of(std::uint32_t parts, std::uint64_t triangles_each) {
  Manifest m;
  m.box.add({0, 0, 0});
  m.box.add({1, 1, 1});
  for (std::uint32_t p = 0; p < parts; ++p) {
    m.parts.push_back({{to_string(PartName{p}), 100, p},
                       triangles_each / 2,
                       triangles_each,
                       10,
                       triangles_each,
                       10});
    m.input_triangles += triangles_each;
  }
  return m;
}

AcceptedJob accepted(const Job& job, std::vector<Rung> rungs) {
  return {key_of(job),
          {{to_string(ResultName{key_of(job).value, 1, 1}), 1, key_of(job).value},
           encode_summary({std::move(rungs), 0, 0})}};
}

/// Of a part that its topology held back at its last rung.
AcceptedJob accepted_held(const Job& job, std::vector<Rung> rungs) {
  AcceptedJob done = accepted(job, {});
  done.output.summary = encode_summary({std::move(rungs), 0, 0, true});
  return done;
}

/// What is possible once some jobs are accepted.
auto next_of(const Manifest& manifest, const RunOptions& options) {
  return [source = make_job_source(manifest, options)](std::span<const AcceptedJob> accepted) {
    return test::next_jobs(source, accepted);
  };
}

ChosenRungs chosen_of(const Manifest& manifest, const RunOptions& options,
                      std::span<const AcceptedJob> accepted) {
  return state_of_run(manifest, options, accepted).chosen.value();
}

TopologyMode topology_of(const Job& job) {
  return job.kind == k_sweep_kind ? decode_sweep_parameters(job.parameters).lines.topology
                                  : decode_parameters(job.parameters).lines.topology;
}

}  // namespace

TEST_CASE("the rung at a level is the coarsest that is not above it") {
  const std::vector<Rung> ladder = {rung(3, 100), rung(5, 60), rung(6, 40), rung(9, 10)};
  CHECK(rung_at(ladder, 2) == 0);  // none is: the finest there is
  CHECK(rung_at(ladder, 3) == 0);
  CHECK(rung_at(ladder, 4) == 0);
  CHECK(rung_at(ladder, 5) == 1);
  CHECK(rung_at(ladder, 8) == 2);
  CHECK(rung_at(ladder, 99) == 3);
}

TEST_CASE("the common level is the coarsest that leaves enough") {
  const std::vector<ResultSummary> parts = {{{rung(1, 100), rung(2, 50), rung(3, 20)}},
                                            {{rung(1, 10), rung(3, 2)}}};
  CHECK(common_level(parts, 22) == 3);
  CHECK(common_level(parts, 23) == 2);
  CHECK(common_level(parts, 60) == 2);
  CHECK(common_level(parts, 61) == 1);
  CHECK(common_level(parts, 1000) == 1);
}

TEST_CASE("a ladder that goes on is taken to fall as that of a smooth surface") {
  ResultSummary part{{rung(1, 320), rung(3, 160)}};
  CHECK(free_triangles_at(part, 9) == 160);
  part.end = LadderEnd::enough;
  CHECK(free_triangles_at(part, 0) == 320);
  CHECK(free_triangles_at(part, 2) == 320);
  CHECK(free_triangles_at(part, 3) == 160);
  CHECK(free_triangles_at(part, 4) == 100);
  CHECK(free_triangles_at(part, 6) == 39);
  const std::vector<ResultSummary> parts = {part, {{rung(2, 900), rung(4, 600), rung(5, 500)}}};
  CHECK(common_level(parts, 562) == 5);
  CHECK(common_level(parts, 563) == 4);
}

TEST_CASE("levels and costs fit each other") {
  const double unit = cost_unit(123.4);
  for (const std::int32_t level : {0, 1, 7, 30, 50}) {
    CHECK(level_of(level_cost(level, unit), unit) == level);
    CHECK(level_of(level_cost(level, unit) * 1.001, unit) == level + 1);
  }
  CHECK(level_of(0, unit) == 0);
  CHECK(level_of(0, 0) == 0);
  CHECK(cost_unit(2) == 16 * cost_unit(1));
}

TEST_CASE("every part is asked for once at first, with the same parameters each time") {
  const Manifest manifest = manifest_of(3, 100'000);
  const RunOptions options{.ratio = 0.01};
  const std::vector<Job> jobs = next_of(manifest, options)({});
  REQUIRE(jobs.size() == 3);
  CHECK(jobs[2].inputs == std::vector<FileRef>{manifest.parts[2].file});
  CHECK(jobs[0].cost == 100'000);
  CHECK(key_of(jobs[0]) == key_of(next_of(manifest, options)({})[0]));
  CHECK(key_of(jobs[0]) != key_of(jobs[1]));
  const SimplifyParameters p = decode_parameters(jobs[0].parameters);
  CHECK(p.start_triangles > 2 * 1000);
  CHECK(p.start_triangles < 10 * 1000);
  CHECK(p.share_triangles == 1000);
  // Twice the share is wanted; one level above is 1.6 times as many.
  CHECK(p.end_triangles == 3200);
  const auto end_of = [&](const RunOptions& other) {
    return decode_parameters(next_of(manifest, other)({})[0].parameters).end_triangles;
  };
  CHECK(end_of({.ratio = 0.5}) == 62'500);  // without a first rung by count
  CHECK(end_of({.ratio = 0.01, .finish_place = FinishPlace::farm}) == 1000);
}

TEST_CASE("when the ladders reach the common level the run is complete") {
  const Manifest manifest = manifest_of(2, 100'000);
  const RunOptions options{.ratio = 0.01};
  const auto source = next_of(manifest, options);
  const std::vector<Job> jobs = source({});
  // 2,000 triangles are wanted in the end, so 4,000 before the finish.
  const std::vector<AcceptedJob> done = {
      accepted(jobs[0], {rung(10, 8000), rung(11, 4000), rung(12, 2000)}),
      accepted(jobs[1], {rung(9, 7000), rung(10, 900), rung(12, 100)})};
  CHECK(source(done).empty());
  const std::vector<ChosenRung> chosen = chosen_of(manifest, options, done).rungs;
  CHECK(chosen[0].rung == 1);
  CHECK(chosen[1].rung == 1);
}

TEST_CASE("a part that was taken too far is asked for again with a finer start") {
  const Manifest manifest = manifest_of(2, 100'000);
  const RunOptions options{.ratio = 0.01};
  const auto source = next_of(manifest, options);
  const std::vector<Job> jobs = source({});
  std::vector<AcceptedJob> done = {
      accepted(jobs[0], {rung(20, 3000), rung(21, 2000)}),  // all the detail is here
      accepted(jobs[1], {rung(5, 8000), rung(6, 30)})};
  const std::vector<Job> more = source(done);
  REQUIRE(more.size() == 1);
  CHECK(more[0].inputs == jobs[0].inputs);
  CHECK(decode_parameters(more[0].parameters).start_triangles >
        4 * decode_parameters(jobs[0].parameters).start_triangles);
  CHECK_FALSE(state_of_run(manifest, options, done).chosen);

  done.push_back(accepted(more[0], {rung(6, 40'000), rung(18, 6000), rung(20, 3000)}));
  CHECK(source(done).empty());
  const std::vector<ChosenRung> chosen = chosen_of(manifest, options, done).rungs;
  CHECK(chosen[0].file.name == done[2].output.file.name);
  CHECK(chosen[0].rung == 1);
  CHECK(chosen[1].rung == 1);
}

TEST_CASE("parts keep their topology first, and are stitched so if that is fair") {
  const Manifest manifest = manifest_of(2, 100'000);
  const RunOptions options{.ratio = 0.01};
  const auto source = next_of(manifest, options);
  const std::vector<Job> jobs = source({});
  for (const Job& job : jobs) CHECK(topology_of(job) == TopologyMode::keep_while_fair);
  // 4,000 are wanted before the finish: level 11.
  const AcceptedJob other = accepted(jobs[1], {rung(10, 7000), rung(11, 3800), rung(12, 100)});
  const auto with = [&](AcceptedJob held) { return std::vector{std::move(held), other}; };
  // Held above the level that is chosen: the others pay nothing.
  const auto above = with(accepted_held(jobs[0], {rung(10, 1000), rung(11, 700)}));
  CHECK(source(above).empty());
  CHECK(chosen_of(manifest, options, above).topology == TopologyMode::automatic);
  // Held below it with less than a tenth of all triangles.
  CHECK(source(with(accepted_held(jobs[0], {rung(10, 420)}))).empty());
  // Below it with more, but by nothing that has to do with the topology.
  CHECK(source(with(accepted(jobs[0], {rung(10, 1000)}))).empty());
}

TEST_CASE("where others would pay for the topology, all are asked for again without it") {
  const Manifest manifest = manifest_of(2, 100'000);
  const RunOptions options{.ratio = 0.01};
  const auto source = next_of(manifest, options);
  const std::vector<Job> jobs = source({});
  std::vector<AcceptedJob> done = {accepted_held(jobs[0], {rung(10, 430)}),
                                   accepted(jobs[1], {rung(10, 7000), rung(11, 3800)})};
  const std::vector<Job> again = source(done);
  REQUIRE(again.size() == 2);
  for (std::size_t p = 0; p < 2; ++p) {
    CHECK(topology_of(again[p]) == TopologyMode::simplify);
    // From where its first job had begun to refuse anything.
    CHECK(again[p].inputs == std::vector{done[p].output.file});
    CHECK(again[p].sections.size() == 3);
    CHECK(decode_parameters(again[p].parameters).from->level == 10);
    CHECK(decode_parameters(again[p].parameters).from->place == 0);
    CHECK(decode_parameters(again[p].parameters).start_triangles ==
          decode_parameters(jobs[p].parameters).start_triangles);
    CHECK(key_of(again[p]) != key_of(jobs[p]));
  }
  // From there on it is a run like any other: who was taken too far is asked for again, finer.
  done.push_back(accepted(again[0], {rung(5, 8000), rung(6, 30)}));
  done.push_back(accepted(again[1], {rung(20, 3000), rung(21, 2000)}));
  const std::vector<Job> finer = source(done);
  REQUIRE(finer.size() == 1);
  CHECK(finer[0].inputs == jobs[1].inputs);
  CHECK_FALSE(decode_parameters(finer[0].parameters).from);
  CHECK(topology_of(finer[0]) == TopologyMode::simplify);
  done.push_back(accepted(finer[0], {rung(6, 40'000), rung(20, 3000)}));
  CHECK(source(done).empty());
  const ChosenRungs chosen = chosen_of(manifest, options, done);
  CHECK(chosen.topology == TopologyMode::simplify);
  CHECK(chosen.rungs[0].file.name == done[2].output.file.name);
  CHECK(chosen.rungs[1].file.name == done[4].output.file.name);
}

TEST_CASE("all together may not be held at more than twice what is wanted") {
  const Manifest manifest = manifest_of(2, 100'000);
  const RunOptions options{.ratio = 0.01};
  const auto source = next_of(manifest, options);
  const std::vector<Job> jobs = source({});
  const auto both = [&](std::uint64_t triangles) {
    const std::vector<Rung> ladder = {rung(10, triangles / 2), rung(11, 100)};
    return std::vector{accepted_held(jobs[0], ladder), accepted_held(jobs[1], ladder)};
  };
  CHECK(source(both(8000)).empty());
  CHECK(source(both(8002)).size() == 2);
}

TEST_CASE("parts whose topology leaves more than the target are asked for again without it") {
  const Manifest manifest = manifest_of(2, 100'000);
  const RunOptions options{.ratio = 0.01};  // 2,000
  const auto source = next_of(manifest, options);
  const std::vector<Job> jobs = source({});
  const auto both = [&](std::uint64_t triangles) {
    const std::vector<Rung> ladder = {rung(10, 2500), rung(14, triangles / 2)};
    return std::vector{accepted_held(jobs[0], ladder), accepted_held(jobs[1], ladder)};
  };
  CHECK(source(both(2000)).empty());
  CHECK(source(both(2002)).size() == 2);
  // One that goes on would have left half of its share.
  const auto beside = [&](std::uint64_t triangles) {
    ResultSummary other{{rung(10, 2500)}};
    other.end = LadderEnd::enough;
    AcceptedJob going = accepted(jobs[1], {});
    going.output.summary = encode_summary(other);
    return std::vector{accepted_held(jobs[0], {rung(10, 2500), rung(14, triangles)}), going};
  };
  CHECK(source(beside(1500)).empty());
  CHECK(source(beside(1501)).size() == 2);
}

TEST_CASE("parts that are refused too much are asked for again without their topology") {
  const Manifest manifest = manifest_of(2, 100'000);
  const auto asked_again = [&](double ratio, std::vector<Rung> ladder) {
    const auto source = next_of(manifest, {.ratio = ratio});
    const std::vector<Job> jobs = source({});
    return !source(std::vector{accepted(jobs[0], ladder), accepted(jobs[1], ladder)}).empty();
  };
  const auto refused = [](std::uint64_t triangles, std::uint64_t at_first) {
    std::vector<Rung> ladder = {rung(10, triangles), rung(11, triangles / 4)};
    ladder[0].refused = at_first;
    ladder[1].refused = 4 * triangles;  // what comes later is not asked about
    return ladder;
  };
  // 40,000 are wanted before the finish. As many as that: 1.1 a triangle.
  CHECK_FALSE(asked_again(0.1, refused(20'000, 21'000)));
  CHECK(asked_again(0.1, refused(20'000, 23'000)));
  // With 1.5 times as many a fifth of that a triangle tells as much.
  CHECK_FALSE(asked_again(0.1, refused(30'000, 6'000)));
  CHECK(asked_again(0.1, refused(30'000, 7'000)));
  // Of few the finish finds out.
  CHECK_FALSE(asked_again(0.01, refused(2000, 9000)));
  // A ladder that ended for it is taken to fall as others do: to 13,700 here, a third.
  const auto source = next_of(manifest, {.ratio = 0.1});
  const std::vector<Job> jobs = source({});
  const auto asked_beside = [&](std::uint64_t refused_of_one) {
    Rung first = rung(10, 40'000);
    first.refused = refused_of_one;
    ResultSummary ended{{first}};
    ended.end = LadderEnd::refusals;
    AcceptedJob one = accepted(jobs[0], {});
    one.output.summary = encode_summary(ended);
    const std::vector<Rung> other = {rung(10, 60'000), rung(12, 30'000)};
    return !source(std::vector{one, accepted(jobs[1], other)}).empty();
  };
  CHECK_FALSE(asked_beside(600));
  CHECK(asked_beside(800));
}

TEST_CASE("parts that were refused too much go on if the others would not have paid") {
  const Manifest manifest = manifest_of(2, 100'000);
  const RunOptions options{.ratio = 0.1};  // 40,000 are wanted before the finish
  const auto source = next_of(manifest, options);
  const std::vector<Job> jobs = source({});
  const auto ended = [](const Job& job, LadderEnd end) {
    Rung first = rung(10, 40'000);
    Rung last = rung(12, 26'000);
    first.refused = 100;
    last.refused = 90'000;
    ResultSummary summary{{first, last}};
    summary.end = end;
    AcceptedJob done = accepted(job, {});
    done.output.summary = encode_summary(summary);
    return done;
  };
  std::vector<AcceptedJob> done = {ended(jobs[0], LadderEnd::refusals),
                                   ended(jobs[1], LadderEnd::enough)};
  const std::vector<Job> without = source(done);
  REQUIRE(without.size() == 2);
  CHECK(topology_of(without[0]) == TopologyMode::simplify);
  const auto after = [&](std::uint64_t triangles) {
    std::vector<AcceptedJob> all = done;
    for (const Job& job : without) {
      all.push_back(accepted(job, {rung(10, 40'000), rung(12, triangles), rung(13, 15'000)}));
    }
    return all;
  };
  // With more than 1.2 times the triangles at the same cost the topology is given up.
  CHECK(source(after(21'600)).empty());
  CHECK(chosen_of(manifest, options, after(21'600)).topology == TopologyMode::simplify);
  // Else the one that had stopped goes on from its last rung.
  std::vector<AcceptedJob> all = after(21'800);
  const std::vector<Job> on = source(all);
  REQUIRE(on.size() == 1);
  CHECK(topology_of(on[0]) == TopologyMode::keep_while_fair);
  CHECK(on[0].inputs == std::vector{done[0].output.file});
  CHECK(decode_parameters(on[0].parameters).from->place == 1);
  CHECK(decode_parameters(on[0].parameters).from->level == 12);
  CHECK(decode_parameters(on[0].parameters).foreseen_triangles == 0);
  // And that is not asked again, whatever it is refused.
  Rung much = rung(12, 26'000);
  much.refused = 1'000'000;
  all.push_back(accepted(on[0], {much, rung(13, 14'000)}));
  CHECK(source(all).empty());
  const ChosenRungs chosen = chosen_of(manifest, options, all);
  CHECK(chosen.topology == TopologyMode::automatic);
  CHECK(chosen.rungs[0].file.name == all.back().output.file.name);
  CHECK(chosen.rungs[1].file.name == done[1].output.file.name);
}

TEST_CASE("who says what becomes of the topology is asked once") {
  const Manifest manifest = manifest_of(2, 100'000);
  for (const TopologyMode mode : {TopologyMode::keep, TopologyMode::simplify}) {
    const RunOptions options{.ratio = 0.01, .lines = {.topology = mode}};
    const auto source = next_of(manifest, options);
    const std::vector<Job> jobs = source({});
    CHECK(topology_of(jobs[0]) == mode);
    const std::vector done = {accepted_held(jobs[0], {rung(10, 9000)}),
                              accepted_held(jobs[1], {rung(10, 9000)})};
    CHECK(source(done).empty());
    CHECK(chosen_of(manifest, options, done).topology == mode);
  }
  // A bound on the error keeps it, since nothing has to be paid for a count.
  CHECK(topology_of(next_of(manifest, {.error = {0.2, false}})({})[0]) == TopologyMode::keep);
  const RunOptions uniform{.ratio = 0.01, .allocation = Allocation::uniform};
  CHECK(topology_of(next_of(manifest, uniform)({})[0]) == TopologyMode::automatic);
}

TEST_CASE("long streams are swept as their samples were climbed") {
  Manifest manifest = manifest_of(2, 100'000);
  manifest.scheme = Scheme::stream;
  manifest.window_triangles = 10'000;
  for (const PartEntry& part : manifest.parts) {
    manifest.samples.push_back(part);
    manifest.samples.back().triangles = 10'000;
  }
  const RunOptions options{.ratio = 0.01, .composition = Composition::sink};
  const auto source = next_of(manifest, options);
  const std::vector<Job> jobs = source({});
  // A tenth of each stream.
  const std::vector<Job> kept =
      source(std::vector{accepted(jobs[0], {rung(10, 400)}), accepted(jobs[1], {rung(10, 400)})});
  REQUIRE(kept.size() == 2);
  for (const Job& sweep : kept) {
    REQUIRE(sweep.kind == k_sweep_kind);
    CHECK(topology_of(sweep) == TopologyMode::keep);
  }
  std::vector<AcceptedJob> done = {accepted_held(jobs[0], {rung(9, 1000)}),
                                   accepted(jobs[1], {rung(9, 500), rung(10, 400)})};
  const std::vector<Job> again = source(done);
  REQUIRE(again.size() == 2);
  for (const Job& job : again) {
    REQUIRE(job.kind == k_simplify_kind);
    CHECK(topology_of(job) == TopologyMode::simplify);
    done.push_back(accepted(job, {rung(10, 400)}));
  }
  const std::vector<Job> swept = source(done);
  REQUIRE(swept.size() == 2);
  for (const Job& sweep : swept) {
    REQUIRE(sweep.kind == k_sweep_kind);
    CHECK(topology_of(sweep) == TopologyMode::simplify);
  }
}

TEST_CASE("a large ratio leaves the parts as they are") {
  const Manifest manifest = manifest_of(2, 1000);
  const std::vector<Job> jobs = next_of(manifest, {.ratio = 0.9})({});
  CHECK(decode_parameters(jobs[0].parameters).start_triangles == 1000);
}

TEST_CASE("with a bound on the error each part is taken as far as it allows, and once") {
  const Manifest manifest = manifest_of(2, 100'000);  // its diagonal is sqrt(3)
  const RunOptions options{.error = {0.2, false}};
  const auto source = next_of(manifest, options);
  const std::vector<Job> jobs = source({});
  CHECK(decode_parameters(jobs[0].parameters).max_error ==
        doctest::Approx(0.2 * k_bound_share_of_parts));
  const std::vector<AcceptedJob> done = {
      accepted(jobs[0], {Rung{5, 10'000, 20'000, 20'000, 0.18}}),
      accepted(jobs[1], {Rung{9, 25'000, 50'000, 50'000, 0.17}})};
  CHECK(source(done).empty());
  CHECK(chosen_of(manifest, options, done).rungs.size() == 2);
}

TEST_CASE(
    "a bound that is to be proven is asked of the parts, with memory for it, and another run") {
  const Manifest manifest = manifest_of(2, 100'000);
  const RunOptions measured{.error = {0.2, false}};
  const RunOptions proven{.error = {0.2, false}, .certify = true};
  const Job before = next_of(manifest, measured)({})[0];
  const Job after = next_of(manifest, proven)({})[0];
  CHECK(decode_parameters(before.parameters).certified_error == 0);
  CHECK(decode_parameters(after.parameters).certified_error == 0.2);
  CHECK(after.memory > before.memory);
  CHECK(run_key(manifest, proven) != run_key(manifest, measured));
}

TEST_CASE("the paper's allocation is the same ratio in each part, and once") {
  const Manifest manifest = manifest_of(2, 100'000);
  const RunOptions options{.ratio = 0.02, .allocation = Allocation::uniform};
  const auto source = next_of(manifest, options);
  const std::vector<Job> jobs = source({});
  CHECK(decode_parameters(jobs[0].parameters).start_triangles == 2000);
  const std::vector<AcceptedJob> done = {accepted(jobs[0], {rung(0, 2500)}),
                                         accepted(jobs[1], {rung(0, 2000)})};
  CHECK(source(done).empty());
}

TEST_CASE("a stage without parts has no jobs; a target needs a ratio or a count") {
  CHECK(next_of(manifest_of(0, 0), {.ratio = 0.5})({}).empty());
  CHECK(target_triangles(manifest_of(1, 1001), {.ratio = 0.5}) == 501);
  CHECK(target_triangles(manifest_of(1, 1000), {.triangles = 7}) == 7);
  // Of what in the input is a triangle, however it is divided.
  Manifest dirty = manifest_of(1, 1000);
  dirty.parts[0].triangles = 900;
  dirty.dropped_degenerate = 80;
  dirty.dropped_duplicate = 20;
  dirty.coincident_corners = 100;
  CHECK(target_triangles(dirty, {.ratio = 0.5}) == 450);
  dirty.dropped_not_finite = 10;
  CHECK(target_triangles(dirty, {.ratio = 0.5}) == 445);
  CHECK_THROWS_AS(target_triangles(manifest_of(1, 1000), {}), UsageError);
  CHECK_THROWS_AS(target_triangles(manifest_of(1, 1000), {.ratio = 1.5}), UsageError);
}

TEST_CASE("runs of different targets have different keys") {
  const Manifest manifest = manifest_of(1, 1000);
  CHECK(run_key(manifest, {.ratio = 0.5}) == run_key(manifest, {.triangles = 500}));
  CHECK(run_key(manifest, {.ratio = 0.5}) != run_key(manifest, {.ratio = 0.4}));
  CHECK(run_key(manifest, {.ratio = 0.5}) !=
        run_key(manifest, {.ratio = 0.5, .finish = Finish::boundary}));
  CHECK(run_key(manifest, {.ratio = 0.5}) !=
        run_key(manifest, {.ratio = 0.5, .lines = {.preserve_border = true}}));
  CHECK(run_key(manifest, {.ratio = 0.5}) !=
        run_key(manifest, {.ratio = 0.5, .lines = {.crease_angle = 30}}));
  CHECK(run_key(manifest, {.ratio = 0.5}) !=
        run_key(manifest, {.ratio = 0.5, .lines = {.topology = TopologyMode::keep}}));
}

TEST_CASE("runs of different channels have different keys") {
  Manifest manifest = manifest_of(1, 1000);
  manifest.box = {{0, 0, 0}, {1, 1, 1}};
  manifest.channels.channels = {{"red", ChannelType::uint8, ChannelRole::colour},
                                {"heat", ChannelType::float32, ChannelRole::quality}};
  const auto key_of = [&](const std::string& choice, Normals normals) {
    return run_key(manifest,
                   {.ratio = 0.5, .channels = parse_choice(choice, ""), .normals = normals});
  };
  const std::uint64_t usual = key_of("auto", Normals::blend);
  CHECK(usual == run_key(manifest, {.ratio = 0.5}));
  CHECK(usual != key_of("auto", Normals::recompute));
  CHECK(usual != key_of("red", Normals::blend));
  CHECK(key_of("red", Normals::blend) != key_of("heat", Normals::blend));
  CHECK(key_of("red", Normals::blend) != key_of("none", Normals::blend));
  CHECK_THROWS_AS(key_of("blue", Normals::blend), UsageError);
  // Colours that are not wanted do not count.
  const auto weight_of = [&](const std::string& choice) {
    return lines_of(manifest, {.ratio = 0.5, .channels = parse_choice(choice, "")})
        .appearance_scale.length;
  };
  CHECK(weight_of("auto") > 0);
  CHECK(weight_of("red") == weight_of("auto"));
  CHECK(weight_of("heat") == 0);
}

TEST_CASE("the more colours weigh, the steeper ones count") {
  Manifest manifest;
  manifest.channels.channels = {{"red", ChannelType::uint8, ChannelRole::colour}};
  manifest.box.add({0, 0, 0});
  manifest.box.add({3, 4, 0});
  const auto scale_of = [&](double weight) {
    return lines_of(manifest, {.colour_weight = weight}).appearance_scale;
  };
  CHECK(scale_of(0.002).length == doctest::Approx(0.01));
  CHECK(scale_of(0.002).steepest == AppearanceScale{}.steepest);
  CHECK(scale_of(0.008).length == doctest::Approx(0.04));
  CHECK(scale_of(0.008).steepest == doctest::Approx(8 * AppearanceScale{}.steepest));
  CHECK(scale_of(0).length == 0);
}

TEST_CASE("parameters come back; damaged ones are refused") {
  const SimplifyParameters p{
      Allocation::uniform,
      12,
      3,
      5,
      9,
      77,
      0.25,
      0.5,
      0.625,
      {true, 40, TopologyMode::simplify, {0.75, 1.5}, {false}, 0, CrossingMode::avoid}};
  const std::string bytes = encode_parameters(p);
  const SimplifyParameters back = decode_parameters(bytes);
  CHECK(back.allocation == Allocation::uniform);
  CHECK(back.start_triangles == 12);
  CHECK(back.end_triangles == 5);
  CHECK(back.foreseen_triangles == 9);
  CHECK(back.samples == 77);
  CHECK(back.cost_unit == 0.25);
  CHECK(back.max_error == 0.5);
  CHECK(back.certified_error == 0.625);
  CHECK(back.lines.preserve_border);
  CHECK(back.lines.crossings == CrossingMode::avoid);
  CHECK(back.lines.crease_angle == 40);
  CHECK(back.lines.topology == TopologyMode::simplify);
  CHECK(back.lines.appearance_scale.length == 0.75);
  CHECK(back.lines.appearance_scale.steepest == 1.5);
  CHECK_FALSE(back.lines.columns.labels);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    CHECK_THROWS_AS(decode_parameters(std::string_view(bytes).substr(0, i)), DataError);
  }
  CHECK_THROWS_AS(decode_parameters(bytes + "x"), DataError);
  CHECK_THROWS_AS(decode_parameters("\x0c" + bytes.substr(1)), DataError);
  // The topology stands last but for the two numbers of appearances, what is said of labels, and
  // that there is nothing to build.
  std::string other = bytes;
  other[bytes.size() - 2 * sizeof(double) - 3] = 4;
  CHECK_THROWS_AS(decode_parameters(other), DataError);
  other = bytes;
  other.back() = 4;
  CHECK_THROWS_AS(decode_parameters(other), DataError);
  other = bytes;
  other[bytes.size() - 2] = 4;
  CHECK_THROWS_AS(decode_parameters(other), DataError);
  other = bytes;
  other[bytes.size() - 3] = static_cast<char>(0xff);
  CHECK_THROWS_AS(decode_parameters(other), DataError);
}

TEST_CASE("parameters of a job that begins at a rung come back; damaged ones are refused") {
  SimplifyParameters p;
  p.from = RungOfLadder{3, 7};
  const std::string bytes = encode_parameters(p);
  CHECK(decode_parameters(bytes).from->level == 7);
  CHECK(decode_parameters(bytes).from->place == 3);
  CHECK_FALSE(decode_parameters(bytes).build);
  for (const std::int32_t level : {-2, 53, INT32_MAX}) {
    p.from->level = level;
    CHECK_THROWS_AS(decode_parameters(encode_parameters(p)), DataError);
  }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    CHECK_THROWS_AS(decode_parameters(std::string_view(bytes).substr(0, i)), DataError);
  }
  CHECK_THROWS_AS(decode_parameters(bytes + "x"), DataError);
}

TEST_CASE("vertices are fitted to points where these are few") {
  const auto fitting = [](std::uint64_t input, RunOptions options) {
    return sample_counts(manifest_of(10, input / 10), options).fitting;
  };
  CHECK(fitting(10'000'000, {.ratio = 0.001}) == 200'000);  // more a triangle are of no use
  CHECK(fitting(10'000'000, {.ratio = 0.005}) == 300'000);
  CHECK(fitting(10'000'000, {.triangles = 125'000}) == 500'000);
  CHECK(fitting(10'000'000, {.triangles = 125'001}) == 0);  // fewer would not help
  CHECK(fitting(10'000'000, {.ratio = 0.2, .fit = VertexFit::on}) == 8'000'000);
  CHECK(fitting(100'000'000, {.ratio = 0.5, .fit = VertexFit::on}) == 0);  // too many
  CHECK(fitting(10'000'000, {.triangles = 10'000, .fit = VertexFit::off}) == 0);
  CHECK(fitting(10'000'000, {.ratio = 0.001, .finish = Finish::boundary}) == 0);
  CHECK(fitting(10'000'000, {.error = {1, false}, .fit = VertexFit::on}) == 0);
  CHECK(fitting(10'000'000, {.ratio = 0.001, .drop_components = {1, false}}) == 0);
  const Manifest manifest = manifest_of(10, 1'000'000);
  const auto key_of_run = [&](VertexFit fit) {
    return run_key(manifest, {.ratio = 0.001, .fit = fit});
  };
  CHECK(key_of_run(VertexFit::automatic) == key_of_run(VertexFit::on));
  CHECK(key_of_run(VertexFit::automatic) != key_of_run(VertexFit::off));
  RunOptions avoids{.ratio = 0.001};
  avoids.lines.crossings = CrossingMode::avoid;
  CHECK(fitting(10'000'000, avoids) == 0);
}

TEST_CASE("samples are split evenly, and each set keeps some to be measured by") {
  std::vector<SurfaceSamples> sets(3);
  sets[0].area = 2;
  sets[1].area = 5;
  for (int i = 0; i < 1000; ++i) sets[0].points.push_back({i * 1.0, 0, 0});
  sets[1].points = {{-1, 0, 0}, {-2, 0, 0}};
  const SplitSamples split = split_samples(sets, {100, 300});
  REQUIRE(split.measured.size() == 3);
  REQUIRE(split.fitting.size() == 3);
  CHECK(split.measured[0].points.size() == 250);
  CHECK(split.fitting[0].points.size() == 750);
  CHECK(split.measured[0].points[0].x == 0);
  CHECK(split.measured[0].points[100].x == 400);
  CHECK(split.measured[0].area == 2);
  CHECK(split.fitting[0].area == 2);
  CHECK(split.measured[1].points.size() == 1);
  CHECK(split.fitting[1].points.size() == 1);
  CHECK(split.measured[2].points.empty());
  // Where none are fitted all are measured.
  const SplitSamples all = split_samples(sets, {100, 0});
  CHECK(all.measured[0].points.size() == 1000);
  CHECK(all.fitting.empty());
}
