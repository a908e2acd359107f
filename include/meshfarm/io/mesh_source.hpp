// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/io/channel.hpp>
#include <meshfarm/io/labels.hpp>

namespace meshfarm {

/// Vertices that were merged although they were not at the same position.
struct NearMerges {
  double distance = 0;         // up to which they were; 0: none
  std::uint64_t vertices = 0;  // that were moved to the position of another
};

/// What a mesh file's header promises or a first count found, and how the reader interprets it.
struct MeshFileInfo {
  std::string format;       // "PLY ascii", "PLY binary little endian", ...
  std::string compression;  // "none", "gzip", "zstd"
  std::uint64_t vertices = 0;
  std::uint64_t faces = 0;  // polygons or strips, before they are split into triangles
  PositionType positions = PositionType::float32;
  std::vector<Channel> channels;       // of the vertices
  std::optional<LabelMeaning> labels;  // of the triangles
  bool uvs = false;                    // whether triangles have texture coordinates
  PictureFiles pictures;               // of the materials, with Textures::keep
  NearMerges near_merges;
  /// The columns that the triangles have.
  ColumnSet columns() const { return {labels.has_value(), uvs}; }
  std::vector<std::string> skipped;   // "face.flags", "material (5 elements)", "normals (120)"
  std::vector<std::string> textures;  // that the colours come from: "atlas.jpg (4096 x 4096)"
};

/// A mesh file that is read by scanning, any number of times, in memory that does not depend on its
/// size: plain files are read through a window, compressed ones (detected by content) are
/// decompressed on the fly. Where that is slow, vertices are kept between scans: 50 MB of them in
/// memory, more in a scratch file in $TMPDIR (or /tmp), of 12 or 24 bytes a vertex. Polygons are
/// split into triangles inside them, tristrips into theirs; a mesh without faces has no triangles.
/// Malformed input throws DataError with the place: element, index, byte (of the decompressed file)
/// or line. Only a scan of both vertices and triangles has seen the whole file.
class MeshSource {
 public:
  virtual ~MeshSource() = default;
  /// A text may have more digits than the floats that it is assumed to hold. A scan of all vertices
  /// finds this out: positions are float64 from then on. Scan again in that case.
  virtual const MeshFileInfo& info() const = 0;
  /// All vertices in file order, in batches. A vertex with a coordinate that is not finite comes as
  /// k_no_position; all others are finite.
  virtual void scan_vertices(const std::function<void(std::span<const Vec3>)>& take) = 0;
  /// All triangles in file order, in batches, with the columns that info() names. Every index is
  /// below info().vertices.
  virtual void scan_triangles(const std::function<void(const TriangleView&)>& take) = 0;
  /// All vertices in file order with their values of info().channels, in batches. Positions are
  /// those of scan_vertices.
  virtual void scan_channels(const std::function<void(const ChannelPoints&)>& take) {
    static_cast<void>(take);
  }
  /// How many faces had fewer than three corners and were left out by the last scan_triangles().
  virtual std::uint64_t small_faces() const { return 0; }
};

/// Whether vertices have colours.
bool has_appearances(const MeshSource& source);
/// All vertices in file order, in batches, with their appearances if they have any.
void scan_appearances(MeshSource& source, const std::function<void(const VertexView&)>& take);

/// How many times all vertices will be scanned: for one scan nothing is kept.
enum class Scans : std::uint8_t { one, many };

/// How textures are handled: `bake` gives their colours to the vertices, `drop` leaves them out,
/// `name` only looks at them to name them, and `keep` keeps them: triangles then have texture
/// coordinates, and labels that name the materials.
enum class Textures : std::uint8_t { bake, drop, name, keep };

struct OpenOptions {
  Scans scans = Scans::many;
  unsigned threads = 0;  // that parse text; 0: one per core
  bool channels = true;  // else they count as skipped
  bool labels = true;    // the same
  Textures textures = Textures::drop;
  std::uint64_t picture_bytes = 0;  // limit for one picture; 0: half of the free memory
};

/// Opens a mesh file by its content; for a damaged STL or an empty OBJ, the name counts, too. A
/// file whose header has no counts is read once to count, and one with textures to bake is scanned
/// for these, in memory for some of their pictures. Throws IoError, or DataError for an unknown
/// format, a malformed header, or one that claims more than the file can hold.
std::unique_ptr<MeshSource> open_mesh(const std::filesystem::path& path,
                                      const OpenOptions& options = {});

/// Reads a whole mesh into memory, with its triangles' columns, but without the triangles that use
/// a vertex without a position. Throws DataError if it has 2^32 vertices or more.
Mesh read_mesh(MeshSource& source);

}  // namespace meshfarm
