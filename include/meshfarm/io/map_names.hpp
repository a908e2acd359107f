// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <meshfarm/io/labels.hpp>

namespace meshfarm {

/// The kinds of pictures that materials have but that are not kept, as named to the user.
std::vector<std::string> maps_left_out(const LabelMeaning& labels,
                                       const std::function<bool(MapUse)>& is_kept);

}  // namespace meshfarm
