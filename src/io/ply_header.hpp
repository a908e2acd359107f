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

/// What it means that a line of text has more values than are declared.
enum class MoreValues : std::uint8_t {
  odd,   // it is told, with the line
  told,  // it is told that they are not read
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
  /// Bytes that a record takes in a file; with lists or as text, the fewest it can take.
  std::uint64_t record_bytes(PlyFormat format) const;
};

/// What holds the coordinates of these vertices exactly.
PositionType position_type_of(const PlyElement& vertices);

struct PlyHeader {
  PlyFormat format = PlyFormat::ascii;
  std::vector<PlyElement> elements;
  std::uint64_t size_bytes = 0;
  std::uint64_t lines = 0;
  char line_end = '\n';
  bool has_comments = false;               // text from '#' to the end of the line, in the body too
  std::vector<std::string> texture_files;  // of comments that name some
  std::string title;                       // of what is read like a PLY file, but is none
  std::vector<std::string> oddities;       // what was let pass; each a line for the user

  const PlyElement& vertices() const;
};

/// Whether the bytes start like a PLY file.
bool is_ply(std::string_view start);

/// Parses the header that `start`, the first bytes of the file or all of it, begins with, and finds
/// the vertices and faces in it. Throws DataError naming `path` and the line.
PlyHeader parse_ply_header(std::string_view start, const std::filesystem::path& path);

}  // namespace meshfarm
