// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <meshfarm/io/png_file.hpp>

#include "picture.hpp"

namespace meshfarm {

/// The fidelity of a JPEG.
struct JpegOptions {
  int quality = 92;         // 1 to 100
  bool full_colour = true;  // colour in full resolution; else in half the resolution each way
};

// Encodes a picture as a file of that format. The same picture gives the same bytes with the same
// version of the encoder. Both throw DataError for a picture that the format cannot hold.
std::string encode_png(const Picture& picture, PngSize size = PngSize::least);
/// Drops alpha.
std::string encode_jpeg(const Picture& picture, const JpegOptions& options = {});

}  // namespace meshfarm
