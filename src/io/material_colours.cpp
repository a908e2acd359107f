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

#include "picture.hpp"
#include "picture_writer.hpp"
#include "srgb.hpp"

namespace meshfarm {
namespace {

using Linear = std::array<float, 3>;

/// sRGB levels, three a texel, row by row from the top.
struct Level {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> texels;

  Linear texel(std::uint32_t x, std::uint32_t y) const {
    const std::uint8_t* const at = texels.data() + 3 * (std::size_t{y} * width + x);
    const auto& linear = linear_floats();
    return {linear[at[0]], linear[at[1]], linear[at[2]]};
  }
};

Level first_level(const Picture& picture) {
  Level level{picture.width, picture.height, {}};
  level.texels.resize(3 * std::size_t{picture.width} * picture.height);
  std::uint8_t* out = level.texels.data();
  for (std::uint32_t y = 0; y < picture.height; ++y) {
    const std::uint8_t* in = picture.row(y);
    for (std::uint32_t x = 0; x < picture.width; ++x, in += picture.step, out += 3) {
      std::copy_n(in, 3, out);
    }
  }
  return level;
}

/// Half as large each way, each texel the mean of up to four.
Level half_of(const Level& from) {
  Level to{(from.width + 1) / 2, (from.height + 1) / 2, {}};
  to.texels.resize(3 * std::size_t{to.width} * to.height);
  std::size_t next = 0;
  for (std::uint32_t y = 0; y < to.height; ++y) {
    for (std::uint32_t x = 0; x < to.width; ++x) {
      const std::uint32_t right = std::min(2 * x + 1, from.width - 1);
      const std::uint32_t below = std::min(2 * y + 1, from.height - 1);
      const std::array<Linear, 4> four = {from.texel(2 * x, 2 * y), from.texel(right, 2 * y),
                                          from.texel(2 * x, below), from.texel(right, below)};
      for (std::size_t c = 0; c < 3; ++c) {
        const float sum = (four[0][c] + four[1][c]) + (four[2][c] + four[3][c]);
        const double level = srgb_of_linear(0.25 * static_cast<double>(sum));
        to.texels[next++] = static_cast<std::uint8_t>(std::lround(level * 255));
      }
    }
  }
  return to;
}

/// A place from 0 to 1 that shows the same.
double wrapped(double x, TextureWrap wrap) {
  if (!std::isfinite(x)) return 0;
  if (wrap == TextureWrap::clamp) return std::clamp(x, 0.0, 1.0);
  const double whole = std::floor(x);
  const double rest = x - whole;
  const bool is_mirrored = wrap == TextureWrap::mirror && std::fmod(whole, 2) != 0;
  return is_mirrored ? 1 - rest : rest;
}

/// The texels on both sides of a place along one side of a picture, and the share of the second.
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

/// A picture and its smaller copies.
class Pyramid {
 public:
  explicit Pyramid(const Picture& picture) {
    levels_.push_back(first_level(picture));
    while (std::max(levels_.back().width, levels_.back().height) > 1) {
      levels_.push_back(half_of(levels_.back()));
    }
  }
  double width() const { return levels_[0].width; }
  double height() const { return levels_[0].height; }

  Linear at(Uv uv, const Material& material, double texels) const {
    std::size_t place = 0;
    for (double size = 2; size <= texels && place + 1 < levels_.size(); size *= 2) ++place;
    const Level& level = levels_[place];
    const double u = wrapped(static_cast<double>(uv[0]), material.wrap_u);
    const double v = wrapped(1 - static_cast<double>(uv[1]), material.wrap_v);
    const Between x = between(u, level.width, material.wrap_u);
    const Between y = between(v, level.height, material.wrap_v);
    const std::array<Linear, 4> four = {
        level.texel(x.first, y.first), level.texel(x.second, y.first),
        level.texel(x.first, y.second), level.texel(x.second, y.second)};
    Linear made{};
    for (std::size_t c = 0; c < 3; ++c) {
      const float above = four[0][c] + x.share * (four[1][c] - four[0][c]);
      const float below = four[2][c] + x.share * (four[3][c] - four[2][c]);
      made[c] = above + y.share * (below - above);
    }
    return made;
  }

