// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include "gltf_buffer.hpp"
#include "gltf_json.hpp"

namespace meshfarm {

/// Decompresses a buffer view of a document that EXT_meshopt_compression compressed, and keeps it
/// in the store. While it is made it is in memory, together with what it is made from. Throws
/// DataError for what is malformed or does not fit its view, and for more than 2 GiB.
GltfBuffer decode_meshopt(const GltfValue& view, const GltfValue& compression,
                          const GltfBuffer& compressed, GltfStore& store);

}  // namespace meshfarm
