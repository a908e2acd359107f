// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include <meshfarm/io/mesh_source.hpp>

#include "byte_stream.hpp"
#include "ply_channels.hpp"
#include "ply_header.hpp"
#include "triangle_maker.hpp"

namespace meshfarm {

inline CornerOrder corner_order(const PlyElement& element) {
  return element.role == PlyRole::strips ? CornerOrder::strip : CornerOrder::face;
}

/// The data after the header, read element by element in the file's order. Malformed records throw
/// DataError naming file, element, index and place.
class PlyBody {
 public:
  virtual ~PlyBody() = default;
  virtual void read_vertices(const PlyElement& element, Batch<Vec3>& batch) = 0;
  /// With the values of some properties, none of which is a list.
  virtual void read_channels(const PlyElement& element, std::span<const PlyChannel> channels,
                             ChannelBatch& batch) = 0;
  virtual void read_corners(const PlyElement& element, TriangleMaker& maker) = 0;
  virtual void skip(const PlyElement& element) = 0;
  /// After the last element: whether nothing follows (in ascii: only blanks).
  virtual bool at_end() = 0;
  /// Whether ascii floats with more digits than a float holds were read.
  virtual bool has_lost_digits() const = 0;
  /// The oddity tolerated since the last call: a line for the user, or nothing.
  virtual std::string take_oddity() = 0;
};

/// How the text of float properties is read.
enum class AsciiFloats : std::uint8_t { as_floats, as_doubles };

struct AsciiOptions {
  AsciiFloats floats = AsciiFloats::as_floats;
  unsigned threads = 1;  // 0: one per core
  bool has_comments = false;
};

/// `stream` must be at the first byte after the header; `path` must outlive the body.
std::unique_ptr<PlyBody> make_binary_body(std::unique_ptr<ByteStream> stream,
                                          const std::filesystem::path& path,
                                          const PlyHeader& header);
std::unique_ptr<PlyBody> make_ascii_body(std::unique_ptr<ByteStream> stream,
                                         const std::filesystem::path& path, const PlyHeader& header,
                                         const AsciiOptions& options);

}  // namespace meshfarm
