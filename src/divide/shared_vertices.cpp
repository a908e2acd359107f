// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/shared_vertices.hpp"

namespace meshfarm {

SharedVertices::SharedVertices(const std::filesystem::path& folder, std::size_t slabs)
    : file_(folder, slabs) {}

void SharedVertices::add(std::uint32_t slab, std::span<const SharedVertex> vertices) {
  const std::lock_guard lock(mutex_);
  for (const SharedVertex& vertex : vertices) file_.put(slab, vertex);
}

void SharedVertices::finish() {
  file_.finish();
}

const SharedVertex& SharedVertices::at(SharePlace vertex) {
  const Loaded& slab = loaded(vertex.share);
  return slab.vertices[slab.index[vertex.place]];
}

void SharedVertices::forget_below(std::uint32_t slab) {
  loaded_.erase(loaded_.begin(), loaded_.lower_bound(slab));
}

const SharedVertices::Loaded& SharedVertices::loaded(std::uint32_t slab) {
  const auto [at, is_new] = loaded_.try_emplace(slab);
  Loaded& loaded = at->second;
  if (!is_new) return loaded;
  loaded.vertices = file_.read<SharedVertex>(slab);
  if (loaded.vertices.empty()) return loaded;
  loaded.index.resize(loaded.vertices.back().place + std::size_t{1});
  for (std::size_t i = 0; i < loaded.vertices.size(); ++i) {
    loaded.index[loaded.vertices[i].place] = static_cast<std::uint32_t>(i);
  }
  return loaded;
}

}  // namespace meshfarm
