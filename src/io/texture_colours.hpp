// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "scratch_array.hpp"
#include "texture.hpp"

namespace meshfarm {

/// A picture named by materials.
struct TextureImage {
  std::string name;  // for messages
  /// All of the file's bytes. Throws Error if there is no such file.
  std::function<std::string()> load;
};

/// What colours a triangle. Places are transformed first: u' = u a[0] + v a[1] + a[2], and v'
/// likewise by b.
struct TextureMaterial {
  static constexpr std::size_t k_no_image = std::numeric_limits<std::size_t>::max();

  std::size_t image = k_no_image;
  LinearColour factor{1, 1, 1};  // multiplies the image
  LinearColour plain{1, 1, 1};   // the colour without a readable image
  TextureWrap wrap_u = TextureWrap::repeat;
  TextureWrap wrap_v = TextureWrap::repeat;
  std::array<double, 3> a{1, 0, 0};
  std::array<double, 3> b{0, 1, 0};

  bool has_image() const { return image != k_no_image; }
  TexturePoint mapped(TexturePoint p) const {
    return {p.u * a[0] + p.v * a[1] + a[2], p.u * b[0] + p.v * b[1] + b[2]};
  }
};

/// A triangle with the vertices that get its colours.
struct TexturedTriangle {
  std::array<std::uint64_t, 3> vertices{};
  std::array<TexturePoint, 3> places{};
};

/// The colours that textures give to vertices: the mean over a vertex's thirds of its triangles
/// (texture.hpp), weighted by their areas in texels. So both sides of a seam count.
class TextureColours {
 public:
  TextureColours(std::uint64_t vertices, std::string path)
      : sums_(vertices), path_(std::move(path)) {}

  /// Samples the pictures of the materials. `scan(is_wanted, add)` is called several times; it must
  /// call `add(triangle, material)` for all triangles, in the same order each time, at least for
  /// materials with `is_wanted(material)`. As many pictures are decoded at a time as the options
  /// allow; the grouping depends on nothing else. A missing or damaged picture is named in a
  /// warning, and its materials have none. Throws DataError for a picture that takes more memory
  /// than allowed. Returns how many pictures were sampled; if none, no colours are made.
  using IsWanted = std::function<bool(std::size_t material)>;
  using Add = std::function<void(const TexturedTriangle& triangle, std::size_t material)>;
  using Scan = std::function<void(const IsWanted& is_wanted, const Add& add)>;
  /// Whether triangles without a picture give vertices their material's plain colour.
  enum class Plain : std::uint8_t { coloured, left };
  struct Options {
    Plain plain = Plain::coloured;
    std::uint64_t memory_bytes = std::uint64_t{512} << 20;  // of the pictures at a time; at least 1
    std::uint64_t picture_bytes = 0;  // limit for one picture; 0: half of the free memory
  };
  std::size_t sample(std::vector<TextureImage> images, std::vector<TextureMaterial> materials,
                     const Options& options, const Scan& scan);

  /// The colour of a vertex; nothing if no triangle gave it one.
  std::optional<LinearColour> of(std::uint64_t vertex) {
    sums_.used(1);
    const Sum& sum = sums_.items()[vertex];
    if (!(sum.weight > 0)) return std::nullopt;
    return LinearColour{sum.colour[0] / sum.weight, sum.colour[1] / sum.weight,
                        sum.colour[2] / sum.weight};
  }

 private:
  struct Sum {
    LinearColour colour{};
    float weight = 0;
  };
  void add(const TexturedTriangle& triangle, const TextureMaterial& material,
           const Picture* picture);

  ScratchArray<Sum> sums_;
  std::string path_;
};

/// How to report a picture that cannot be read: with the reason, or not at all.
enum class LostPictures : std::uint8_t { told, left };

/// Describes pictures for the user: "atlas.jpg (4096 x 4096)".
std::vector<std::string> describe(const std::vector<TextureImage>& images, LostPictures lost);

}  // namespace meshfarm
