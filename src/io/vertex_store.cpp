// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "vertex_store.hpp"

#include <string>
#include <utility>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm {

void VertexStore::fill(const Filling& filling, const Take& take,
                       const std::function<bool(const Take&)>& read) {
  if (filling.keep == Keep::no) {
    read(take);
    return;
  }
  std::unique_ptr<KeptPositions> kept;
  const auto to_keep = [&](const auto& work) {
    try {
      work();
    } catch (const IoError& error) {
      if (filling.keep == Keep::always) throw;
      log_info(std::string("vertices are read more than once: ") + error.what());
      kept.reset();
    }
  };
  to_keep([&] { kept = std::make_unique<KeptPositions>(filling.positions, filling.vertices); });
  const bool is_final = read([&](std::span<const Vec3> points) {
    if (kept) to_keep([&] { kept->add(points); });
    take(points);
  });
  lookup_.reset();
  kept_ = is_final ? std::move(kept) : nullptr;
}

}  // namespace meshfarm
