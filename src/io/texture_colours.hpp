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

/// A picture that materials name.
struct TextureImage {
  std::string name;  // for messages
  /// All of the file's bytes. Throws Error where there is no such file.
  std::function<std::string()> load;
};

/// What colours a triangle. Places are mapped first: u a[0] + v a[1] + a[2], and so v by b.
struct TextureMaterial {
  static constexpr std::size_t k_no_image = std::numeric_limits<std::size_t>::max();

  std::size_t image = k_no_image;
  LinearColour factor{1, 1, 1};  // of the image
  LinearColour plain{1, 1, 1};   // the colour where there is no image, or none that can be read
  TextureWrap wrap_u = TextureWrap::repeat;
  TextureWrap wrap_v = TextureWrap::repeat;
  std::array<double, 3> a{1, 0, 0};
  std::array<double, 3> b{0, 1, 0};

  bool has_image() const { return image != k_no_image; }
  TexturePoint mapped(TexturePoint p) const {
    return {p.u * a[0] + p.v * a[1] + a[2], p.u * b[0] + p.v * b[1] + b[2]};
  }
};

/// A triangle by the vertices that its colours go to.
struct TexturedTriangle {
  std::array<std::uint64_t, 3> vertices{};
  std::array<TexturePoint, 3> places{};
};

/// The colours that textures give to vertices: of each the mean over its thirds of its triangles
/// (texture.hpp), by their areas in texels. So what is on both sides of a seam counts.
class TextureColours {
 public:
  TextureColours(std::uint64_t vertices, std::string path)
      : sums_(vertices), path_(std::move(path)) {}

  /// Samples the pictures of the materials. `scan(is_wanted, add)` is called some times; it calls
  /// `add(triangle, material)` for all triangles, in the same order each time, at least those of
  /// materials for which `is_wanted(material)`. Pictures are decoded as many at a time as the
  /// options allow; which ones are together depends on nothing else. One that is missing or damaged
  /// is named in a warning, and its materials have none. Throws DataError for one that takes more
  /// memory than it may. Returns how many pictures were sampled; if none, no colours are
  /// made.
  using IsWanted = std::function<bool(std::size_t material)>;
  using Add = std::function<void(const TexturedTriangle& triangle, std::size_t material)>;
  using Scan = std::function<void(const IsWanted& is_wanted, const Add& add)>;
  /// Whether triangles without a picture give vertices their material's plain colour.
  enum class Plain : std::uint8_t { coloured, left };
  struct Options {
    Plain plain = Plain::coloured;
    std::uint64_t memory_bytes = std::uint64_t{512} << 20;  // of the pictures at a time; at least 1
    std::uint64_t picture_bytes = 0;  // most that a picture may take; 0: half of the free memory
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

/// What to tell of a picture that cannot be read: why, or nothing of it at all.
enum class LostPictures : std::uint8_t { told, left };

/// Pictures as words for the user: "atlas.jpg (4096 x 4096)".
std::vector<std::string> describe(const std::vector<TextureImage>& images, LostPictures lost);

}  // namespace meshfarm
