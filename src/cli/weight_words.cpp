// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/weight_words.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

double parse_weight(std::string_view text, std::string_view name) {
  constexpr double k_least = 1e-6;
  double weight = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), weight);
  const bool is_number = error == std::errc{} && end == text.data() + text.size();
  if (is_number && (weight == 0 || (weight >= k_least && weight <= 1))) return weight;
  throw UsageError("--weight " + std::string(name) +
                   " must be 0 (the shape alone counts) or 0.000001 to 1, not '" +
                   std::string(text) + "'");
}

}  // namespace

std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

void parse_weights(const std::string& text, RunOptions& run) {
  for (std::string_view left = text; !left.empty();) {
    const std::string_view one = left.substr(0, left.find(','));
    left.remove_prefix(std::min(left.size(), one.size() + 1));
    const std::size_t equals = one.find('=');
    const std::string_view name = one.substr(0, equals);
    if (equals == std::string_view::npos || (name != "colour" && name != "uv")) {
      throw UsageError("--weight is 'colour=W', 'uv=W' or both with a comma between them, not '" +
                       text + "'");
    }
    double& weight = name == "uv" ? run.uv_weight : run.colour_weight;
    weight = parse_weight(one.substr(equals + 1), name);
  }
}

std::string weight_words(const RunOptions& run) {
  std::string words;
  if (run.colour_weight != k_colour_weight) words = "colour=" + shortest(run.colour_weight);
  if (run.uv_weight != k_uv_weight) {
    words += (words.empty() ? "uv=" : ",uv=") + shortest(run.uv_weight);
  }
  return words;
}

}  // namespace meshfarm
