// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <meshfarm/geometry/sweep_order.hpp>
#include <meshfarm/util/bytes.hpp>

namespace meshfarm {

/// As encoded in the manifest and in a job's parameters: axes 3 x u8 | falling u8 |
/// weld u8 (0 exact, 1 off).
void put(ByteWriter& out, const Sorting& sorting);
Sorting get_sorting(ByteReader& in);

}  // namespace meshfarm
