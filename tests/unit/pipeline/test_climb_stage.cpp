// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include "told_ladders.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

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
  // Twice the share is wanted; one level above is 1.26 times as many. At ten boundary vertices, 20
  // triangles stay as they are.
  CHECK(p.end_triangles == 2519);
  const auto end_of = [&](const RunOptions& other) {
    return decode_parameters(next_of(manifest, other)({})[0].parameters).end_triangles;
  };
  CHECK(end_of({.ratio = 0.5}) == 62'487);  // without a first rung by count
  CHECK(end_of({.ratio = 0.01, .finish_place = FinishPlace::farm}) == 999);
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

TEST_CASE("what stays as it is at boundaries does not count as wanted") {
  Manifest manifest = manifest_of(2, 100'000);
  for (PartEntry& part : manifest.parts) part.boundary_vertices = part.shared_boundary = 25'000;
  const RunOptions options{.ratio = 0.01};
  const auto source = next_of(manifest, options);
  const std::vector<Job> jobs = source({});
  CHECK(decode_parameters(jobs[0].parameters).end_triangles == 1260);
  CHECK(decode_parameters(jobs[0].parameters).foreseen_triangles == 1000);
  // Half of the triangles touch a boundary, so of 4,000 before the finish 2,000 may be free.
  const std::vector<Rung> ladder = {rung(10, 1500), rung(11, 1000), rung(12, 999)};
  const std::vector<AcceptedJob> done = {accepted(jobs[0], ladder), accepted(jobs[1], ladder)};
  CHECK(source(done).empty());
  CHECK(chosen_of(manifest, options, done).rungs[0].rung == 1);
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
  // Held above the chosen level: the others pay nothing.
  const auto above = with(accepted_held(jobs[0], {rung(10, 1000), rung(11, 700)}));
  CHECK(source(above).empty());
  CHECK(chosen_of(manifest, options, above).topology == TopologyMode::automatic);
  // Held below it with less than a tenth of all triangles.
  CHECK(source(with(accepted_held(jobs[0], {rung(10, 420)}))).empty());
  // Below it with more, but not because of the topology.
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
    // It goes on from where the part's first job began to refuse collapses.
    CHECK(again[p].inputs == std::vector{done[p].output.file});
    CHECK(again[p].sections.size() == 3);
    CHECK(decode_parameters(again[p].parameters).from->level == 10);
    CHECK(decode_parameters(again[p].parameters).from->place == 0);
    CHECK(decode_parameters(again[p].parameters).start_triangles ==
          decode_parameters(jobs[p].parameters).start_triangles);
    CHECK(key_of(again[p]) != key_of(jobs[p]));
  }
  // From there on it is a run like any other: a part taken too far is asked for again, finer.
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
  CHECK(source(both(7998)).empty());
  CHECK(source(both(8000)).size() == 2);
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
  // A part that goes on would have left half of its share.
  const auto beside = [&](std::uint64_t triangles) {
    const AcceptedJob going = accepted_ended(jobs[1], {rung(10, 2500)}, LadderEnd::enough);
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
    ladder[1].refused = 4 * triangles;  // later refusals do not matter
    return ladder;
  };
  // 40,000 are wanted before the finish. At that many, the threshold is 1.1 per triangle.
  CHECK_FALSE(asked_again(0.1, refused(20'000, 21'000)));
  CHECK(asked_again(0.1, refused(20'000, 23'000)));
  // At 1.5 times as many, the threshold per triangle is a fifth of that.
  CHECK_FALSE(asked_again(0.1, refused(30'000, 6'000)));
  CHECK(asked_again(0.1, refused(30'000, 7'000)));
  // The same holds for few triangles: the finish can't mend what parts have kept at a high cost.
  CHECK_FALSE(asked_again(0.01, refused(2000, 2100)));
  CHECK(asked_again(0.01, refused(2000, 2300)));
  // A ladder that ended for it is assumed to fall as others do: here to 18,300.
  const auto source = next_of(manifest, {.ratio = 0.1});
  const std::vector<Job> jobs = source({});
  const auto asked_beside = [&](std::uint64_t refused_of_one) {
    Rung first = rung(10, 40'000);
    first.refused = refused_of_one;
    const AcceptedJob one = accepted_ended(jobs[0], {first}, LadderEnd::refusals);
    const std::vector<Rung> other = {rung(10, 60'000), rung(12, 30'000)};
    return !source(std::vector{one, accepted(jobs[1], other)}).empty();
  };
  CHECK_FALSE(asked_beside(2600));
  CHECK(asked_beside(2700));
}

TEST_CASE("a rung is finer if it has more triangles, not if its ladder would go on") {
  const Manifest manifest = manifest_of(2, 100'000);
  const RunOptions options{.ratio = 0.1};  // 40,000 are wanted before the finish
  const auto source = next_of(manifest, options);
  const std::vector<Job> jobs = source({});
  const auto finer = [&](const std::vector<Rung>& first, const std::vector<Rung>& second) {
    const std::vector<AcceptedJob> done = {accepted_ended(jobs[0], first, LadderEnd::refusals),
                                           accepted_ended(jobs[1], second, LadderEnd::refusals)};
    CHECK(source(done).empty());
    return chosen_of(manifest, options, done).finer;
  };
  // Level 10 is chosen. The first would have 25,195 triangles there, and 31,746 one level before.
  CHECK(finer({rung(8, 40'000)}, {rung(10, 30'000)}).empty());
  const std::vector<Rung> both = {rung(9, 60'000), rung(10, 40'000)};
  const std::vector<ChosenRung> found = finer(both, both);
  REQUIRE(found.size() == 2);
  CHECK(found[0].rung == 0);
}

TEST_CASE("parts that were refused too much go on if the others would not have paid") {
  const Manifest manifest = manifest_of(2, 100'000);
  const RunOptions options{.ratio = 0.1};  // 40,000 are wanted before the finish
  const auto source = next_of(manifest, options);
  const std::vector<Job> jobs = source({});
  const auto ended = [](const Job& job, std::int32_t level, LadderEnd end) {
    Rung first = rung(10, 40'000);
    Rung last = rung(level, 26'000);
    first.refused = 100;
    last.refused = 90'000;
    return accepted_ended(job, {first, last}, end);
  };
  std::vector<AcceptedJob> done = {ended(jobs[0], 12, LadderEnd::refusals),
                                   ended(jobs[1], 13, LadderEnd::enough)};
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
  CHECK(source(after(28'200)).empty());
  CHECK(chosen_of(manifest, options, after(28'200)).topology == TopologyMode::simplify);
  // Otherwise the part that had stopped goes on from its last rung.
  std::vector<AcceptedJob> all = after(28'400);
  const std::vector<Job> on = source(all);
  REQUIRE(on.size() == 1);
  CHECK(topology_of(on[0]) == TopologyMode::keep_while_fair);
  CHECK(on[0].inputs == std::vector{done[0].output.file});
  CHECK(decode_parameters(on[0].parameters).from->place == 1);
  CHECK(decode_parameters(on[0].parameters).from->level == 12);
  CHECK(decode_parameters(on[0].parameters).foreseen_triangles == 0);
  // That job is not questioned again, however much it is refused.
  Rung much = rung(12, 26'000);
  much.refused = 1'000'000;
  all.push_back(accepted(on[0], {much, rung(13, 14'000)}));
  CHECK(source(all).empty());
  const ChosenRungs chosen = chosen_of(manifest, options, all);
  CHECK(chosen.topology == TopologyMode::automatic);
  CHECK(chosen.rungs[0].file.name == all.back().output.file.name);
  CHECK(chosen.rungs[1].file.name == done[1].output.file.name);
  // But if it turns out to be held back, or only gets there at a far higher cost, the results
  // without the topology are taken, which are there already.
  const std::vector<AcceptedJob> not_fair = {
      accepted_held(on[0], {rung(12, 26'000)}),
      accepted(on[0], {rung(12, 60'000), rung(19, 59'000), rung(20, 14'000)})};
  for (const AcceptedJob& each : not_fair) {
    all.back() = each;
    CHECK(source(all).empty());
    const ChosenRungs given_up = chosen_of(manifest, options, all);
    CHECK(given_up.topology == TopologyMode::simplify);
    CHECK(given_up.rungs[0].file.name == all[2].output.file.name);
    CHECK(given_up.rungs[1].file.name == all[3].output.file.name);
  }
}

TEST_CASE("ladders are compared where each of them ended, and not before they have gone some way") {
  const Manifest manifest = manifest_of(2, 100'000);
  const auto goes_on = [&](std::uint64_t of_first, std::uint64_t of_last, std::uint64_t of_other) {
    const auto source = next_of(manifest, {.ratio = 0.1});
    const std::vector<Job> jobs = source({});
    Rung end = rung(11, of_last);
    end.refused = 1'000'000;
    std::vector<AcceptedJob> done = {
        accepted_ended(jobs[0], {rung(10, of_first), end}, LadderEnd::refusals),
        accepted(jobs[1], {rung(10, 31'000), rung(12, 30'000)})};
    const std::vector<Job> without = source(done);
    REQUIRE(without.size() == 2);
    done.push_back(accepted(without[0], {rung(10, of_first), rung(11, of_other), rung(12, 9000)}));
    done.push_back(accepted(without[1], {rung(10, 31'000), rung(12, 30'000)}));
    const std::vector<Job> on = source(done);
    return !on.empty() && topology_of(on[0]) == TopologyMode::keep_while_fair;
  };
  CHECK(goes_on(60'000, 40'000, 29'000));
  CHECK_FALSE(goes_on(60'000, 40'000, 27'000));
  CHECK_FALSE(goes_on(42'000, 40'000, 40'000));
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
  // A bound on the error keeps the topology, since there is no count to pay for.
  CHECK(topology_of(next_of(manifest, {.error = {0.2, false}})({})[0]) == TopologyMode::keep);
  const RunOptions uniform{.ratio = 0.01, .allocation = Allocation::uniform};
  CHECK(topology_of(next_of(manifest, uniform)({})[0]) == TopologyMode::automatic);
}
