// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "byte_stream.hpp"
#include "gltf_buffer.hpp"
#include "gltf_json.hpp"
#include "gltf_meshopt.hpp"

namespace meshfarm {

/// The contents of a .glb or .gltf file.
struct GltfContainer {
  std::string format;  // "GLB", "glTF"
  std::string json;
  std::uint64_t json_start = 0;        // in the file
  std::shared_ptr<GltfBuffer> binary;  // of a .glb that has such a chunk
};

/// The largest JSON that is read; it is held in memory, where it takes a multiple of its size.
inline constexpr std::uint64_t k_most_gltf_json = std::uint64_t{64} << 20;

/// Whether the file begins like a .glb.
bool is_glb_file(const InputFile& file);
/// Whether the file is text and begins like a JSON object.
bool is_gltf_file(const InputFile& file);

/// A compressed .glb is copied to a scratch file without a name in $TMPDIR (or /tmp). Throws
/// DataError with the byte position for malformed input.
GltfContainer open_glb_container(const std::shared_ptr<const InputFile>& file);
GltfContainer open_gltf_container(const InputFile& file);

/// Decodes a URI; nothing if a '%' is not followed by two hexadecimal digits.
std::optional<std::string> decode_percents(std::string_view text);

/// The buffers of a document, opened when first needed: those of images may be missing. Only a few
/// of the files beside the document are open at a time.
class GltfBuffers {
 public:
  GltfBuffers(const std::filesystem::path& path, std::shared_ptr<const GltfBuffer> binary)
      : folder_(path.parent_path()),
        binary_(std::move(binary)),
        files_(std::make_shared<GltfFiles>()) {}

  /// A buffer view. Its buffer may lie in a file beside the document or in a "data:" URI; folders
  /// above and other hosts are refused. A view compressed by EXT_meshopt_compression is
  /// decompressed once. Throws IoError or DataError.
  std::shared_ptr<const GltfBuffer> open_view(const GltfValue& document, std::uint64_t index);
  /// The rows of an accessor, without gaps, if they come from elsewhere than its buffer view; else
  /// null.
  std::shared_ptr<const GltfBuffer> unpacked(std::uint64_t accessor) const;
  void keep_unpacked(std::uint64_t accessor, std::string bytes);
  /// The file beside the document, or the "data:" URI, that a value names.
  std::shared_ptr<const GltfBuffer> open_uri(const GltfValue& uri) const;

 private:
  std::shared_ptr<const GltfBuffer> open(const GltfValue& document, std::uint64_t index);
  std::shared_ptr<const GltfBuffer> open_buffer(const GltfValue& buffer, bool is_first) const;

  std::filesystem::path folder_;
  std::shared_ptr<const GltfBuffer> binary_;
  std::shared_ptr<GltfFiles> files_;
  GltfStore store_;
  std::map<std::uint64_t, std::shared_ptr<const GltfBuffer>> opened_;
  std::map<std::uint64_t, std::shared_ptr<const GltfBuffer>> views_;
  std::map<std::uint64_t, std::shared_ptr<const GltfBuffer>> unpacked_;
};

}  // namespace meshfarm
