// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include "gltf_buffer.hpp"
#include "gltf_json.hpp"

namespace meshfarm {

/// Decompresses the buffer views of a document that EXT_meshopt_compression compressed. The first
/// 16 MiB are kept in memory, all that is more in one scratch file without a name in $TMPDIR (or
/// /tmp). While a view is made it is in memory, together with what it is made from.
class GltfMeshopt {
 public:
  /// Throws DataError for what is malformed or does not fit its view, and for more than 2 GiB.
  GltfBuffer decode(const GltfValue& view, const GltfValue& compression,
                    const GltfBuffer& compressed);

 private:
  std::uint64_t in_memory_ = 0;
  std::uint64_t in_scratch_ = 0;
  std::shared_ptr<const ScratchFile> scratch_;
};

}  // namespace meshfarm
