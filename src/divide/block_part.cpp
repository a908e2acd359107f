// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include <meshfarm/util/errors.hpp>

#include "divide/bundle_file.hpp"
#include "divide/part_builder.hpp"
#include "divide/seam_numbers.hpp"
#include "divide/seam_vertices.hpp"

namespace meshfarm {
namespace {

/// Assembles what the bundles hold of a part.
class ShareOfBlocks {
 public:
  ShareOfBlocks(const Stage& stage, const BundlesOfMesh& bundles, std::uint32_t part)
      : stage_(stage),
        bundles_(bundles),
        part_(part),
        places_(stage, bundles.vertices, bundles.parts) {
    share_.type = bundles.positions;
  }

  void gather() {
    gather_vertices();
    gather_triangles();
    for (const SeamTriangle& t : outer_) {
      for (const SharePlace& corner : t) {
        if (corner.share == part_) share_.boundary.push_back(corner.place);
      }
    }
  }

  /// Call this before anything is welded.
  void keep_sheets_apart() {
    share_.apart =
        find_apart(share_, part_, outer_, [&](SharePlace vertex) { return position_of(vertex); });
  }

  MeshShare take() { return std::move(share_); }
  std::uint64_t points_left_out() const { return points_left_out_; }
  /// Maps vertices of a crowd to its first vertex.
  const std::map<std::uint32_t, std::uint32_t>& same() const { return same_; }

 private:
  void gather_vertices() {
    share_.positions.reserve(places_.count(part_));
    std::map<std::uint32_t, std::uint32_t> first_of_point;
    for (std::size_t block = 0; block < places_.blocks(); ++block) {
      if (places_.count(block, part_) == 0) continue;
      const auto positions = places_.positions(block, part_, share_.type);
      share_.positions.insert(share_.positions.end(), positions.begin(), positions.end());
      for (const CrowdVertex& each :
           read_section<CrowdVertex>(places_.file(block), bundles_.vertices[block].bundle.crowds)) {
        if (each.part != part_) continue;
        const std::uint32_t place = places_.first(block, part_) + each.place;
        const auto [first, is_first] = first_of_point.try_emplace(each.point, place);
        if (!is_first) same_[place] = first->second;
      }
    }
  }

  void gather_triangles() {
    for (const TriangleBundleRef& each : bundles_.triangles) {
      if (each.bundle.parts &&
          !std::binary_search(each.bundle.parts->begin(), each.bundle.parts->end(), part_)) {
        continue;
      }
      const SectionedFile file(stage_, each.file);
      for (const BundleEntry& entry : read_section<BundleEntry>(file, each.bundle.directory)) {
        if (entry.part != part_) continue;
        const auto triangles = unpack_triangles(file.read(entry.section));
        if (!triangles || triangles->size() != entry.count) {
          throw DataError(each.file.name + ": has other triangles than it says");
        }
        share_.triangles.insert(share_.triangles.end(), triangles->begin(), triangles->end());
        const auto seams = read_section<SeamTriangle>(file, entry.seams);
        outer_.insert(outer_.end(), seams.begin(), seams.end());
      }
    }
    if (!same_.empty()) join_crowds();
    check_corners();
  }

  /// Joins the vertices of a crowd across blocks: each block has joined only its own.
  void join_crowds() {
    const auto joined = [&](std::uint32_t place) {
      const auto found = same_.find(place);
      return found == same_.end() ? place : found->second;
    };
    for (Triangle& t : share_.triangles) t = {joined(t[0]), joined(t[1]), joined(t[2])};
    points_left_out_ = std::erase_if(
        share_.triangles, [](const Triangle& t) { return t[0] == t[1] && t[1] == t[2]; });
    for (SeamTriangle& t : outer_) {
      for (SharePlace& corner : t) {
        if (corner.share == part_) corner.place = joined(corner.place);
      }
    }
  }

  void check_corners() const {
    const std::size_t vertices = share_.positions.size();
    const bool is_there = std::all_of(
        share_.triangles.begin(), share_.triangles.end(),
        [&](const Triangle& t) { return t[0] < vertices && t[1] < vertices && t[2] < vertices; });
    if (!is_there) throw DataError("a bundle has a triangle of a vertex that is not there");
  }

  /// The position of another part's vertex: needed where surfaces touch at a seam.
  Vec3 position_of(SharePlace vertex) {
    BlockPlaces& places = places_of_all();
    if (vertex.share >= places.parts()) throw DataError("a boundary triangle of no part");
    for (std::size_t block = 0; block < places.blocks(); ++block) {
      const std::uint32_t first = places.first(block, vertex.share);
      if (vertex.place < first || vertex.place - first >= places.count(block, vertex.share)) {
        continue;
      }
      std::vector<Vec3>& positions = others_[{block, vertex.share}];
      if (positions.empty()) positions = places.positions(block, vertex.share, share_.type);
      return positions.at(vertex.place - first);
    }
    throw DataError("a bundle has a triangle of a vertex that is not there");
  }

