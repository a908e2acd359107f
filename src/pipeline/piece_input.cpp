// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/piece_input.hpp"

#include <cstdint>
#include <utility>

#include <meshfarm/divide/block_cut.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/piece_sections.hpp"

namespace meshfarm {

PieceInput read_piece_input(const Stage& stage, const MeasureParameters& parameters) {
  const auto& bundles = parameters.bundles;
  Manifest manifest;
  if (!bundles) manifest = decode_manifest(stage.read(ManifestName{}), "the manifest");
  const std::size_t parts = bundles ? bundles->parts : manifest.parts.size();
  if (parameters.end_part > parts) throw DataError("no such parts in the stage");
  PieceInput input;
  for (std::uint32_t p = parameters.first_part; p < parameters.end_part; ++p) {
    if (bundles) {
      input.parts.push_back(surface_from_blocks(stage, *bundles, p));
      continue;
    }
    const FileRef& file = manifest.parts[p].file;
    input.parts.push_back(decode_part(stage.read(file), file.name).mesh);
  }
  if (const SectionRef& ref = parameters.between; !ref.file.name.empty()) {
    input.between = decode_surface(SectionedFile(stage, ref.file).read(ref.section), ref.file.name);
  }
  for (const Mesh& part : input.parts) {
    for (const Vec3& v : part.positions) input.box.add(v);
  }
  for (const Vec3& v : input.between.positions) input.box.add(v);
  return input;
}

}  // namespace meshfarm
