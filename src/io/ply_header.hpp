// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/mesh.hpp>

#include "ply_types.hpp"

namespace meshfarm {

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  std::optional<PlyType> count_type;  // of a list

  bool is_list() const { return count_type.has_value(); }
};

/// What the reader does with an element.
enum class PlyRole : std::uint8_t { other, vertices, faces, strips };

/// How to treat a line of text that has more values than are declared.
enum class MoreValues : std::uint8_t {
  odd,   // it is reported, with the line
  told,  // it is reported that they are not read
  known  // it is expected
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  PlyRole role = PlyRole::other;
  std::array<std::size_t, 3> axes{};  // of vertices: the properties x, y, z
  std::size_t index_list = 0;         // of faces and strips: the property with the corners
  std::optional<std::size_t> label;   // of faces: the property that is read as their label
  std::optional<std::size_t> uvs;     // of faces: the list of texture coordinates, if it is read
  MoreValues more = MoreValues::odd;

  bool has_late_label() const { return label && *label > index_list; }
  bool has_lists() const;
  /// Bytes of a record in a file; with lists or as text, the minimum.
  std::uint64_t record_bytes(PlyFormat format) const;
};

/// The type that holds the coordinates of these vertices exactly.
PositionType position_type_of(const PlyElement& vertices);

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::uint64_t size_bytes = 0;
  std::uint64_t lines = 0;
  char line_end = '\n';
  bool has_comments = false;               // from '#' to the end of the line, in the body too
  std::vector<std::string> texture_files;  // from comments that name them
  std::string title;                       // of a format that is read like PLY, but is not PLY
  std::vector<std::string> oddities;       // tolerated oddities; each a line for the user

  const PlyElement& vertices() const;
};

/// Whether the bytes start like a PLY file.
bool is_ply(std::string_view start);

/// Parses the header at the beginning of `start`, the first bytes of the file or all of it, and
/// finds the vertices and faces in it. Throws DataError naming `path` and the line.
PlyHeader parse_ply_header(std::string_view start, const std::filesystem::path& path);

}  // namespace meshfarm
