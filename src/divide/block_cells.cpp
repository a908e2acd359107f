// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <utility>

#include <meshfarm/divide/block_cut.hpp>
#include <meshfarm/util/bytes.hpp>

#include "divide/cell_graph.hpp"
#include "divide/cell_map.hpp"

namespace meshfarm {

BlockSurvey survey_block(const MeshBlocks& mesh, const BlockRange& vertices) {
  BlockSurvey survey;
  mesh.scan_vertices(vertices, [&](std::span<const Vec3> batch) {
    for (const Vec3& p : batch) {
      survey.box.add(p);
      survey.not_finite += has_position(p) ? 0 : 1;
    }
  });
  return survey;
}

std::string begin_cells(const Box& box, std::uint32_t parts) {
  return CellMap(box, {parts, Weld::exact, 1}).encode(CellTree::Which::all);
}

std::string count_block(std::string_view cells, const MeshBlocks& mesh,
                        const BlockRange& vertices) {
  CellMap map = CellMap::decode(cells);
  mesh.scan_vertices(vertices, [&](std::span<const Vec3> batch) { map.count(batch); });
  return map.encode(CellTree::Which::counted);
}

Partition partition_blocks(std::string_view cells, std::size_t blocks, const CountedBlock& counted,
                           unsigned threads) {
  CellMap map = CellMap::decode(cells, threads);
  for (std::size_t b = 0; b < blocks; ++b) map.join(CellMap::decode(counted(b)));
  Partition partition;
  partition.counts_again = map.refine();
  if (!partition.counts_again) partition.parts = map.divide();
  partition.bytes =
      map.encode(partition.counts_again ? CellTree::Which::all : CellTree::Which::places);
  return partition;
}

std::string partitioner_of_blocks() {
  return partitioner_name();
}

}  // namespace meshfarm
