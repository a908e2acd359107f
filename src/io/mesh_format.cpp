// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <string>
#include <string_view>

#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/util/errors.hpp>

#include "io/ply_reader.hpp"

namespace meshfarm {
namespace {

struct MeshFormat {
  std::string_view extension;
  bool (*recognises)(const InputFile& file);  // by content
  std::unique_ptr<MeshSource> (*open)(InputFile file, const OpenOptions& options);
  bool can_be_written;
};

constexpr std::array<MeshFormat, 1> k_formats = {{
    {".ply", is_ply_file, open_ply, true},
}};

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

std::unique_ptr<MeshSource> open_mesh(const std::filesystem::path& path,
                                      const OpenOptions& options) {
  InputFile file(path);
  for (const MeshFormat& format : k_formats) {
    if (format.recognises(file)) return format.open(std::move(file), options);
  }
  throw DataError(path.string() +
                  ": unknown format; meshfarm reads PLY (ascii, binary little or big endian), "
                  "plain or compressed with gzip or zstd");
}

void check_output_format(const std::filesystem::path& path) {
  const std::string extension = lower(path.extension().string());
  if (extension.empty()) return;
  for (const MeshFormat& format : k_formats) {
    if (extension == format.extension && format.can_be_written) return;
  }
  throw DataError(path.string() + ": cannot write " + extension +
                  "; meshfarm writes PLY, not compressed: name the output .ply");
}

}  // namespace meshfarm
