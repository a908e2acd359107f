// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "texture_colours.hpp"

#include <algorithm>
#include <utility>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>
#include <meshfarm/util/memory.hpp>

namespace meshfarm {
namespace {

/// The weight of a triangle without an area on its texture, or without a texture: small, but not
/// zero.
constexpr double k_least_texels = 1.0 / 4096;

/// Pictures that are decoded together.
using Group = std::vector<std::size_t>;

/// The pictures of a mesh file, as far as they can be read.
class Pictures {
 public:
  Pictures(std::vector<TextureImage> images, const std::vector<TextureMaterial>& materials,
           std::uint64_t most_bytes, const std::string& path)
      : images_(std::move(images)), sizes_(images_.size()), most_bytes_(most_bytes), path_(path) {
    for (const TextureMaterial& material : materials) {
      if (material.has_image()) sizes_[material.image] = 1;
    }
    for (std::size_t i = 0; i < images_.size(); ++i) {
      if (sizes_[i] != 0) sizes_[i] = measured(i);
    }
  }

  /// In order, as many at a time as the memory allows.
  std::vector<Group> groups(std::uint64_t memory_bytes) const {
    std::vector<Group> made;
    std::uint64_t bytes = 0;
    for (std::size_t i = 0; i < images_.size(); ++i) {
      if (sizes_[i] == 0) continue;
      if (made.empty() || bytes + sizes_[i] > memory_bytes) {
        made.emplace_back();
        bytes = 0;
      }
      made.back().push_back(i);
      bytes += sizes_[i];
    }
    return made;
  }

  /// Nothing, after a warning, if it is damaged.
  std::optional<Picture> decoded(std::size_t image) {
    check_memory(image);
    // A mesh is useful without its colours, and many come without their pictures.
    try {
      Picture picture = decode_picture(images_[image].load());
      if (!picture.oddity.empty()) warn(image, picture.oddity);
      return picture;
    } catch (const Error& error) {
      warn_lost(image, error);
      return std::nullopt;
    }
  }

 private:
  /// The memory for decoding it; 0 if it cannot be decoded.
  std::uint64_t measured(std::size_t image) {
    try {
      const std::string bytes = images_[image].load();
      return read_picture_head(bytes).memory_bytes() + bytes.size();
    } catch (const Error& error) {
      warn_lost(image, error);
      return 0;
    }
  }

  /// If colours were dropped for lack of memory, the result would depend on the host.
  void check_memory(std::size_t image) const {
    const std::optional<MemoryRoom> room = available_memory();
    const std::uint64_t most = most_bytes_ != 0 ? most_bytes_ : room ? room->bytes / 2 : UINT64_MAX;
    if (sizes_[image] <= most) return;
    throw DataError(path_ + ": the texture " + images_[image].name + " takes " +
                    std::to_string(sizes_[image] >> 20) + " MiB of memory, more than the " +
                    std::to_string(most >> 20) + " MiB that it may take" +
                    (most_bytes_ != 0 ? "" : ", half of what is free") +
                    ": make it smaller, or leave textures out with --uv drop");
  }

  void warn(std::size_t image, const std::string& why) const {
    log_warning(path_ + ": the texture " + images_[image].name + ": " + why);
  }
  void warn_lost(std::size_t image, const Error& error) const {
    warn(image, std::string(error.what()) + "; what it covers has no colour of it");
  }

  std::vector<TextureImage> images_;
  std::vector<std::uint64_t> sizes_;
  std::uint64_t most_bytes_;
  const std::string& path_;
};

}  // namespace

std::size_t TextureColours::sample(std::vector<TextureImage> images,
                                   std::vector<TextureMaterial> materials, const Options& options,
                                   const Scan& scan) {
  Pictures pictures(std::move(images), materials, options.picture_bytes, path_);
  std::size_t sampled = 0;
  std::vector<bool> is_done(materials.size());
  for (const Group& group : pictures.groups(options.memory_bytes)) {
    std::vector<std::optional<Picture>> decoded;
    for (const std::size_t image : group) decoded.push_back(pictures.decoded(image));
    std::vector<const Picture*> of_material(materials.size());
    for (std::size_t i = 0; i < materials.size(); ++i) {
      const auto at = std::find(group.begin(), group.end(), materials[i].image);
      if (at == group.end()) continue;
      const std::optional<Picture>& picture = decoded[static_cast<std::size_t>(at - group.begin())];
      if (!picture) continue;
      of_material[i] = &*picture;
      is_done[i] = true;
    }
    const auto has_any = [](const auto& picture) { return picture.has_value(); };
    const auto count = std::count_if(decoded.begin(), decoded.end(), has_any);
    if (count == 0) continue;
    sampled += static_cast<std::size_t>(count);
    scan([&](std::size_t material) { return of_material[material] != nullptr; },
         [&](const TexturedTriangle& triangle, std::size_t material) {
           if (of_material[material] == nullptr) return;
           add(triangle, materials[material], of_material[material]);
         });
  }
  const bool all_done = std::all_of(is_done.begin(), is_done.end(), [](bool done) { return done; });
  if (sampled == 0 || options.plain == Plain::left || all_done) return sampled;
  scan([&](std::size_t material) { return !is_done[material]; },
       [&](const TexturedTriangle& triangle, std::size_t material) {
         if (!is_done[material]) add(triangle, materials[material], nullptr);
       });
  return sampled;
}

void TextureColours::add(const TexturedTriangle& triangle, const TextureMaterial& material,
                         const Picture* picture) {
  std::optional<ThirdColours> thirds;
  if (picture != nullptr) {
    std::array<TexturePoint, 3> places;
    for (std::size_t i = 0; i < 3; ++i) places[i] = material.mapped(triangle.places[i]);
    thirds = average_thirds({*picture, material.wrap_u, material.wrap_v}, places);
    if (!thirds) return;
  } else {
    thirds = ThirdColours{.corners = {material.plain, material.plain, material.plain}};
  }
  const LinearColour factor = picture != nullptr ? material.factor : LinearColour{1, 1, 1};
  const auto weight = static_cast<float>(std::max(thirds->texels, k_least_texels));
  const std::span<Sum> sums = sums_.items();
  for (std::size_t i = 0; i < 3; ++i) {
    Sum& sum = sums[triangle.vertices[i]];
    for (std::size_t k = 0; k < 3; ++k) {
      sum.colour[k] += weight * factor[k] * thirds->corners[i][k];
    }
    sum.weight += weight;
  }
  sums_.used(3);
}

std::vector<std::string> describe(const std::vector<TextureImage>& images, LostPictures lost) {
  std::vector<std::string> made;
  for (const TextureImage& image : images) {
    try {
      const PictureHead head = read_picture_head(image.load());
      made.push_back(image.name + " (" + std::to_string(head.width) + " x " +
                     std::to_string(head.height) + ")");
    } catch (const Error& error) {  // the rest of the file is usable without it
      if (lost == LostPictures::told) made.push_back(image.name + " (" + error.what() + ")");
    }
  }
  return made;
}

}  // namespace meshfarm
