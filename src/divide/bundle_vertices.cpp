// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <unordered_map>
#include <utility>

#include <meshfarm/util/errors.hpp>

#include "divide/bundle_file.hpp"
#include "divide/cell_places.hpp"

namespace meshfarm {
namespace {

class VertexScatter {
 public:
  VertexScatter(std::string_view partition, PositionType type)
      : cells_(CellPlaces::decode(partition)), type_(type) {}

  void add(std::span<const Vec3> batch) {
    cells_.find_targets(batch, targets_);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const std::uint32_t part = targets_.shares[i];
      const std::uint32_t point =
          targets_.points.empty() ? MeshShares::k_no_point : targets_.points[i];
      if (part == MeshShares::k_no_share) {
        put_run(part, 0);
      } else if (point == MeshShares::k_no_point) {
        put_run(part, put_vertex(part, batch[i]));
      } else {
        add_to_crowd(point, part, batch[i]);
      }
    }
  }

  VertexBundle write(const WriteBytes& write) {
    SectionWriter sections(write);
    std::vector<BundleEntry> directory;
    bundle_.parts.emplace();
    for (std::uint32_t part = 0; part < parts_.size(); ++part) {
      if (parts_[part].count == 0) continue;
      bundle_.parts->push_back({part, parts_[part].count});
      directory.push_back(BundleEntry::none(part));
      directory.back().count = parts_[part].count;
      directory.back().section = sections.add(std::exchange(parts_[part].positions, {}).bytes());
    }
    bundle_.directory = sections.add(bytes_of(directory));
    bundle_.runs = sections.add(bytes_of(runs_));
    bundle_.crowds = sections.add(bytes_of(crowds_));
    return bundle_;
  }

 private:
  struct OfPart {
    ByteWriter positions;
    std::uint32_t count = 0;
  };

  template <class T>
  static std::string_view bytes_of(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
  }

  std::uint32_t put_vertex(std::uint32_t part, Vec3 p) {
    if (part >= parts_.size()) parts_.resize(part + std::size_t{1});
    OfPart& of = parts_[part];
    if (type_ == PositionType::float64) {
      of.positions.put(p);
    } else {
      of.positions.put(std::array<float, 3>{static_cast<float>(p.x), static_cast<float>(p.y),
                                            static_cast<float>(p.z)});
    }
    return of.count++;
  }

  void add_to_crowd(std::uint32_t point, std::uint32_t part, Vec3 p) {
    const auto [first, is_first] = crowd_.try_emplace(point, 0);
    if (is_first) {
      first->second = put_vertex(part, p);
      crowds_.push_back({point, part, first->second});
    } else {
      ++bundle_.merged;
    }
    put_run(part, first->second);
  }

  void put_run(std::uint32_t part, std::uint32_t place) {
    if (!runs_.empty() && runs_.back().part == part &&
        (part == MeshShares::k_no_share || runs_.back().place + runs_.back().count == place)) {
      ++runs_.back().count;
    } else {
      runs_.push_back({part, place, 1});
    }
  }

  CellPlaces cells_;
  PositionType type_;
  ShareTargets targets_;
  std::vector<OfPart> parts_;
  std::vector<PlaceRun> runs_;
  std::vector<CrowdVertex> crowds_;
  std::unordered_map<std::uint32_t, std::uint32_t> crowd_;  // place of the first, by point
  VertexBundle bundle_;
};

}  // namespace

VertexBundle scatter_vertices(std::string_view partition, const MeshBlocks& mesh,
                              const BlockRange& vertices, const WriteBytes& write) {
  if (vertices.count > 0xfffffffe) throw DataError("a block of 2^32 vertices or more");
  VertexScatter scatter(partition, mesh.positions());
  mesh.scan_vertices(vertices, [&](std::span<const Vec3> batch) { scatter.add(batch); });
  return scatter.write(write);
}

}  // namespace meshfarm
