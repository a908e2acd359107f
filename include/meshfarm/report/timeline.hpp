// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/report/trace.hpp>

namespace meshfarm {

/// When a run's work was done, as a part of an HTML page: a summary, who computed when, the
/// progress of the work, and a table of the workers.
std::string render_timeline(const Manifest& manifest, const Trace& trace,
                            const std::optional<RunTimes>& times);

}  // namespace meshfarm
