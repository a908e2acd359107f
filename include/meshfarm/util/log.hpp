// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace meshfarm {

enum class LogLevel { debug, info, warning, error, off };

/// Names this process in its log lines ("worker 3") and hides what is below `level`.
/// Log lines go to stderr; results never do.
void set_log(std::string_view process, LogLevel level);

void log_debug(std::string_view line);
void log_info(std::string_view line);
void log_warning(std::string_view line);
void log_error(std::string_view line);

}  // namespace meshfarm
