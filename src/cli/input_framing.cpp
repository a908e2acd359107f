// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/input_framing.hpp"

#include <mutex>

namespace meshfarm {

void add_input(InputSurface& input, std::span<Framing> framings,
               const std::function<void(std::uint64_t)>& seen) {
  std::mutex mutex;
  input.show([](const Box&) { return true; },
             [&](const SurfacePiece& piece) {
               if (seen) seen(piece.triangles.size());
               const std::lock_guard lock(mutex);
               for (Framing& framing : framings) framing.add(piece.fresh);
             });
}

}  // namespace meshfarm
