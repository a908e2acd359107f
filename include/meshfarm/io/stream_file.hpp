// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/fill.hpp>
#include <meshfarm/io/part_file.hpp>

namespace meshfarm {

/// The head of a stream: a mesh file that is read once, front to back, in bounded memory (Xiong et
/// al. 2008, 4; streaming meshes: Isenburg & Lindstrom 2005).
struct StreamInfo {
  PositionType positions = PositionType::float32;
  bool appearances = false;  // whether vertices have them
  ColumnSet columns = {};    // of the triangles
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;
  std::uint32_t boundary_vertices = 0;  // shared with other streams
};

/// A mesh in sweep order, to be written as a stream.
struct StreamMesh {
  Mesh mesh;                           // every vertex is used by a triangle or is a boundary vertex
  std::vector<std::uint8_t> boundary;  // one flag per vertex
  PositionType positions = PositionType::float32;
};

/// The whole staged file: each vertex comes just before the first triangle that needs it or a later
/// vertex, and is marked at its last use. Positions must be exact in `stream.positions`. Throws
/// UsageError for 2^31 or more vertices.
std::string encode_stream(const StreamMesh& stream);

/// A vertex as a corner of a triangle: its number in the stream, and whether this is its last use.
struct StreamCorner {
  std::uint32_t code = 0;
  std::uint32_t vertex() const { return code >> 1; }
  bool last_use() const { return (code & 1) != 0; }
};

/// A piece of a stream: new vertices, then triangles of these and earlier ones.
struct StreamBlock {
  std::vector<Vec3> positions;  // of the next vertices
  std::vector<Appearance> appearances;
  /// The boundary vertices among these, ascending, by their index here; "last use" is set for those
  /// that no triangle uses.
  std::vector<StreamCorner> boundary;
  std::vector<std::array<StreamCorner, 3>> triangles;
  TriangleColumns columns;  // of the triangles
};

/// Reads a stream block by block. Holds one block, and a few bytes for each vertex from the oldest
/// one still in use. Throws DataError naming `what`, the block and the place for anything that
/// encode_stream did not make: a damaged or truncated file, a triangle of a vertex that is not
/// there yet or was already finalised, a vertex that is never finalised.
class StreamReader {
 public:
  StreamReader(Fill fill, std::string what);
  const StreamInfo& info() const { return info_; }
  /// The next block, checked; false after the last.
  bool next(StreamBlock& block);

 private:
  void read_head();
  void add_vertices(const StreamBlock& block);
  void finish(std::uint64_t vertex);
  void finish_corners(const std::array<StreamCorner, 3>& triangle, std::size_t index);
  void forget_finished();
  void check_end() const;
  [[noreturn]] void fail(const std::string& why) const;

  Fill fill_;
  std::string what_;
  StreamInfo info_;
  std::string bytes_;
  std::uint64_t sum_ = 0;         // of what was read, each block's computed from the previous one
  std::uint64_t block_ = 0;       // blocks read
  std::uint64_t vertices_ = 0;    // read so far
  std::uint64_t triangles_ = 0;   // read so far
  std::uint64_t boundary_ = 0;    // read so far
  std::uint64_t unfinished_ = 0;  // vertices still in use
  std::uint64_t first_state_ = 0;
  std::vector<std::uint8_t> states_;  // of vertices from first_state_ on: finished or not
};

/// Whether a file begins like a stream.
bool is_stream(std::string_view start);

/// Reads the whole stream into memory: the mesh given to encode_stream.
StreamMesh read_stream_mesh(StreamReader& reader);
/// Reads the whole stream into memory as a part, its boundary vertices first.
Part read_stream(StreamReader& reader);
/// Decodes a whole staged file that is a part, or a stream as a part. Throws DataError as their
/// readers do.
Part decode_part_or_stream(std::string_view file, const std::string& what);

}  // namespace meshfarm
