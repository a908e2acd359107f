// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/piece_input.hpp"

#include <algorithm>

#include <meshfarm/divide/block_cut.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/regions.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {

PieceInput::PieceInput(const Stage& stage, const MeasureParameters& parameters)
    : stage_(stage),
      parameters_(parameters),
      first_(parameters.first_part),
      end_(parameters.end_part),
      boxes_(end_ - first_),
      boundary_(end_ - first_) {
  if (!parameters.bundles) {
    manifest_ = decode_manifest(stage.read(ManifestName{}), "the manifest");
  }
  const std::size_t parts = parameters.bundles ? parameters.bundles->parts : manifest_.parts.size();
  if (end_ > parts) throw DataError("no such parts in the stage");
}

void PieceInput::show(const std::function<bool(const Box&)>& wants, const Show& show_part,
                      const Show& show_between) {
  for (std::uint32_t p = first_; p < end_; ++p) {
    Box& box = boxes_[p - first_];
    if (!box.empty() && !wants(box)) continue;
    const Part part = read_part(p);
    const std::vector<Vec3>& positions = part.mesh.positions;
    if (box.empty()) {
      for (const Vec3& v : positions) box.add(v);
      boundary_[p - first_].assign(positions.begin(), positions.begin() + part.boundary_vertices);
    }
    show_part(part.mesh);
  }
  show_between(between());
}

Part PieceInput::read_part(std::uint32_t part) const {
  if (parameters_.bundles) return build_from_blocks(stage_, *parameters_.bundles, part).part;
  const FileRef& file = manifest_.parts[part].file;
  return decode_part(stage_.read(file), file.name);
}

Mesh PieceInput::between() const {
  std::vector<PartRange> parts;
  for (std::uint32_t p = first_; p < end_; ++p) parts.push_back({p, p + 1});
  if (parts.size() < 2) return {};
  const BoundaryRegions regions(stage_, parameters_.boundary, parameters_.boundary_index);
  std::vector<BoundaryTriangle> triangles;
  TriangleColumns columns;
  for (const std::uint32_t region : Regions(regions.parts()).touched_by(parts)) {
    regions.read(region, triangles, columns);
  }
  Mesh mesh;
  const auto is_ours = [&](const BoundaryCorner& corner) {
    return corner.part >= first_ && corner.part < end_ &&
           corner.local < boundary_[corner.part - first_].size();
  };
  for (const BoundaryTriangle& t : triangles) {
    if (!std::all_of(t.begin(), t.end(), is_ours)) continue;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const BoundaryCorner& each : t) {
      mesh.positions.push_back(boundary_[each.part - first_][each.local]);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

}  // namespace meshfarm
