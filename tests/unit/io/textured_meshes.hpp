// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <support/meshes.hpp>

#include <meshfarm/io/mesh_format.hpp>

#include "ply_test_files.hpp"

namespace meshfarm::test {

/// Pictures whose bytes are "bytes of NAME".
inline PictureFiles pictures_named(const std::vector<std::string>& names) {
  return {names, [names](std::size_t picture) { return "bytes of " + names.at(picture); }};
}

/// The square of k_square_vertices; vertex 1 has other texture coordinates in the second triangle.
inline Mesh textured_square() {
  Mesh mesh{k_square_vertices, k_square_triangles};
  mesh.columns.uvs = {{{{0, 0}, {0.5F, 0}, {0, 1}}}, {{{0, 1}, {0.625F, 1}, {1, 1.0F / 3}}}};
  mesh.columns.labels = {1, 2};
  return mesh;
}

/// Three materials, the first of which is unused.
inline MeshSinkOptions square_options() {
  MeshSinkOptions options;
  const LabelMeaning meaning{
      "material",
      {{.name = "unused", .maps = {{MapUse::colour, 3}}},
       {.name = "front",
        .maps = {{MapUse::colour, 0}, {MapUse::normal, 1}, {MapUse::metal_and_roughness, 3}}},
       {.name = "back",
        .colour = {1, 1, 1, 0.5F},
        .maps = {{MapUse::colour, 2}, {MapUse::occlusion, 3}, {MapUse::emission, 0}},
        .wrap_u = TextureWrap::clamp,
        .wrap_v = TextureWrap::clamp}}};
  options.labels = meaning;
  options.uvs = true;
  options.pictures =
      pictures_named({"maps/atlas.png", "bumps.jpg", "C:\\tex\\a b.png", "rough.png"});
  return options;
}

/// A grid with a picture over it, in one piece.
inline Mesh textured_grid(int width, int height) {
  Mesh mesh = grid(width, height);
  for (const Triangle& triangle : mesh.triangles) {
    CornerUvs uvs{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3 p = mesh.positions[triangle[corner]];
      uvs[corner] = {static_cast<float>(p.x) / 255, static_cast<float>(p.y) / 333};
    }
    mesh.columns.uvs.push_back(uvs);
  }
  return mesh;
}

/// Writes the mesh and its columns, in the format that the name implies.
inline void write_textured(const std::filesystem::path& path, const Mesh& mesh,
                           MeshSinkOptions options) {
  options.vertices = mesh.positions.size();
  options.triangles = mesh.triangles.size();
  const auto sink = create_mesh(path, options);
  sink->vertices(mesh.positions);
  sink->triangles(mesh.triangles, mesh.columns);
  sink->commit();
}

inline std::ptrdiff_t files_in(const TempFolder& folder) {
  return std::distance(std::filesystem::directory_iterator(folder.path()), {});
}

inline std::size_t lines_with(const std::string& text, std::string_view start) {
  std::istringstream lines(text);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line);) count += line.starts_with(start) ? 1 : 0;
  return count;
}

/// The texture coordinates of the corners of an OBJ's triangles.
inline std::vector<CornerUvs> uvs_of_obj(const std::string& text) {
  std::vector<Uv> uvs;
  std::vector<CornerUvs> made;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (word == "vt") {
      std::string u;
      std::string v;
      words >> u >> v;
      Uv uv{};
      std::from_chars(u.data(), u.data() + u.size(), uv[0]);
      std::from_chars(v.data(), v.data() + v.size(), uv[1]);
      uvs.push_back(uv);
    } else if (word == "f") {
      CornerUvs corners{};
      for (Uv& uv : corners) {
        words >> word;
        uv = uvs.at(std::stoul(word.substr(word.find('/') + 1)) - 1);
      }
      made.push_back(corners);
    }
  }
  return made;
}

}  // namespace meshfarm::test
