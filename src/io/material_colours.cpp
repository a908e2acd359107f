// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <meshfarm/geometry/uv_facts.hpp>
#include <meshfarm/io/material_colours.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>
#include <meshfarm/util/memory.hpp>

#include "io/picture.hpp"
#include "io/picture_levels.hpp"
#include "io/picture_writer.hpp"
#include "io/srgb.hpp"
#include "io/tiled_levels.hpp"

namespace meshfarm {
namespace {

using Linear = std::array<float, 3>;

/// The equivalent place between 0 and 1.
double wrapped(double x, TextureWrap wrap) {
  if (!std::isfinite(x)) return 0;
  if (wrap == TextureWrap::clamp) return std::clamp(x, 0.0, 1.0);
  const double whole = std::floor(x);
  const double rest = x - whole;
  const bool is_mirrored = wrap == TextureWrap::mirror && std::fmod(whole, 2) != 0;
  return is_mirrored ? 1 - rest : rest;
}

/// The texels on both sides of a place along one axis of a picture, and the weight of the second.
struct Between {
  std::uint32_t first;
  std::uint32_t second;
  float share;
};

Between between(double place, std::uint32_t size, TextureWrap wrap) {
  const double x = place * size - 0.5;
  const double below = std::floor(x);
  const auto texel = [&](double at) {
    const double last = static_cast<double>(size) - 1;
    if (wrap == TextureWrap::repeat) at = at < 0 ? last : at > last ? 0 : at;
    return static_cast<std::uint32_t>(std::clamp(at, 0.0, last));
  };
  return {texel(below), texel(below + 1), static_cast<float>(x - below)};
}

/// The colour of a picture; `texels` as in MaterialColours::at.
Linear looked_up(const PictureLevels& picture, const Material& material, Uv uv, double texels) {
  const std::vector<LevelSize>& sizes = picture.sizes();
  std::size_t level = 0;
  for (double side = 2; side <= texels && level + 1 < sizes.size(); side *= 2) ++level;
  const double u = wrapped(static_cast<double>(uv[0]), material.wrap_u);
  const double v = wrapped(1 - static_cast<double>(uv[1]), material.wrap_v);
  const Between x = between(u, sizes[level].width, material.wrap_u);
  const Between y = between(v, sizes[level].height, material.wrap_v);
  const auto four = picture.texels(level, x.first, y.first, x.second, y.second);
  const auto& linear = linear_floats();
  Linear made{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto level_of = [&](std::size_t i) { return linear[four[i][c]]; };
    const float above = level_of(0) + x.share * (level_of(1) - level_of(0));
    const float below = level_of(2) + x.share * (level_of(3) - level_of(2));
    made[c] = above + y.share * (below - above);
  }
  return made;
}

std::size_t colour_map(const Material& material) {
  for (const MaterialMap& map : material.maps) {
    if (map.use == MapUse::colour) return map.picture;
  }
  return SIZE_MAX;
}

}  // namespace

class MaterialColours::Impl {
 public:
  Impl(const LabelMeaning& labels, const PictureFiles& pictures, const Options& options)
      : Impl(labels, pictures.names.size()) {
    const std::vector<bool> is_used = colour_pictures(labels, pictures_.size());
    const std::uint64_t most = most_bytes(options);
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < pictures_.size(); ++i) {
      if (!is_used[i]) continue;
      bool fits = true;
      try {
        fits = decode(i, pictures.load(i), bytes, most);
      } catch (const DataError& error) {
        log_warning(options.name + ": the texture " + pictures.names[i] + ": " + error.what() +
                    "; what it covers has no colour of it");
      }
      if (fits) continue;
      throw DataError(options.name + ": its textures take more than the " +
                      std::to_string(most >> 20) +
                      " MiB of memory that they may take, half of what is free: leave them out "
                      "with --uv drop");
    }
  }

