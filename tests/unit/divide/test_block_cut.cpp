// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/divide/block_cut.hpp>
#include <meshfarm/divide/cut.hpp>
#include <meshfarm/io/ply_writer.hpp>
#include <meshfarm/io/regions.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/file.hpp>

#include "support/meshes.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

/// Whether bundles tell what they have, so that jobs learn only of those that they need.
enum class Bundles { tell, do_not_tell };

/// The cut of a file in steps, as jobs do them.
class SteppedCut {
 public:
  SteppedCut(const std::filesystem::path& file, std::uint32_t parts, std::size_t blocks,
             const Stage& stage, Bundles telling = Bundles::tell)
      : mesh_(open_blocks(file)), blocks_(blocks), stage_(stage) {
    REQUIRE(mesh_ != nullptr);
    bundles_.positions = mesh_->positions();
    partition(parts);
    for (std::size_t b = 0; b < blocks_; ++b) {
      VertexBundle made;
      const FileRef ref = publish([&](const WriteBytes& write) {
        made = scatter_vertices(map_, *mesh_, vertices(b), write);
      });
      if (telling == Bundles::do_not_tell) made.parts.reset();
      bundles_.vertices.push_back({ref, made});
    }
    for (std::size_t b = 0; b < blocks_; ++b) {
      TriangleBundle made;
      const FileRef ref = publish([&](const WriteBytes& write) {
        made = scatter_triangles(stage_, bundles_.vertices, bundles_.parts, *mesh_,
                                 block_of(mesh_->triangles(), blocks_, b), write);
      });
      if (telling == Bundles::do_not_tell) made.parts.reset();
      dropped += made.dropped;
      points_left_out += made.points_left_out;
      bundles_.triangles.push_back({ref, made});
    }
    std::vector<std::string> numbers;
    for (std::uint32_t p = 0; p < bundles_.parts; ++p) {
      const BundlesOfMesh needed = bundles_of_parts(bundles_, {p, p + 1});
      named += needed.vertices.size() + needed.triangles.size();
      parts_made.push_back(build_from_blocks(stage_, needed, p));
      numbers.push_back(parts_made.back().numbers);
    }
    const RegionGroups groups(bundles_.parts);
    for (std::uint32_t group = 0; group < groups.count(); ++group) {
      const JoinedBoundary made =
          join_boundary(stage_, bundles_of_group(bundles_, group), group,
                        [&](std::uint32_t part) { return numbers.at(part); });
      const FileRef ref = publish([&](const WriteBytes& write) { write(made.encoded.file); });
      boundary.push_back({ref, made.encoded.index, groups.first_region(group)});
      joined.triangles += made.triangles;
      joined.degenerate += made.degenerate;
      joined.coincident += made.coincident;
      joined.duplicate += made.duplicate;
    }
  }

  std::vector<PartOfBlocks> parts_made;
  BoundaryFiles boundary;
  JoinedBoundary joined;  // sums
  std::uint64_t dropped = 0;
  std::uint64_t points_left_out = 0;
  int rounds = 0;
  std::uint64_t named = 0;  // bundles, for all parts

 private:
  BlockRange vertices(std::size_t block) const {
    return block_of(mesh_->vertices(), blocks_, block);
  }

  void partition(std::uint32_t parts) {
    Box box;
    for (std::size_t b = 0; b < blocks_; ++b) {
      const BlockSurvey survey = survey_block(*mesh_, vertices(b));
      box.add(survey.box.lo);
      box.add(survey.box.hi);
    }
    map_ = begin_cells(box, parts);
    for (bool again = true; again;) {
      std::vector<std::string> counted;
      for (std::size_t b = 0; b < blocks_; ++b) {
        counted.push_back(count_block(map_, *mesh_, vertices(b)));
      }
      std::shuffle(counted.begin(), counted.end(), random_);  // as jobs end in any order
      Partition made = partition_blocks(
          map_, blocks_, [&](std::size_t block) { return counted[block]; }, 1);
      map_ = std::move(made.bytes);
      again = made.counts_again;
      bundles_.parts = made.parts;
      ++rounds;
    }
  }

  template <class Make>
  FileRef publish(const Make& make) {
    std::string bytes;
    make([&](std::string_view more) { bytes += more; });
    return stage_.publish(ResultName{++published_, 1, 1}, bytes);
  }

  std::unique_ptr<MeshBlocks> mesh_;
  std::size_t blocks_;
  const Stage& stage_;
  std::string map_;
  BundlesOfMesh bundles_;
  std::uint64_t published_ = 0;
  std::mt19937 random_{7};
};

