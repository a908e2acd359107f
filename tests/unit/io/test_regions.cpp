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

/// Halves `range` while one half holds both parts; returns the number of the last region.
std::uint32_t lowest_region(PartRange range, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t middle = range.first + (range.end - range.first) / 2;
  if (b < middle) return lowest_region({range.first, middle}, a, b);
  if (a >= middle) return lowest_region({middle, range.end}, a, b);
  return middle - 1;
}

/// A triangle between each pair of parts, labelled by the pair.
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
  BoundaryRegions reader(stage, {{file, encoded.index, 0}}, parts);
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

TEST_CASE("a side file that is made a region at a time is the same") {
  for (const bool is_empty : {false, true}) {
    const std::uint32_t parts = 11;
    std::vector<Label> labels;
    Triangles triangles = all_pairs(parts, labels);
    if (is_empty) triangles.clear(), labels.clear();
    TriangleColumns columns{labels, {}};
    order_by_region(parts, triangles, columns);
    const EncodedBoundary encoded = encode_boundary(parts, triangles, columns);
    const TempFolder folder;
    const Stage stage = Stage::create(folder.path());
    BoundaryWriter writer(folder.path(), parts);
    const Regions regions(parts);
    for (std::uint32_t region = 0, first = 0, end = 0; region < regions.count(); ++region) {
      first = end;
      while (end < triangles.size() &&
             regions.of(triangles[end][0].part, triangles[end][1].part) == region) {
        ++end;
      }
      const auto count = end - first;
      writer.add_region(std::span(triangles).subspan(first, count),
                        TriangleColumnsView(columns).part(first, count));
    }
    CHECK(writer.triangles() == triangles.size());
    const BoundaryFile written = writer.publish(stage);
    CHECK(stage.read(written.file) == encoded.file);
    CHECK(written.index.size == encoded.index.size);
    CHECK(written.index.hash == encoded.index.hash);
  }
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
  bytes[bytes.size() - 12] ^= 1;  // just before the checksum of the whole file
  const FileRef file = stage.publish(BoundaryName{}, bytes);
  BoundaryRegions reader(stage, {{file, encoded.index, 0}}, 4);
  Triangles read;
  reader.read(0, read, none);
  CHECK(read.size() == 1);
  CHECK_THROWS_AS(reader.read(2, read, none), DataError);
  const auto refuses = [&](const FileSection& index, std::uint32_t parts) {
    BoundaryRegions other(stage, {{file, index, 0}}, parts);
    CHECK_THROWS_AS(other.read(0, read, none), DataError);
  };
  refuses(encoded.index, 5);
  FileSection index = encoded.index;
  index.size -= 16;
  refuses(index, 4);
  index = encoded.index;
  index.offset = file.size;
  refuses(index, 4);
  CHECK_THROWS_AS(BoundaryRegions(stage, {}, 4), DataError);
}

TEST_CASE("a boundary in several files is read as one") {
  for (const std::uint32_t parts : {1U, 2U, 9U, 40U, 200U}) {
    CAPTURE(parts);
    std::vector<Label> labels;
    Triangles triangles = all_pairs(parts, labels);
    TriangleColumns columns{labels, {}};
    order_by_region(parts, triangles, columns);
    const TempFolder folder;
    const Stage stage = Stage::create(folder.path());
    const RegionGroups groups(parts);
    BoundaryFiles files;
    for (std::uint32_t group = 0; group < groups.count(); ++group) {
      Triangles some;
      TriangleColumns some_columns;
      for (std::size_t i = 0; i < triangles.size(); ++i) {
        const BoundaryTriangle& t = triangles[i];
        if (groups.of(t[0].part, t[1].part, t[2].part) != group) continue;
        some.push_back(t);
        some_columns.append(columns, i);
      }
      const EncodedBoundary encoded = encode_boundary(parts, some, some_columns);
      files.push_back({stage.publish(ResultName{group, 1, 1}, encoded.file), encoded.index,
                       groups.first_region(group)});
    }
    TriangleColumns read_columns;
    CHECK(read_boundary(stage, files, read_columns) == triangles);
    CHECK(read_columns.labels == columns.labels);
    BoundaryRegions reader(stage, files, parts);
    Triangles read;
    read_columns.clear();
    for (std::uint32_t region = 0; region < Regions(parts).count(); ++region) {
      reader.read(region, read, read_columns);
    }
    CHECK(read == triangles);
    CHECK(read_columns.labels == columns.labels);
    ByteWriter out;
    put_boundary(out, files);
    ByteReader in(out.bytes(), "boundary");
    const BoundaryFiles back = get_boundary(in);
    CHECK(bytes_of(back) == bytes_of(files));
    CHECK(back.back().first_region == files.back().first_region);
  }
}

TEST_CASE("boundary files in another order, or none, are refused") {
  const auto refused = [](const BoundaryFiles& files) {
    ByteWriter out;
    put_boundary(out, files);
    ByteReader in(out.bytes(), "boundary");
    CHECK_THROWS_AS(get_boundary(in), DataError);
  };
  refused({});
  refused({{{"boundary", 1, 2}, {}, 1}});
  refused({{{"boundary", 1, 2}, {}, 0}, {{"boundary", 1, 2}, {}, 4}, {{"boundary", 1, 2}, {}, 3}});
}

}  // namespace
}  // namespace meshfarm::test
