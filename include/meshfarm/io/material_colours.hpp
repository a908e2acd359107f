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

/// More than any mesh has.
inline constexpr std::uint32_t k_most_pictures = 65'536;

/// Which of a mesh's pictures are for the colours of its materials.
std::vector<bool> colour_pictures(const LabelMeaning& labels, std::size_t pictures);

/// The colours of a mesh's materials at texture coordinates: their decoded pictures, each with
/// smaller copies. Thread-safe.
class MaterialColours {
 public:
  struct Options {
    std::string name;                // of the mesh, for messages
    std::uint64_t memory_bytes = 0;  // limit for the pictures; 0: half of the free memory
  };
  /// A damaged picture is named in a warning, and the surface it covers has only its material's
  /// colour. Throws DataError if the pictures take more memory than allowed.
  MaterialColours(const LabelMeaning& labels, const PictureFiles& pictures, const Options& options);
  /// The same for pictures that a stage holds as tiles, which are read when they are needed. A
  /// picture that is in no file is treated as damaged. The tiles in memory take up to
  /// `memory_bytes`. Throws DataError or UnreadIoError, also from the lookups.
  MaterialColours(const LabelMeaning& labels, const Stage& stage,
                  std::span<const TiledPicturesRef> files, std::uint64_t memory_bytes);
  ~MaterialColours();
  MaterialColours(MaterialColours&&) noexcept;

  /// Linear red, green and blue, from 0 to 1, at a place of a label's material. `texels`: the side,
  /// in texels of the picture, of what is to get the colour; above 1 a smaller copy of the picture
  /// is used.
  std::array<float, 3> at(Label label, Uv uv, double texels) const;
  /// The number of texels that a triangle with these corners covers.
  double texels_of(Label label, const CornerUvs& uvs) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// The sRGB level, as in pictures, of a linear level; both from 0 to 1.
double srgb_level(double linear);

/// A square picture of red, green and blue levels, row by row from the top, as a file.
enum class PictureCoding : std::uint8_t { png, jpeg };
std::string encoded_picture(std::uint32_t side, std::vector<std::uint8_t> texels,
                            PictureCoding coding);

}  // namespace meshfarm