 private:
  std::vector<Level> levels_;
};

}  // namespace

class MaterialColours::Impl {
 public:
  Impl(const LabelMeaning& labels, const PictureFiles& pictures, const Options& options)
      : materials_(labels.materials), pictures_(pictures.names.size()) {
    std::vector<bool> is_used(pictures_.size());
    for (const Material& material : materials_) {
      picture_of_.push_back(colour_map(material));
      if (picture_of_.back() < is_used.size()) is_used[picture_of_.back()] = true;
    }
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

  Linear at(Label label, Uv uv, double texels) const {
    const Material& material = materials_[label];
    const Pyramid* const picture = picture_at(label);
    Linear colour{1, 1, 1};
    if (picture != nullptr) colour = picture->at(uv, material, texels);
    for (std::size_t c = 0; c < 3; ++c) colour[c] *= material.colour[c];
    return colour;
  }

  double texels_of(Label label, const CornerUvs& uvs) const {
    const Pyramid* const picture = picture_at(label);
    if (picture == nullptr) return 0;
    return uv_area(uvs) * picture->width() * picture->height();
  }

  std::uint64_t texels() const {
    std::uint64_t sum = 0;
    for (const auto& picture : pictures_) {
      if (picture) sum += static_cast<std::uint64_t>(picture->width() * picture->height());
    }
    return sum;
  }
  bool are_lossy() const { return are_lossy_; }

 private:
  static std::size_t colour_map(const Material& material) {
    for (const MaterialMap& map : material.maps) {
      if (map.use == MapUse::colour) return map.picture;
    }
    return SIZE_MAX;
  }

  static std::uint64_t most_bytes(const Options& options) {
    if (options.memory_bytes != 0) return options.memory_bytes;
    const std::optional<MemoryRoom> room = available_memory();
    return room ? room->bytes / 2 : UINT64_MAX;
  }

  /// False if it would take too much memory.
  bool decode(std::size_t picture, std::string file, std::uint64_t& bytes, std::uint64_t most) {
    const PictureHead head = read_picture_head(file);
    // Three bytes a texel, the smaller copies a third of it again; and while it is decoded.
    const std::uint64_t kept = std::uint64_t{4} * head.width * head.height;
    if (bytes + kept + head.memory_bytes() > most) return false;
    pictures_[picture].emplace(decode_picture(std::move(file)));
    bytes += kept;
    are_lossy_ = are_lossy_ && head.kind == PictureHead::Kind::jpeg;
    return true;
  }

  const Pyramid* picture_at(Label label) const {
    const std::size_t picture = picture_of_[label];
    const bool has_one = picture < pictures_.size() && pictures_[picture].has_value();
    return has_one ? &*pictures_[picture] : nullptr;
  }

  std::vector<Material> materials_;
  std::vector<std::size_t> picture_of_;  // of each material
  std::vector<std::optional<Pyramid>> pictures_;
  bool are_lossy_ = true;
};

MaterialColours::MaterialColours(const LabelMeaning& labels, const PictureFiles& pictures,
                                 const Options& options)
    : impl_(std::make_unique<Impl>(labels, pictures, options)) {}
MaterialColours::~MaterialColours() = default;
MaterialColours::MaterialColours(MaterialColours&&) noexcept = default;

std::array<float, 3> MaterialColours::at(Label label, Uv uv, double texels) const {
  return impl_->at(label, uv, texels);
}

double MaterialColours::texels_of(Label label, const CornerUvs& uvs) const {
  return impl_->texels_of(label, uvs);
}

std::uint64_t MaterialColours::texels() const {
  return impl_->texels();
}

bool MaterialColours::are_lossy() const {
  return impl_->are_lossy();
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
