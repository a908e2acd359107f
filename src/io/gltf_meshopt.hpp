// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include "gltf_buffer.hpp"
#include "gltf_json.hpp"

namespace meshfarm {

/// Decompresses a buffer view that EXT_meshopt_compression compressed, and keeps the result in the
/// store. Meanwhile both are in memory. Throws DataError for data that are malformed or do not fit
/// the view, and for more than 2 GiB.
GltfBuffer decode_meshopt(const GltfValue& view, const GltfValue& compression,
                          const GltfBuffer& compressed, GltfStore& store);

}  // namespace meshfarm
