// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/io/labels.hpp>
#include <meshfarm/io/tiled_picture.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

/// More than any mesh's textures.
inline constexpr std::uint32_t k_most_pictures = 65'536;

/// Which of a mesh's pictures are for the colours of its materials.
std::vector<bool> colour_pictures(const LabelMeaning& labels, std::size_t pictures);

/// What the materials of a mesh look like at texture coordinates: their pictures, decoded, each
/// with smaller copies of itself. Safe to ask from several threads.
class MaterialColours {
 public:
  struct Options {
    std::string name;                // of the mesh, for messages
    std::uint64_t memory_bytes = 0;  // most that the pictures may take; 0: half of what is free
  };
  /// A picture that is damaged is named in a warning, and what it covers has its material's colour
  /// alone. Throws DataError if the pictures take more memory than they may.
  MaterialColours(const LabelMeaning& labels, const PictureFiles& pictures, const Options& options);
  /// The same of pictures that a stage has as tiles, which are read when they are looked at. What
  /// is in no file is as a damaged one. The tiles in memory take `memory_bytes`. Throws DataError,
  /// UnreadIoError, also when it is asked.
  MaterialColours(const LabelMeaning& labels, const Stage& stage,
                  std::span<const TiledPicturesRef> files, std::uint64_t memory_bytes);
  ~MaterialColours();
  MaterialColours(MaterialColours&&) noexcept;

  /// Linear red, green and blue, from 0 to 1, at a place of a label's material. `texels`: of the
  /// picture's a side of what is to have the colour; beyond 1 a smaller copy of the picture is
  /// looked at.
  std::array<float, 3> at(Label label, Uv uv, double texels) const;
  /// The texels that a triangle with these corners covers.
  double texels_of(Label label, const CornerUvs& uvs) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The level from 0 to 1 of sRGB that pictures have for a linear one.
double srgb_level(double linear);

/// A square picture of red, green and blue levels, row by row from the top, as a file.
enum class PictureCoding : std::uint8_t { png, jpeg };
std::string encoded_picture(std::uint32_t side, std::vector<std::uint8_t> texels,
                            PictureCoding coding);

}  // namespace meshfarm
