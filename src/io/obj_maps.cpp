// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "obj_maps.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "files_beside.hpp"
#include "kept_pictures.hpp"

namespace meshfarm {
namespace {

class Keeper {
 public:
  Keeper(const std::filesystem::path& path,
         const std::function<void(const std::string& line)>& warn)
      : pictures_(path.string(), warn) {}

  /// Returns the placement of the material's pictures: that of its colours. Pictures with another
  /// placement are skipped, as a triangle's corners have only one place each.
  MtlMap add(const ObjLibraryMaterial& from, Material& material) {
    const MtlMaterial& read = from.material;
    std::optional<MtlMap> first;
    add_map(from.folder, {read.map, MapUse::colour, "map_Kd"}, first, material);
    add_map(from.folder, {read.normals, MapUse::normal, "map_Bump"}, first, material);
    add_map(from.folder, {read.emission, MapUse::emission, "map_Ke"}, first, material);
    for (const std::string& word : read.other_maps) ++skipped_[word];
    if (!first) return {};
    material.wrap_u = material.wrap_v =
        first->is_clamped ? TextureWrap::clamp : TextureWrap::repeat;
    return *first;
  }

  PictureFiles pictures() && { return std::move(pictures_).files(); }
  std::vector<std::string> skipped() const {
    std::vector<std::string> made;
    for (const auto& [word, count] : skipped_) {
      made.push_back(word + " (" + std::to_string(count) + ")");
    }
    return made;
  }

 private:
  struct Use {
    const MtlMap& map;
    MapUse use;
    const char* word;
  };

  void add_map(const std::filesystem::path& folder, const Use& use, std::optional<MtlMap>& first,
               Material& material) {
    if (use.map.file.empty()) return;
    if (first && !first->lies_as(use.map)) {
      ++skipped_[use.word];
      return;
    }
    // Different spellings of a name may lead to the same file.
    const auto found = find_beside(folder, use.map.file);
    const std::string key = found ? found->string() : (folder / use.map.file).string();
    const auto picture =
        pictures_.number_of(key, use.map.file, picture_beside(folder, use.map.file));
    // Even if the picture of the colours is missing, its placement counts.
    if (!first) first = use.map;
    if (picture) material.maps.push_back({use.use, *picture});
  }

  KeptPictures pictures_;
  std::map<std::string, std::uint64_t> skipped_;
};

Uv moved(const Uv& uv, const MtlMap& by) {
  Uv made;
  for (std::size_t i = 0; i < 2; ++i) {
    made[i] = static_cast<float>(static_cast<double>(uv[i]) * by.scale[i] + by.offset[i]);
    if (!std::isfinite(made[i])) made[i] = 0;
  }
  return made;
}

}  // namespace

ObjMaps keep_obj_maps(const std::filesystem::path& path, const ObjNames& names,
                      std::span<const ObjLibraryMaterial> libraries, LabelMeaning& meaning,
                      const std::function<void(const std::string& line)>& warn) {
  Keeper keeper(path, warn);
  ObjMaps made;
  std::vector<MtlMap> moves(meaning.materials.size());
  for (const ObjLibraryMaterial& each : libraries) {
    const std::optional<Label> label = names.label_of(each.material.name);
    if (label) moves[*label] = keeper.add(each, meaning.materials[*label]);
  }
  made.skipped = keeper.skipped();
  made.pictures = std::move(keeper).pictures();
  const auto stays = [](const MtlMap& map) {
    return map.scale == MtlMap().scale && map.offset == MtlMap().offset;
  };
  if (!std::all_of(moves.begin(), moves.end(), stays)) made.moves = std::move(moves);
  return made;
}

TriangleView MovedUvs::of(const TriangleView& batch) {
  moved_.assign(batch.columns.uvs.begin(), batch.columns.uvs.end());
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    const MtlMap& by = moves_[batch.columns.labels[i]];
    for (Uv& uv : moved_[i]) uv = moved(uv, by);
  }
  return {batch.corners, {batch.columns.labels, moved_}};
}

}  // namespace meshfarm
