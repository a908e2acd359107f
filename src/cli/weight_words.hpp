// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <meshfarm/pipeline/run_options.hpp>

namespace meshfarm {

/// --weight: how much what a surface shows counts beside its shape, as in "colour=0.01,uv=0".
inline constexpr const char* k_weight_help =
    "how much colours and textures count beside the shape, for example colour=0.01: black for "
    "white is as bad as moving the surface by this share of the diagonal (default: 0.002); uv=0.2: "
    "shifting a texture by a length is as bad as moving the surface by this share of that length "
    "(default: 0.1); 0: not at all";

/// The shortest text that reads back as the same number.
std::string shortest(double value);

/// Throws UsageError.
void parse_weights(const std::string& text, RunOptions& run);
/// The text for parse_weights(); empty if all weights are the default.
std::string weight_words(const RunOptions& run);

}  // namespace meshfarm
