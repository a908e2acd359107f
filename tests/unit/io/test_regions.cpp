// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/regions.hpp>
#include <meshfarm/util/errors.hpp>

#include "support/damage.hpp"
#include "support/temp_folder.hpp"

namespace meshfarm::test {
namespace {

using Triangles = std::vector<BoundaryTriangle>;

/// The halves of a region of `range` that hold both parts, one within the other: the last has the
/// number.
std::uint32_t lowest_region(PartRange range, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t middle = range.first + (range.end - range.first) / 2;
  if (b < middle) return lowest_region({range.first, middle}, a, b);
  if (a >= middle) return lowest_region({middle, range.end}, a, b);
  return middle - 1;
}

/// A triangle between each pair of parts, and its parts as its label.
Triangles all_pairs(std::uint32_t parts, std::vector<Label>& labels) {
  Triangles triangles;
  for (std::uint32_t a = 0; a < parts; ++a) {
    for (std::uint32_t b = a + 1; b < parts; ++b) {
      triangles.push_back({{{b, 1}, {a, 2}, {a, 3}}});
      labels.push_back(100 * a + b);
    }
  }
  return triangles;
}

TEST_CASE("the lowest region of two parts is the one whose halves part them") {
  for (const std::uint32_t parts : {2U, 3U, 7U, 16U, 29U}) {
    const Regions regions(parts);
    CHECK(regions.count() == parts - 1);
    for (std::uint32_t a = 0; a < parts; ++a) {
      for (std::uint32_t b = a + 1; b < parts; ++b) {
        CHECK(regions.of(a, b) == lowest_region({0, parts}, a, b));
        CHECK(regions.of(b, a) == regions.of(a, b));
      }
      CHECK(regions.of(a, a) < regions.count());
    }
  }
  CHECK(Regions(1).count() == 1);
  CHECK(Regions(1).of(0, 0) == 0);
}

TEST_CASE("the regions of a group are those of its triangles, but for what lies in a piece") {
  const std::uint32_t parts = 29;
  const Regions regions(parts);
  for (const std::vector<PartRange>& pieces : {std::vector<PartRange>{{3, 4}, {4, 5}, {5, 6}},
                                               {{0, 7}, {7, 14}},
                                               {{10, 12}, {12, 21}},
                                               {{28, 29}},
                                               {{0, 29}}}) {
    const auto piece_of = [&](std::uint32_t part) {
      const auto at = std::find_if(pieces.begin(), pieces.end(), [&](const PartRange& piece) {
        return piece.first <= part && part < piece.end;
      });
      return at - pieces.begin();
    };
    const std::vector<std::uint32_t> touched = regions.touched_by(pieces);
    CHECK(std::is_sorted(touched.begin(), touched.end()));
    const auto none = static_cast<std::ptrdiff_t>(pieces.size());
    for (std::uint32_t a = 0; a < parts; ++a) {
      for (std::uint32_t b = a + 1; b < parts; ++b) {
        if (piece_of(a) == none && piece_of(b) == none) continue;
        if (piece_of(a) == piece_of(b)) continue;
        CHECK(std::binary_search(touched.begin(), touched.end(), regions.of(a, b)));
      }
    }
  }
  CHECK(regions.touched_by({{0, 29}}).empty());
  CHECK(regions.touched_by({{0, 7}}).size() == 2);  // the two regions that hold it
}

TEST_CASE("a region's boundary triangles are read without the others") {
  const std::uint32_t parts = 11;
  std::vector<Label> labels;
  Triangles triangles = all_pairs(parts, labels);
  TriangleColumns columns{labels, {}};
  order_by_region(parts, triangles, columns);
  const TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  const EncodedBoundary encoded = encode_boundary(parts, triangles, columns);
  const FileRef file = stage.publish(BoundaryName{}, encoded.file);
  const BoundaryRegions reader(stage, file, encoded.index);
  CHECK(reader.parts() == parts);
  const Regions regions(parts);
  Triangles all;
  TriangleColumns all_columns;
  for (std::uint32_t region = 0; region < regions.count(); ++region) {
    const std::size_t before = all.size();
    reader.read(region, all, all_columns);
    REQUIRE(all.size() > before);
    for (std::size_t i = before; i < all.size(); ++i) {
      CHECK(regions.of(all[i][0].part, all[i][1].part) == region);
      CHECK(all_columns.labels[i] == 100 * all[i][1].part + all[i][0].part);
    }
  }
  CHECK(all == triangles);

  std::swap(triangles.front(), triangles.back());
  CHECK_THROWS_AS(encode_boundary(parts, triangles, columns), Error);
}

TEST_CASE("of boundary triangles with the same corners the first stays") {
  const std::uint32_t parts = 11;
  std::vector<Label> labels;
  Triangles once = all_pairs(parts, labels);
  TriangleColumns columns_once{labels, {}};
  Triangles twice = once;
  TriangleColumns columns_twice = columns_once;
  for (const auto& [a, b, c] : once) {
    twice.push_back({c, b, a});
    columns_twice.labels.push_back(7);
  }
  CHECK(order_by_region(parts, once, columns_once) == 0);
  CHECK(order_by_region(parts, twice, columns_twice) == once.size());
  CHECK(twice == once);
  CHECK(columns_twice.labels == columns_once.labels);
}

TEST_CASE("a damaged region is refused, and the others are read") {
  std::vector<Label> labels;
  Triangles triangles = all_pairs(4, labels);
  TriangleColumns none;
  order_by_region(4, triangles, none);
  const TempFolder folder;
  const Stage stage = Stage::create(folder.path());
  const EncodedBoundary encoded = encode_boundary(4, triangles);
  std::string bytes = encoded.file;
  bytes[bytes.size() - 12] ^= 1;  // before the checksum of the whole
  const FileRef file = stage.publish(BoundaryName{}, bytes);
  const BoundaryRegions reader(stage, file, encoded.index);
  Triangles read;
  reader.read(0, read, none);
  CHECK(read.size() == 1);
  CHECK_THROWS_AS(reader.read(2, read, none), DataError);
  FileSection other = encoded.index;
  other.size -= 16;
  CHECK_THROWS_AS(BoundaryRegions(stage, file, other), DataError);
  other = encoded.index;
  other.offset = file.size;
  CHECK_THROWS_AS(BoundaryRegions(stage, file, other), DataError);
}

}  // namespace
}  // namespace meshfarm::test
