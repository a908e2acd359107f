// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>

namespace meshfarm {

/// From the first call on, SIGINT, SIGTERM and SIGHUP set this flag instead of ending the process;
/// a second SIGINT ends it at once.
const std::atomic<bool>& stop_on_signals();

}  // namespace meshfarm
