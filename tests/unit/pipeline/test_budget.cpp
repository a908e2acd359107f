// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdint>

#include <doctest/doctest.h>

#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>
#include <meshfarm/util/errors.hpp>

#include "told_ladders.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

TEST_CASE("the rung at a level is the coarsest that is not above it") {
  const std::vector<Rung> ladder = {rung(3, 100), rung(5, 60), rung(6, 40), rung(9, 10)};
  CHECK(rung_at(ladder, 2) == 0);  // none is: the finest
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
  CHECK(free_triangles_at(part, 4) == 126);
  CHECK(free_triangles_at(part, 6) == 79);
  const std::vector<ResultSummary> parts = {part, {{rung(2, 900), rung(4, 600), rung(5, 500)}}};
  CHECK(common_level(parts, 600) == 5);
  CHECK(common_level(parts, 601) == 4);
}

TEST_CASE("levels and costs fit each other") {
  const double unit = cost_unit(123.4);
  for (const std::int32_t level : {0, 1, 7, 30, 100}) {
    CHECK(level_of(level_cost(level, unit), unit) == level);
    CHECK(level_of(level_cost(level, unit) * 1.001, unit) == level + 1);
  }
  CHECK(level_of(0, unit) == 0);
  CHECK(level_of(0, 0) == 0);
  CHECK(cost_unit(2) == 16 * cost_unit(1));
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
  // The ratio is of the input's proper triangles, however the input is divided.
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
  // Unwanted colours do not count.
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
  CHECK_THROWS_AS(decode_parameters("\x0b" + bytes.substr(1)), DataError);
  // After the topology there are only the two numbers of appearances, what is said of labels, and
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
  for (const std::int32_t level : {-2, 105, INT32_MAX}) {
    p.from->level = level;
    CHECK_THROWS_AS(decode_parameters(encode_parameters(p)), DataError);
  }
  p.from = RungOfLadder{k_most_rungs, 7};
  CHECK_THROWS_AS(decode_parameters(encode_parameters(p)), DataError);
  p.from = RungOfLadder{3, 7};
  p.max_error = 0.1;
  CHECK_THROWS_AS(decode_parameters(encode_parameters(p)), DataError);
  p.max_error = 0;
  p.allocation = Allocation::uniform;
  CHECK_THROWS_AS(decode_parameters(encode_parameters(p)), DataError);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    CHECK_THROWS_AS(decode_parameters(std::string_view(bytes).substr(0, i)), DataError);
  }
  CHECK_THROWS_AS(decode_parameters(bytes + "x"), DataError);
}

TEST_CASE("vertices are fitted to points where these are few") {
  const auto fitting = [](std::uint64_t input, RunOptions options) {
    return sample_counts(manifest_of(10, input / 10), options).fitting;
  };
  CHECK(fitting(10'000'000, {.ratio = 0.001}) == 200'000);  // more per triangle are of no use
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
  // Where no samples are for fitting, all are for measuring.
  const SplitSamples all = split_samples(sets, {100, 0});
  CHECK(all.measured[0].points.size() == 1000);
  CHECK(all.fitting.empty());
}
