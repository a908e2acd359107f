// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/report/run_page.hpp>

#include "report/json.hpp"

namespace meshfarm {

// Building blocks of pages.

std::string base64(std::string_view bytes);
/// An <img> with the file embedded.
std::string html_of(const PagePicture& picture, std::string_view what);
/// A figure with a caption; empty if there is no picture.
std::string figure_of(const PagePicture& picture, std::string_view what, std::string_view caption);
/// A table row; markup in cells is escaped.
std::string row_of(const std::vector<std::string>& cells, const char* tag = "td");
/// "#2a6fb8"
std::string css_of(const std::array<std::uint8_t, 3>& colour);

/// The tables of all figures. `summary`: the run's; an empty object if the run has not ended.
std::string figure_tables(const RunPage& page, const Json& summary);
/// A count in a summary, if known.
std::optional<std::uint64_t> count_of(const Json& of, const char* name);
/// The proven upper bound of the distance between the surfaces, as a fraction of the diagonal;
/// nothing if none was proven.
std::optional<double> proven_bound(const Json& summary);

}  // namespace meshfarm
