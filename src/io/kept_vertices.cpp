// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "kept_vertices.hpp"

#include <algorithm>
#include <cstring>
#include <string>

namespace meshfarm {
namespace {

/// As stored in a file, where v goes down.
Uv gltf_uv(Uv uv) {
  return {uv[0], 1 - uv[1]};
}

}  // namespace

KeptVertices::KeptVertices(const GltfLayout& layout)
    : count_(layout.vertices),
      row_bytes_(layout.vertex_bytes),
      uv_at_(layout.uv_at()),
      bytes_(layout.vertices_bytes()) {
  if (layout.uvs) wedges_.emplace(layout.vertices);
}

void KeptVertices::add(std::string_view bytes) {
  std::copy(bytes.begin(), bytes.end(), bytes_.items().data() + added_);
  added_ += bytes.size();
  bytes_.used(bytes.size());
}

std::uint64_t KeptVertices::split(std::uint64_t vertex, Uv uv) {
  const Uv shown = gltf_uv(finite_uv(uv));
  return wedges_->number_of(vertex, shown, [&](bool is_first) {
    if (!is_first) {
      split_.push_back({shown, vertex});
      split_.used(1);
      return count_ + split_.size() - 1;
    }
    std::memcpy(row(vertex) + uv_at_, shown.data(), sizeof shown);
    bytes_.used(1);
    return vertex;
  });
}

void KeptVertices::write(const std::function<void(std::string_view)>& to) {
  constexpr std::uint64_t k_at_once = std::uint64_t{1} << 20;
  for (std::uint64_t first = 0; first < added_; first += k_at_once) {
    const std::uint64_t count = std::min(k_at_once, added_ - first);
    to({bytes_.items().data() + first, count});
    bytes_.used(count);
  }
  std::string bytes;
  for (std::uint64_t i = 0; i < split_.size(); ++i) {
    const Split& each = split_[i];
    bytes.append(row(each.vertex), row_bytes_);
    std::memcpy(bytes.data() + bytes.size() - row_bytes_ + uv_at_, each.uv.data(), sizeof each.uv);
    if (bytes.size() < k_at_once) continue;
    to(bytes);
    bytes.clear();
    bytes_.used(k_at_once / row_bytes_);
  }
  to(bytes);
}

}  // namespace meshfarm
