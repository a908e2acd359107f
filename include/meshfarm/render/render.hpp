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

/// What the colours of a surface show.
enum class ColourBy : std::uint8_t {
  automatic,  // the surface's own colours, if any
  none,
  colour,   // of the vertices or materials
  normal,   // the facing of triangles
  piece,    // connected components
  part,     // the parts of a stage
  label,    // the labels of triangles
  height,   // along the up axis
  quality,  // the first scalar channel
  channel   // a named channel
};

struct RenderOptions {
  std::string name = "the mesh";  // for messages
  std::uint32_t width = 1600;     // pixels
  std::uint32_t height = 1200;
  std::uint32_t samples = 2;  // per pixel and side
  View view;
  ColourBy colour_by = ColourBy::automatic;
  std::string channel;                         // with ColourBy::channel
  std::optional<std::array<double, 2>> range;  // of the colours of values; else all values
  bool wire = false;                           // also draw the triangles' edges
  bool quick = false;                          // coarser shading
  bool transparent = false;                    // where nothing is drawn; else the background
  std::array<std::uint8_t, 3> background{255, 255, 255};
  std::uint64_t memory_bytes = std::uint64_t{512} << 20;
  std::filesystem::path folder = ".";  // for scratch files
  unsigned threads = 0;                // 0: one per core; does not affect the picture
  /// Receives the current phase and the fraction done; may be empty.
  std::function<void(std::string_view phase, double done)> progress;
};

struct Rendering {
  Texels picture;
  std::uint64_t vertices = 0;
  std::uint64_t triangles = 0;                 // of the mesh, visible or not
  std::uint64_t not_finite = 0;                // triangles without a position, left out
  std::string colours;                         // what they show: a word or a channel's name
  std::optional<std::array<double, 2>> range;  // of the values, if colours show values
  std::uint64_t pieces = 0;                    // with ColourBy::piece
};

/// How to open a mesh's textures: their colours become those of the vertices.
Textures textures_for(const RenderOptions& options);

/// Throws UsageError for a picture that needs more than the allowed memory.
void check_canvas(const RenderOptions& options);

/// Draws a mesh of any size: vertices are projected once, into scratch files if they do not fit
/// into memory, and triangles are drawn as the source scans them. The same mesh gives the same
/// picture, whatever the memory, the threads and the order of its triangles. Throws DataError for a
/// mesh that has nothing to draw, or lacks the values to be coloured by, UsageError for a picture
/// that needs more than the allowed memory, or IoError.
Rendering render_mesh(MeshSource& source, const RenderOptions& options);

}  // namespace meshfarm
