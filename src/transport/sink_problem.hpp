// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <exception>

#include <meshfarm/farm/sink_core.hpp>

namespace meshfarm {

/// What was thrown, none if it is null. Whether there was no room is told beside it: what a sink
/// does then is its own choice.
SinkProblem problem_of(const std::exception_ptr& thrown);

/// Of a journal that cannot be written.
SinkProblem problem_of_journal(const std::exception_ptr& thrown);

}  // namespace meshfarm
