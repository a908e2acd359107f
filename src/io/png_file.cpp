// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <utility>

#include <meshfarm/io/png_file.hpp>
#include <meshfarm/staging/atomic_file.hpp>

#include "picture_writer.hpp"

namespace meshfarm {

std::string encode_png(Texels texels, PngSize size) {
  return encode_png(Picture{.width = texels.width,
                            .height = texels.height,
                            .step = texels.step,
                            .texels = std::move(texels.bytes)},
                    size);
}

void write_png(const std::filesystem::path& path, Texels texels) {
  const std::string bytes = encode_png(std::move(texels));
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace meshfarm
