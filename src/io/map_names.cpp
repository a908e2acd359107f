// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <utility>

#include <meshfarm/io/map_names.hpp>

namespace meshfarm {
namespace {

constexpr std::array<std::pair<MapUse, const char*>, 5> k_map_names = {
    {{MapUse::colour, "pictures of colours"},
     {MapUse::normal, "pictures of normals"},
     {MapUse::metal_and_roughness, "pictures of metal and roughness"},
     {MapUse::occlusion, "pictures of occlusion"},
     {MapUse::emission, "pictures of emission"}}};

bool has_map(const Material& material, MapUse use) {
  return std::any_of(material.maps.begin(), material.maps.end(),
                     [use](const MaterialMap& map) { return map.use == use; });
}

}  // namespace

std::vector<std::string> maps_left_out(const LabelMeaning& labels,
                                       const std::function<bool(MapUse)>& is_kept) {
  std::vector<std::string> names;
  for (const auto& [use, name] : k_map_names) {
    if (is_kept(use)) continue;
    const bool has_any =
        std::any_of(labels.materials.begin(), labels.materials.end(),
                    [use = use](const Material& each) { return has_map(each, use); });
    if (has_any) names.emplace_back(name);
  }
  return names;
}

}  // namespace meshfarm