  /// The places of all parts: places_ may only be complete for this part.
  BlockPlaces& places_of_all() {
    if (!places_of_all_) {
      const TriangleBundleRef& any = bundles_.triangles.at(0);
      all_vertices_ = decode_bundles(SectionedFile(stage_, any.file).read(any.bundle.vertices));
      places_of_all_.emplace(stage_, all_vertices_, bundles_.parts);
    }
    return *places_of_all_;
  }

  const Stage& stage_;
  const BundlesOfMesh& bundles_;
  std::uint32_t part_;
  BlockPlaces places_;
  MeshShare share_;
  std::vector<SeamTriangle> outer_;
  std::map<std::uint32_t, std::uint32_t> same_;
  std::uint64_t points_left_out_ = 0;
  std::vector<VertexBundleRef> all_vertices_;
  std::optional<BlockPlaces> places_of_all_;
  std::map<std::pair<std::size_t, std::uint32_t>, std::vector<Vec3>> others_;
};

/// Adds all places of a crowd under the crowd's number.
void add_same(const std::map<std::uint32_t, std::uint32_t>& same, BoundaryNumbers& numbers) {
  const std::vector<std::uint32_t> places = numbers.places;
  const std::size_t known = places.size();
  for (const auto& [place, first] : same) {
    const auto at = std::lower_bound(places.begin(), places.end(), first);
    if (at == places.end() || *at != first) continue;
    const auto index = static_cast<std::size_t>(at - places.begin());
    numbers.places.push_back(place);
    numbers.numbers.push_back(numbers.numbers[index]);
    if (!numbers.points.empty()) numbers.points.push_back(numbers.points[index]);
  }
  if (numbers.places.size() == known) return;
  std::vector<std::size_t> order(numbers.places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return numbers.places[a] < numbers.places[b]; });
  BoundaryNumbers sorted;
  for (const std::size_t i : order) {
    sorted.places.push_back(numbers.places[i]);
    sorted.numbers.push_back(numbers.numbers[i]);
    if (!numbers.points.empty()) sorted.points.push_back(numbers.points[i]);
  }
  numbers = std::move(sorted);
}

}  // namespace

PartOfBlocks build_from_blocks(const Stage& stage, const BundlesOfMesh& bundles,
                               std::uint32_t part) {
  if (part >= bundles.parts) throw DataError("there is no such part");
  ShareOfBlocks share(stage, bundles, part);
  share.gather();
  share.keep_sheets_apart();
  MeshShare raw = share.take();
  PartOfBlocks made;
  made.shared_triangles = raw.triangles.size();
  BuiltPart built = build_part(std::move(raw), Weld::exact);
  static_cast<WeldCounts&>(made) = built;
  made.dropped_degenerate += share.points_left_out();
  made.coincident_corners += share.points_left_out();
  made.shared_boundary = static_cast<std::uint32_t>(built.boundary.places.size());
  add_same(share.same(), built.boundary);
  made.numbers = encode_numbers(built.boundary);
  made.part = std::move(built.part);
  return made;
}

Mesh surface_from_blocks(const Stage& stage, const BundlesOfMesh& bundles, std::uint32_t part) {
  if (part >= bundles.parts) throw DataError("there is no such part");
  ShareOfBlocks share(stage, bundles, part);
  share.gather();
  return build_part(share.take(), Weld::off).part.mesh;
}

JoinedBoundary join_boundary(const Stage& stage, const BundlesOfMesh& bundles, std::uint32_t group,
                             const std::function<std::string(std::uint32_t part)>& numbers_of) {
  Seams seams;
  for (const TriangleBundleRef& each : bundles.triangles) {
    const SectionedFile file(stage, each.file);
    const auto groups = read_section<FileSection>(file, each.bundle.seams);
    if (group >= groups.size()) throw DataError(each.file.name + ": has other groups of regions");
    const auto some = read_section<SeamTriangle>(file, groups[group]);
    seams.triangles.insert(seams.triangles.end(), some.begin(), some.end());
  }
  SeamNumbers numbers(bundles.parts,
                      [&](std::uint32_t part) { return decode_numbers(numbers_of(part)); });
  SharedTriangles shared = numbers.number(seams);
  JoinedBoundary joined;
  joined.degenerate = shared.degenerate;
  joined.coincident = shared.coincident;
  joined.duplicate = order_by_region(bundles.parts, shared.triangles, shared.columns);
  joined.triangles = shared.triangles.size();
  joined.encoded = encode_boundary(bundles.parts, shared.triangles, shared.columns);
  return joined;
}

}  // namespace meshfarm
