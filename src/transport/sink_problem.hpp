// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <exception>

#include <meshfarm/farm/sink_core.hpp>

namespace meshfarm {

/// Describes an exception; empty for null. Whether the disk was full is reported separately: the
/// sink decides how to handle that.
SinkProblem problem_of(const std::exception_ptr& thrown);

/// For a journal that cannot be written.
SinkProblem problem_of_journal(const std::exception_ptr& thrown);

}  // namespace meshfarm