/// Checks that both cuts of a mesh are the same, part by part; returns the rounds of the cut by
/// blocks.
int check_same_cut(const Mesh& mesh, std::uint32_t parts, std::size_t blocks,
                   PositionType positions = PositionType::float32,
                   Bundles telling = Bundles::tell) {
  CAPTURE(blocks);
  const test::TempFolder folder;
  const auto file = folder.path() / "mesh.ply";
  write_ply(file, mesh, positions);
  const Stage stage = Stage::create(folder.path() / "stage");
  const auto source = open_mesh(file);
  CutOptions options;
  options.parts = parts;
  const Manifest manifest = cut_mesh(*source, stage, options);
  const SteppedCut cut(file, parts, blocks, stage, telling);
  REQUIRE(cut.parts_made.size() == manifest.parts.size());
  WeldCounts sum;
  for (std::size_t p = 0; p < manifest.parts.size(); ++p) {
    CAPTURE(p);
    const PartOfBlocks& made = cut.parts_made[p];
    CHECK(checksum(encode_part(made.part)) == checksum(stage.read(manifest.parts[p].file)));
    CHECK(made.shared_triangles == manifest.parts[p].shared_triangles);
    CHECK(made.shared_boundary == manifest.parts[p].shared_boundary);
    sum.dropped_degenerate += made.dropped_degenerate;
    sum.coincident_vertices += made.coincident_vertices;
    sum.coincident_corners += made.coincident_corners;
  }
  CHECK(read_boundary(stage, cut.boundary) == read_boundary(stage, manifest.boundary));
  CHECK(cut.joined.triangles == manifest.boundary_triangles);
  CHECK(cut.joined.duplicate == manifest.dropped_duplicate);
  CHECK(cut.dropped == manifest.dropped_not_finite);
  CHECK(sum.dropped_degenerate + cut.points_left_out + cut.joined.degenerate ==
        manifest.dropped_degenerate);
  CHECK(sum.coincident_corners + cut.points_left_out + cut.joined.coincident ==
        manifest.coincident_corners);
  return cut.rounds;
}

Mesh out_of_order(Mesh mesh) {
  std::vector<std::uint32_t> order(mesh.positions.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::mt19937 random(3);
  std::shuffle(order.begin(), order.end(), random);
  std::vector<Vec3> positions(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) positions[order[i]] = mesh.positions[i];
  mesh.positions = std::move(positions);
  for (Triangle& t : mesh.triangles) t = {order[t[0]], order[t[1]], order[t[2]]};
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
  return mesh;
}

/// Every triangle with vertices of its own.
Mesh torn_apart(const Mesh& mesh) {
  Mesh soup;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(soup.positions.size());
    for (const std::uint32_t v : t) soup.positions.push_back(mesh.positions[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

}  // namespace

TEST_CASE("a cut by blocks makes the parts and the boundary of the cut, however many blocks") {
  const Mesh mesh = test::torus(60, 40);
  for (const std::size_t blocks : {1U, 3U, 17U, 64U}) check_same_cut(mesh, 5, blocks);
  check_same_cut(mesh, 1, 3);
  check_same_cut(mesh, 12, 7, PositionType::float64);
  check_same_cut(test::torus(120, 80), 40, 5);  // several jobs join its boundary
}

TEST_CASE("a cut by blocks takes vertices and triangles in any order") {
  check_same_cut(out_of_order(test::torus(60, 40)), 6, 5);
}

TEST_CASE("a cut by blocks welds as the cut does") {
  check_same_cut(torn_apart(test::torus(30, 20)), 4, 3);
  check_same_cut(out_of_order(torn_apart(test::torus(30, 20))), 4, 11);
}

TEST_CASE("a cut by blocks is the same where bundles do not tell what they have") {
  for (const Mesh& mesh : {test::torus(60, 40), torn_apart(test::torus(30, 20))}) {
    check_same_cut(mesh, 6, 5, PositionType::float32, Bundles::do_not_tell);
  }
}

TEST_CASE("a part is told of those bundles only that have something of it") {
  const test::TempFolder folder;
  const auto file = folder.path() / "mesh.ply";
  write_ply(file, test::torus(240, 80), PositionType::float32);  // ring by ring
  const Stage stage = Stage::create(folder.path() / "stage");
  constexpr std::uint64_t k_blocks = 24;
  const SteppedCut cut(file, 16, k_blocks, stage);
  CHECK(cut.named < 16 * 2 * k_blocks / 3);
  const Stage other = Stage::create(folder.path() / "other");
  const SteppedCut untold(file, 16, k_blocks, other, Bundles::do_not_tell);
  CHECK(untold.named == 16 * 2 * k_blocks);
}

TEST_CASE("a cut by blocks counts again where vertices are not spread evenly") {
  Mesh mesh = test::torus(60, 40);
  Mesh dense = test::torus(50, 50);
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Vec3& p : dense.positions) mesh.positions.push_back(p * 1e-4 + Vec3{900, 0, 0});
  for (const Triangle& t : dense.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  CHECK(check_same_cut(mesh, 6, 9) > 1);
  CHECK(check_same_cut(out_of_order(mesh), 6, 4) > 1);
}

TEST_CASE("a cut by blocks makes one vertex of a crowd, and leaves out what has no position") {
  Mesh mesh = test::torus(60, 40);
  const Vec3 hole{0.1F, 0.2F, 0.3F};
  for (std::uint32_t i = 0; i < 1200; i += 2) {
    const auto v = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(hole);
    mesh.positions.push_back(hole);
    mesh.triangles.push_back({v, v + 1, i});
    mesh.triangles.push_back({v, v, v + 1});
    mesh.triangles.push_back({i, (i + 1100) % 2400, v});
  }
  mesh.positions[77] = k_no_position;
  for (const std::size_t blocks : {1U, 4U, 13U}) check_same_cut(out_of_order(mesh), 3, blocks);
  check_same_cut(mesh, 5, 6);
}

TEST_CASE("files without records of one size have no blocks") {
  const test::TempFolder folder;
  const auto file = folder.path() / "mesh.ply";
  write_ply(file, test::tetrahedron(), PositionType::float32);
  CHECK(open_blocks(file) != nullptr);
  const std::string bytes = read_file(file);
  const auto write = [&](const std::string& text) {
    const auto other = folder.path() / "other.ply";
    std::ofstream(other, std::ios::binary) << text;
    return open_blocks(other);
  };
  CHECK(write(bytes + " ") == nullptr);
  CHECK(write("off\n") == nullptr);
}
