// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <meshfarm/io/labels.hpp>

#include "ply_channels.hpp"
#include "ply_header.hpp"
#include "scratch_array.hpp"
#include "texture_colours.hpp"

namespace meshfarm {

/// The textures that the header of a PLY declares.
struct PlyTextures {
  std::vector<std::string> files;  // of the pictures
  /// The faces' list of texture coordinates, or else the two properties of the vertices, which
  /// count only if there are pictures.
  std::optional<std::size_t> face_list;
  std::vector<PlyChannel> of_vertices;
  std::optional<std::size_t>
      numbers;  // the property of the faces that says which picture they have

  bool has_uvs() const { return face_list.has_value() || !of_vertices.empty(); }
};

PlyTextures find_ply_textures(const PlyHeader& header);

/// Makes one material per picture, and one for triangles without a picture. Pictures that are
/// missing or invalid are reported to `warn` and left out.
LabelMeaning keep_ply_pictures(const PlyTextures& textures, const std::filesystem::path& path,
                               const std::function<void(const std::string& line)>& warn,
                               PictureFiles& pictures);

/// Samples the colours that the textures give to vertices; `scan` gives all triangles with their
/// texture coordinates and the indices of their pictures. Null if none can be read.
struct PlySampling {
  const PlyTextures& textures;
  const std::filesystem::path& path;
  std::uint64_t vertices = 0;
  TextureColours::Plain plain = TextureColours::Plain::coloured;
  std::uint64_t picture_bytes = 0;
};
using PlyScan = std::function<void(const std::function<void(const TriangleView&)>& take)>;
std::unique_ptr<TextureColours> sample_ply_textures(const PlySampling& sampling,
                                                    const PlyScan& scan);

/// The pictures, to be described.
std::vector<TextureImage> ply_images(const PlyTextures& textures,
                                     const std::filesystem::path& path);

/// Triangles as they are read, with the texture coordinates of their vertices if they have none of
/// their own, and the indices of their pictures; those without a picture have the index after the
/// last.
class PlyTexturedBatch {
 public:
  explicit PlyTexturedBatch(const PlyTextures& textures) : textures_(textures) {}

  /// Adds those of all vertices, in order, before the first batch.
  void begin_vertices(std::uint64_t count) { places_ = ScratchArray<Uv>(count); }
  void add_vertices(const ChannelPoints& batch);
  bool has_vertices() const { return done_ > 0; }
  /// Valid until the next call.
  TriangleView of(const TriangleView& batch);

 private:
  const PlyTextures& textures_;
  ScratchArray<Uv> places_;
  std::uint64_t done_ = 0;
  std::vector<CornerUvs> uvs_;
  std::vector<Label> labels_;
};

}  // namespace meshfarm
