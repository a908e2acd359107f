// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "gltf_parts.hpp"

#include <algorithm>
#include <cstring>

namespace meshfarm {

GltfParts::GltfParts(const LabelMeaning& meaning, std::uint64_t triangles)
    : materials_(meaning), triangles_(triangles), counts_(meaning.materials.size()) {}

void GltfParts::add(const TriangleView& batch) {
  const std::span<Labelled> all = triangles_.items();
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const std::size_t place =
        batch.columns.labels.empty() ? 0 : materials_.place_of(batch.columns.labels[i]);
    if (place >= counts_.size()) counts_.resize(place + 1);
    ++counts_[place];
    Labelled& made = all[count_++];
    std::transform(batch.corners[i].begin(), batch.corners[i].end(), made.corners.begin(),
                   [](std::uint64_t index) { return static_cast<std::uint32_t>(index); });
    made.place = static_cast<std::uint32_t>(place);
  }
  triangles_.used(batch.size());
}

std::vector<GltfPart> GltfParts::finish(const std::filesystem::path& path) {
  materials_.warn_of_shared(path);
  sort();
  std::vector<GltfPart> parts;
  for (std::size_t place = 0; place < counts_.size(); ++place) {
    if (counts_[place] > 0) parts.push_back({materials_.all()[place], counts_[place]});
  }
  return parts;
}

/// Moves each triangle to the next place of its material.
void GltfParts::sort() {
  sorted_ = ScratchArray<Corners>(count_);
  std::vector<std::uint64_t> next(counts_.size());
  for (std::size_t place = 1; place < next.size(); ++place) {
    next[place] = next[place - 1] + counts_[place - 1];
  }
  constexpr std::uint64_t k_at_once = 8192;
  for (std::uint64_t first = 0; first < count_; first += k_at_once) {
    const std::uint64_t count = std::min(k_at_once, count_ - first);
    for (const Labelled& each : triangles_.items().subspan(first, count)) {
      sorted_.items()[next[each.place]++] = each.corners;
    }
    triangles_.used(count);
    sorted_.used(count);
  }
  triangles_ = {};
}

void GltfParts::write(std::size_t index_bytes, const std::function<void(std::string_view)>& to) {
  constexpr std::uint64_t k_at_once = 8192;
  std::vector<char> buffer(k_at_once * sizeof(Corners));
  for (std::uint64_t first = 0; first < count_; first += k_at_once) {
    const std::uint64_t count = std::min(k_at_once, count_ - first);
    char* out = buffer.data();
    for (const Corners& corners : sorted_.items().subspan(first, count)) {
      for (const std::uint32_t index : corners) {
        std::memcpy(out, &index, index_bytes);  // its low bytes
        out += index_bytes;
      }
    }
    to({buffer.data(), static_cast<std::size_t>(out - buffer.data())});
    sorted_.used(count);
  }
}

}  // namespace meshfarm
