// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/report/trace.hpp>

namespace meshfarm {

/// A run as one HTML page that needs nothing else: a summary, who computed when, how the work
/// went down, and a table of the workers.
std::string render_run_page(const Manifest& manifest, const Trace& trace,
                            const std::optional<RunTimes>& times);

}  // namespace meshfarm