  Impl(const LabelMeaning& labels, const Stage& stage, std::span<const TiledPicturesRef> files,
       std::uint64_t memory_bytes)
      : Impl(labels, std::size_t{0}) {
    const auto cache = std::make_shared<TileCache>(memory_bytes);
    for (const TiledPicturesRef& file : files) {
      for (auto& picture : open_tiled_pictures(stage, file, cache)) {
        const std::uint32_t number = picture->number();
        if (number >= k_most_pictures) {
          throw DataError(file.file.name + ": a picture of an impossible number");
        }
        if (number >= pictures_.size()) pictures_.resize(number + std::size_t{1});
        pictures_[number] = std::move(picture);
      }
    }
  }

  Linear at(Label label, Uv uv, double texels) const {
    if (label >= materials_.size()) return {1, 1, 1};
    const Material& material = materials_[label];
    const PictureLevels* const picture = picture_at(label);
    Linear colour{1, 1, 1};
    if (picture != nullptr) colour = looked_up(*picture, material, uv, texels);
    for (std::size_t c = 0; c < 3; ++c) colour[c] *= material.colour[c];
    return colour;
  }

  double texels_of(Label label, const CornerUvs& uvs) const {
    const PictureLevels* const picture = picture_at(label);
    if (picture == nullptr) return 0;
    const LevelSize size = picture->sizes()[0];
    return uv_area(uvs) * size.width * size.height;
  }

 private:
  Impl(const LabelMeaning& labels, std::size_t pictures)
      : materials_(labels.materials), pictures_(pictures) {
    for (const Material& material : materials_) picture_of_.push_back(colour_map(material));
  }

  static std::uint64_t most_bytes(const Options& options) {
    if (options.memory_bytes != 0) return options.memory_bytes;
    const std::optional<MemoryRoom> room = available_memory();
    return room ? room->bytes / 2 : UINT64_MAX;
  }

  /// False if it would take too much memory.
  bool decode(std::size_t picture, std::string file, std::uint64_t& bytes, std::uint64_t most) {
    const PictureHead head = read_picture_head(file);
    // Three bytes per texel, a third of that for the smaller copies; and the memory for decoding.
    const std::uint64_t kept = std::uint64_t{4} * head.width * head.height;
    if (bytes + kept + head.memory_bytes() > most) return false;
    pictures_[picture] = std::make_unique<DecodedLevels>(decode_picture(std::move(file)));
    bytes += kept;
    return true;
  }

  const PictureLevels* picture_at(Label label) const {
    const std::size_t picture = label < picture_of_.size() ? picture_of_[label] : SIZE_MAX;
    return picture < pictures_.size() ? pictures_[picture].get() : nullptr;
  }

  std::vector<Material> materials_;
  std::vector<std::size_t> picture_of_;                   // of each material
  std::vector<std::unique_ptr<PictureLevels>> pictures_;  // null where there is none to use
};

std::vector<bool> colour_pictures(const LabelMeaning& labels, std::size_t pictures) {
  std::vector<bool> is_used(pictures);
  for (const Material& material : labels.materials) {
    const std::size_t picture = colour_map(material);
    if (picture < pictures) is_used[picture] = true;
  }
  return is_used;
}

MaterialColours::MaterialColours(const LabelMeaning& labels, const PictureFiles& pictures,
                                 const Options& options)
    : impl_(std::make_unique<Impl>(labels, pictures, options)) {}
MaterialColours::MaterialColours(const LabelMeaning& labels, const Stage& stage,
                                 std::span<const TiledPicturesRef> files,
                                 std::uint64_t memory_bytes)
    : impl_(std::make_unique<Impl>(labels, stage, files, memory_bytes)) {}
MaterialColours::~MaterialColours() = default;
MaterialColours::MaterialColours(MaterialColours&&) noexcept = default;

std::array<float, 3> MaterialColours::at(Label label, Uv uv, double texels) const {
  return impl_->at(label, uv, texels);
}

double MaterialColours::texels_of(Label label, const CornerUvs& uvs) const {
  return impl_->texels_of(label, uvs);
}

double srgb_level(double linear) {
  return srgb_of_linear(linear);
}

std::string encoded_picture(std::uint32_t side, std::vector<std::uint8_t> texels,
                            PictureCoding coding) {
  const Picture picture{side, side, 3, std::move(texels), {}};
  return coding == PictureCoding::png ? encode_png(picture) : encode_jpeg(picture);
}

}  // namespace meshfarm
