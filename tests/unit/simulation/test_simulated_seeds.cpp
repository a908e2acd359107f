// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/simulation/simulated_seeds.hpp>

namespace meshfarm::test {
namespace {

struct Farm {
  std::uint64_t seed;
  std::uint32_t workers;
  std::uint64_t jobs;
};

/// Histories of a few workers, each of which once revealed a bug.
void check_each(const std::vector<Farm>& farms) {
  for (const Farm& farm : farms) {
    CAPTURE(farm.seed);
    const SeedsResult result = simulate_seeds(
        {.first = farm.seed, .count = 1, .workers = farm.workers, .jobs = farm.jobs});
    for (const SeedProblem& problem : result.problems) FAIL_CHECK(problem.what);
  }
}

TEST_CASE("a static schedule ends with few workers, one of whose jobs kills them") {
  check_each({{115, 2, 20}, {382, 2, 20}, {498, 4, 40}, {2102, 4, 40}});
}

TEST_CASE("a sink's full disk holds nobody up once there is room again") {
  check_each({{9298, 2, 20}, {9298, 4, 40}, {8924, 6, 100}});
}

TEST_CASE("what a sink failed at while the disk was full is told after it, and begun again") {
  check_each({{23910, 2, 20}, {12080, 6, 100}});
}

TEST_CASE("a ventilator that comes after the output was made ends, though no sink comes") {
  check_each({{20870, 12, 200}});
}

TEST_CASE("a sink that comes after its run's end leaves, with the output") {
  check_each({{64796, 2, 20}});
}

TEST_CASE("a run that cuts and finishes by jobs ends with its bytes, whatever is mixed in") {
  for (const std::uint32_t workers : {1U, 2U, 5U, 24U}) {
    CAPTURE(workers);
    const SeedsResult result = simulate_seeds({.count = 100,
                                               .workers = workers,
                                               .jobs = std::uint64_t{64} + 16 * workers,
                                               .graph = SimulatedGraph::whole_run});
    for (const SeedProblem& problem : result.problems) {
      CAPTURE(problem.seed);
      FAIL_CHECK(problem.what);
    }
  }
}

TEST_CASE("farms of few workers end, whatever is mixed in") {
  for (const std::uint32_t workers : {1U, 2U, 3U, 5U}) {
    CAPTURE(workers);
    const SeedsResult result =
        simulate_seeds({.count = 500, .workers = workers, .jobs = std::uint64_t{16} * workers});
    for (const SeedProblem& problem : result.problems) {
      CAPTURE(problem.seed);
      FAIL_CHECK(problem.what);
    }
  }
}

}  // namespace
}  // namespace meshfarm::test
