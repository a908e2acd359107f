// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <string>

#include "io/picture.hpp"
#include "mesh_fuzzer.hpp"

// Any bytes give texels, or one of our Errors.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace meshfarm;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  try {
    const PictureHead head = read_picture_head(bytes);
    constexpr std::uint64_t k_most_memory = std::uint64_t{1} << 24;
    if (head.memory_bytes() > k_most_memory) return -1;
    const Picture picture = decode_picture(bytes);
    fuzz::require(picture.width == head.width && picture.height == head.height);
    fuzz::require(picture.texels.size() == picture.step * head.width * head.height);
  } catch (const Error&) {
    return 0;
  }
  return 0;
}
