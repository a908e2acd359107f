// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/io/png_file.hpp>
#include <meshfarm/render/camera.hpp>

namespace meshfarm {

/// What the colours of a surface tell.
enum class ColourBy : std::uint8_t {
  automatic,  // its own colours, if it has any
  none,
  colour,   // of the vertices, or of the materials
  normal,   // which way triangles face
  piece,    // what is connected
  part,     // what a stage is divided into
  label,    // what triangles belong to
  height,   // along the axis that is up
  quality,  // the first channel that is a number of its own
  channel   // one that is named
};

struct RenderOptions {
  std::string name = "the mesh";  // for messages
  std::uint32_t width = 1600;     // pixels
  std::uint32_t height = 1200;
  std::uint32_t samples = 2;  // of each pixel, a side
  View view;
  ColourBy colour_by = ColourBy::automatic;
  std::string channel;                         // with ColourBy::channel
  std::optional<std::array<double, 2>> range;  // of the colours of values; else all values
  bool wire = false;                           // draw the triangles' edges, too
  bool quick = false;                          // shade it less finely
  bool transparent = false;                    // where nothing is; else the background
  std::array<std::uint8_t, 3> background{255, 255, 255};
  std::uint64_t memory_bytes = std::uint64_t{512} << 20;
  std::filesystem::path folder = ".";  // for scratch files
  unsigned threads = 0;                // 0: one a core; no picture depends on it
  /// Told what is being done and how much of it; may be empty.
  std::function<void(std::string_view phase, double done)> progress;
};

struct Rendering {
  Texels picture;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;                 // of the mesh, seen or not
  std::uint64_t not_finite = 0;                // those without a place, left out
  std::string colours;                         // what they tell, as a word or a channel's name
  std::optional<std::array<double, 2>> range;  // of the values, if colours are by one
  std::uint64_t pieces = 0;                    // with ColourBy::piece
};

/// Which textures to open a mesh with: their colours are those of the vertices.
Textures textures_for(const RenderOptions& options);

/// Throws UsageError for a picture that takes more than the memory.
void check_canvas(const RenderOptions& options);

/// Draws a mesh of any size: vertices are projected once, into scratch files where they do not fit,
/// and triangles come as the source scans them. The same mesh gives the same picture, whatever the
/// memory, the threads and the order of its triangles. Throws DataError for a mesh that has nothing
/// to draw, or not what it is to be coloured by, UsageError for a picture that takes more than the
/// memory, or IoError.
Rendering render_mesh(MeshSource& source, const RenderOptions& options);

}  // namespace meshfarm
