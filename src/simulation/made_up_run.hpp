// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/simulation/simulation.hpp>

namespace meshfarm {

/// A job of 0.1 to 1 s, derived from its name.
Job made_up_job(const std::string& name);
/// The output of a simulated job, derived from its parameters alone.
std::string simulated_summary(const Job& job);
/// Made-up jobs of 0.1 to 1 s in three stages: most of them, then one that depends on all of these,
/// then the rest, which each read that one and one of the first. The first are named "job 0", "job
/// 1"... With a target's name, as for another run of the same stage, only a quarter of the first
/// stage has these names; all other names contain the target's.
JobSource simulated_jobs(std::uint64_t count, const std::string& target = "");
/// The outputs' summaries of a run without any faults, computed directly.
std::vector<std::string> expected_summaries(const JobSource& source);
/// What is wrong with a simulated history: an invariant was broken, it did not end, or its end is
/// not the required one. Empty: nothing. `other`: expected of the other run; empty: there was none.
std::string problem_of(const SimulationResult& result, const SimulatedFaults& faults,
                       std::span<const std::string> expected,
                       std::span<const std::string> other = {});

}  // namespace meshfarm
