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

// What pages are made of.

std::string base64(std::string_view bytes);
/// An <img> that holds its file.
std::string html_of(const PagePicture& picture, std::string_view what);
/// With a caption; nothing where there is no picture.
std::string figure_of(const PagePicture& picture, std::string_view what, std::string_view caption);
/// A row of a table; of the cells markup is escaped.
std::string row_of(const std::vector<std::string>& cells, const char* tag = "td");
/// "#2a6fb8"
std::string css_of(const std::array<std::uint8_t, 3>& colour);

/// The tables of all figures. `summary`: of the run; an empty object if it has not ended.
std::string figure_tables(const RunPage& page, const Json& summary);
/// A count of a summary's, if it is known.
std::optional<std::uint64_t> count_of(const Json& of, const char* name);
/// What no point of either surface is farther from the other than, as a share of the diagonal;
/// nothing if that was not proven.
std::optional<double> proven_bound(const Json& summary);

}  // namespace meshfarm
