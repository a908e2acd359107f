// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace meshfarm {

/// A page that shows "status.json" beside it, the output of render(StatusFacts, Format::json), and
/// reloads it every second. It loads nothing else.
std::string render_live_page();

}  // namespace meshfarm
