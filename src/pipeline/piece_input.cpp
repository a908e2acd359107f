// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/piece_input.hpp"

#include <cstdint>
#include <utility>

#include <meshfarm/divide/block_cut.hpp>
#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/staging/sections.hpp>

#include "pipeline/piece_sections.hpp"

namespace meshfarm {

PieceInput read_piece_input(const Stage& stage, const MeasureParameters& parameters) {
  PieceInput input;
  if (parameters.bundles) {
    for (std::uint32_t p = parameters.first_part; p < parameters.end_part; ++p) {
      input.parts.push_back(surface_from_blocks(stage, *parameters.bundles, p));
    }
  }
  for (const FileRef& file : parameters.parts) {
    input.parts.push_back(decode_part_or_stream(stage.read(file), file.name).mesh);
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
