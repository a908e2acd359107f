// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace meshfarm {

/// A page that shows what "status.json" beside it tells, render(StatusFacts, Format::json), and
/// asks for it again every second. It loads nothing else.
std::string render_live_page();

}  // namespace meshfarm
