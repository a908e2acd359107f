// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace meshfarm {

// Files of src/report, compiled in by cmake/MeshfarmEmbed.cmake.
extern const std::string_view k_page_css;
extern const std::string_view k_page_js;
extern const std::string_view k_live_css;
extern const std::string_view k_live_js;
extern const std::string_view k_live_html;

}  // namespace meshfarm
