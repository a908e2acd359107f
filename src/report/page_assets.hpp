// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace meshfarm {

// src/report/page.css and page.js, compiled in by cmake/MeshfarmEmbed.cmake.
extern const std::string_view k_page_css;
extern const std::string_view k_page_js;

}  // namespace meshfarm
