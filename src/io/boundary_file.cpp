// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The boundary side file, kind "BNDY", version 2; the payload of a sealed file:
//   triangles u64 | parts u32 | columns u32: 1 labels, 2 texture coordinates |
//   for each region of the parts (regions.hpp): its triangles u64 | their checksum u64 |
//   triangles x (3 x (part u32 | local index u32) | label u32, if all have one |
//   texture coordinates 6 x f32, if all have them)
// Everything before the triangles is the index. Version 1 had only the count of triangles.
#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <utility>

#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/regions.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/staging/staged_writer.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

#include "io/staged_positions.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_boundary_kind = {'B', 'N', 'D', 'Y'};
constexpr std::uint32_t k_boundary_version = 2;
constexpr std::uint32_t k_boundary_labels = 1;
constexpr std::uint32_t k_boundary_uvs = 2;

/// The start of the index.
struct Head {
  std::uint64_t triangles = 0;
  std::uint32_t parts = 0;
  std::uint32_t columns = 0;

  std::uint32_t regions() const { return Regions(parts).count(); }
  ColumnSet column_set() const {
    return {(columns & k_boundary_labels) != 0, (columns & k_boundary_uvs) != 0};
  }
  std::uint64_t triangle_bytes() const { return sizeof(BoundaryTriangle) + column_set().bytes(); }
};
static_assert(sizeof(Head) == 16);

static_assert(sizeof(BoundaryRegion) == 16);

std::uint64_t index_bytes(const Head& head) {
  return sizeof(Head) + std::uint64_t{head.regions()} * sizeof(BoundaryRegion);
}

Head get_head(ByteReader& in) {
  const auto head = in.get<Head>();
  if (head.columns > (k_boundary_labels | k_boundary_uvs)) in.fail("unknown columns of triangles");
  return head;
}

Head head_of(std::uint32_t parts, std::uint64_t triangles, const ColumnSet& columns) {
  return {triangles, parts,
          (columns.labels ? k_boundary_labels : 0) | (columns.uvs ? k_boundary_uvs : 0)};
}

std::string encode_index(const Head& head, std::span<const BoundaryRegion> regions) {
  ByteWriter out;
  out.put(head);
  out.put_array(regions);
  return out.take();
}

FileSection section_of(std::string_view index) {
  return {k_seal_head_bytes, index.size(), checksum(index)};
}

std::string encode_triangles(std::span<const BoundaryTriangle> triangles,
                             const TriangleColumnsView& columns) {
  ByteWriter out;
  out.reserve(triangles.size() * (sizeof(BoundaryTriangle) + columns.set().bytes()));
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    out.put(triangles[i]);
    put_columns(out, columns.part(i, 1));
  }
  return out.take();
}

/// Checks that the entries account for all triangles.
void check_entries(const Head& head, std::span<const BoundaryRegion> entries,
                   std::string_view what) {
  std::uint64_t left = head.triangles;
  const bool fits = std::all_of(entries.begin(), entries.end(), [&](const BoundaryRegion& entry) {
    if (entry.triangles > left) return false;
    left -= entry.triangles;
    return true;
  });
  if (!fits || left > 0) {
    throw DataError(std::string(what) + ": other triangles than its regions have");
  }
}

/// The region of a triangle. For consecutive triangles: neighbours mostly lie between the same
/// parts.
class RegionOf {
 public:
  explicit RegionOf(std::uint32_t parts) : regions_(parts) {}
  std::uint32_t operator()(const BoundaryTriangle& t) {
    const auto [least, greatest] = std::minmax({t[0].part, t[1].part, t[2].part});
    if (least != least_ || greatest != greatest_) {
      least_ = least;
      greatest_ = greatest;
      region_ = regions_.of(least, greatest);
    }
    return region_;
  }

 private:
  Regions regions_;
  std::uint32_t least_ = 0;
  std::uint32_t greatest_ = 0;
  std::uint32_t region_ = regions_.of(0, 0);
};

BoundaryTriangle sorted_corners(BoundaryTriangle t) {
  if (t[1] < t[0]) std::swap(t[0], t[1]);
  if (t[2] < t[1]) std::swap(t[1], t[2]);
  if (t[1] < t[0]) std::swap(t[0], t[1]);
  return t;
}

/// Independent of the order of the corners.
std::uint64_t hash_of(const BoundaryTriangle& t) {
  std::uint64_t hash = 0;
  for (const BoundaryCorner& each : t) {
    std::uint64_t mixed = (std::uint64_t{each.part} << 32 | each.local) * 0x9e3779b97f4a7c15ULL;
    mixed ^= mixed >> 29;
    hash += mixed * 0xbf58476d1ce4e5b9ULL;
  }
  return hash ^ hash >> 32;
}

/// Finds out whether a triangle with the same corners, in any order, was already added.
class KnownTriangles {
 public:
  explicit KnownTriangles(std::span<const BoundaryTriangle> all) : all_(all) {
    if (all.size() >= std::numeric_limits<std::uint32_t>::max()) {
      throw DataError("2^32 boundary triangles or more");
    }
  }
  /// Forgets all; at most `most` will be added.
  void begin(std::size_t most) { slots_.assign(std::bit_ceil(2 * most + 1), {}); }
  /// Whether the triangle is new.
  bool add(std::size_t place) {
    const std::uint64_t hash = hash_of(all_[place]);
    const auto tag = static_cast<std::uint32_t>(hash >> 32);
    std::size_t at = hash & (slots_.size() - 1);
    for (; slots_[at].place != 0; at = (at + 1) & (slots_.size() - 1)) {
      if (slots_[at].hash == tag &&
          sorted_corners(all_[slots_[at].place - 1]) == sorted_corners(all_[place])) {
        return false;
      }
    }
    slots_[at] = {tag, static_cast<std::uint32_t>(place + 1)};
    return true;
  }

 private:
  struct Slot {
    std::uint32_t hash = 0;   // tells most others apart without comparing their corners
    std::uint32_t place = 0;  // 1 + the index of the triangle
  };
  std::span<const BoundaryTriangle> all_;
  std::vector<Slot> slots_;
};

/// Appends triangles with their columns.
void get_triangles(ByteReader& in, std::uint64_t count, const ColumnSet& set,
                   std::vector<BoundaryTriangle>& triangles, TriangleColumns& columns) {
  if (!set.any()) {
    const auto more = in.get_array<BoundaryTriangle>(count);
    triangles.insert(triangles.end(), more.begin(), more.end());
    return;
  }
  for (std::uint64_t i = 0; i < count; ++i) {
    triangles.push_back(in.get<BoundaryTriangle>());
    get_columns(in, 1, set, columns);
  }
}

}  // namespace

std::uint64_t drop_duplicates(std::vector<BoundaryTriangle>& triangles) {
  TriangleColumns none;
  return drop_duplicates(triangles, none);
}

std::uint64_t drop_duplicates(std::vector<BoundaryTriangle>& triangles, TriangleColumns& columns) {
  KnownTriangles known(triangles);
  known.begin(triangles.size());
  std::vector<bool> is_new(triangles.size(), false);
  for (std::size_t i = 0; i < triangles.size(); ++i) is_new[i] = known.add(i);
  return keep_triangles(triangles, columns, [&](std::size_t i) { return is_new[i]; });
}

std::uint64_t order_by_region(std::uint32_t parts, std::vector<BoundaryTriangle>& triangles,
                              TriangleColumns& columns) {
  RegionOf region_of(parts);
  std::vector<std::uint32_t> region(triangles.size());
  std::vector<std::size_t> end(Regions(parts).count(), 0);  // by region
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    region[i] = region_of(triangles[i]);
    ++end[region[i]];
  }
  std::exclusive_scan(end.begin(), end.end(), end.begin(), std::size_t{0});
  std::vector<std::uint32_t> order(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    order[end[region[i]]++] = static_cast<std::uint32_t>(i);
  }
  // Duplicates have the same region: a table of its triangles stays in the processor's cache.
  KnownTriangles known(triangles);
  std::vector<BoundaryTriangle> ordered;
  TriangleColumns columns_ordered;
  ordered.reserve(triangles.size());
  for (std::size_t first = 0, r = 0; r < end.size(); first = end[r++]) {
    known.begin(end[r] - first);
    for (std::size_t k = first; k < end[r]; ++k) {
      if (!known.add(order[k])) continue;
      ordered.push_back(triangles[order[k]]);
      columns_ordered.append(columns, order[k]);
    }
  }
  const std::uint64_t dropped = triangles.size() - ordered.size();
  triangles = std::move(ordered);
  columns = std::move(columns_ordered);
  return dropped;
}

EncodedBoundary encode_boundary(std::uint32_t parts, const std::vector<BoundaryTriangle>& triangles,
                                const TriangleColumnsView& columns) {
  RegionOf region_of(parts);
  const Head head = head_of(parts, triangles.size(), columns.set());
  std::vector<BoundaryRegion> regions(head.regions());
  std::string payload(index_bytes(head), '\0');  // filled in below
  payload.reserve(payload.size() + triangles.size() * head.triangle_bytes());
  std::size_t place = 0;
  for (std::uint32_t region = 0; region < regions.size(); ++region) {
    const std::size_t first = place;
    while (place < triangles.size() && region_of(triangles[place]) == region) ++place;
    const std::string bytes = encode_triangles(std::span(triangles).subspan(first, place - first),
                                               columns.part(first, place - first));
    regions[region] = {place - first, checksum(bytes)};
    payload += bytes;
  }
  if (place < triangles.size()) throw Error("boundary triangles are not in the order of regions");
  const std::string index = encode_index(head, regions);
  payload.replace(0, index.size(), index);
  return {seal(k_boundary_kind, k_boundary_version, payload), section_of(index)};
}

BoundaryWriter::BoundaryWriter(const std::filesystem::path& folder, std::uint32_t parts)
    : parts_(parts), scratch_(folder, Regions(parts).count()) {}

void BoundaryWriter::add_region(std::span<const BoundaryTriangle> triangles,
                                const TriangleColumnsView& columns) {
  if (regions_.size() == Regions(parts_).count()) throw Error("more regions than there are");
  const std::string bytes = encode_triangles(triangles, columns);
  scratch_.append(regions_.size(), bytes);
  regions_.push_back({triangles.size(), checksum(bytes)});
  triangles_ += triangles.size();
  if (!triangles.empty()) columns_ = columns.set();
}

BoundaryFile BoundaryWriter::publish(const Stage& stage) {
  if (regions_.size() < Regions(parts_).count()) throw Error("fewer regions than there are");
  scratch_.finish();
  const Head head = head_of(parts_, triangles_, columns_);
  const std::string index = encode_index(head, regions_);
  StagedWriter file(stage, BoundaryName{});
  file.write(seal_head(k_boundary_kind, k_boundary_version,
                       index.size() + triangles_ * head.triangle_bytes()));
  file.write(index);
  for (std::uint32_t region = 0; region < regions_.size(); ++region) {
    const std::vector<char> bytes = scratch_.read<char>(region);
    file.write({bytes.data(), bytes.size()});
  }
  const std::uint64_t hash = file.hash();
  file.write({reinterpret_cast<const char*>(&hash), sizeof hash});
  return {file.commit(), section_of(index), 0};
}

std::vector<BoundaryTriangle> decode_boundary(std::string_view file, std::string_view what) {
  TriangleColumns columns;
  return decode_boundary(file, what, columns);
}

std::vector<BoundaryTriangle> decode_boundary(std::string_view file, std::string_view what,
                                              TriangleColumns& columns) {
  ByteReader in(unseal(file, k_boundary_kind, k_boundary_version, what), what);
  columns.clear();
  const Head head = get_head(in);
  check_entries(head, in.get_array<BoundaryRegion>(head.regions()), what);
  std::vector<BoundaryTriangle> triangles;
  get_triangles(in, head.triangles, head.column_set(), triangles, columns);
  in.expect_end();
  return triangles;
}

void scan_boundary(const Fill& fill, std::string_view what,
                   const std::function<void(std::span<const BoundaryTriangle>,
                                            const TriangleColumnsView&)>& show) {
  constexpr std::uint64_t k_at_once = 4096;
  std::string bytes(k_seal_head_bytes, '\0');
  fill(bytes);
  const std::uint64_t size = unseal_head(bytes, k_boundary_kind, k_boundary_version, what);
  bytes.resize(sizeof(Head));
  fill(bytes);
  ByteReader reader(bytes, what);
  const Head head = get_head(reader);
  const std::uint64_t before = index_bytes(head);
  const std::uint64_t each = head.triangle_bytes();
  if (size < before || (size - before) % each != 0 || (size - before) / each != head.triangles) {
    throw DataError(std::string(what) + ": another size than its count tells");
  }
  bytes.resize(before - sizeof(Head));
  fill(bytes);
  std::vector<BoundaryTriangle> triangles;
  TriangleColumns columns;
  for (std::uint64_t left = head.triangles; left > 0; left -= triangles.size()) {
    const std::uint64_t some = std::min(k_at_once, left);
    bytes.resize(some * each);
    fill(bytes);
    ByteReader in(bytes, what);
    triangles.clear();
    columns.clear();
    get_triangles(in, some, head.column_set(), triangles, columns);
    show(triangles, columns);
  }
  std::uint64_t sum = 0;
  fill({reinterpret_cast<char*>(&sum), sizeof sum});
}

std::vector<BoundaryTriangle> read_boundary(const Stage& stage, const BoundaryFiles& files,
                                            TriangleColumns& columns) {
  columns.clear();
  std::vector<BoundaryTriangle> all;
  for (const BoundaryFile& each : files) {
    TriangleColumns columns_of_more;
    const auto more = decode_boundary(stage.read(each.file), each.file.name, columns_of_more);
    all.insert(all.end(), more.begin(), more.end());
    columns.append(columns_of_more);
  }
  return all;
}

std::vector<BoundaryTriangle> read_boundary(const Stage& stage, const BoundaryFiles& files) {
  TriangleColumns columns;
  return read_boundary(stage, files, columns);
}

BoundaryRegions::BoundaryRegions(const Stage& stage, BoundaryFiles files, std::uint32_t parts)
    : stage_(stage), files_(std::move(files)), parts_(parts), open_(files_.size()) {
  if (files_.empty()) throw DataError("there is no boundary file");
}

BoundaryRegions::Open BoundaryRegions::open(const BoundaryFile& from) const {
  Open made{SectionedFile(stage_, from.file), {}, {}};
  const std::string bytes = made.file.read(from.index);
  ByteReader in(bytes, from.file.name);
  const Head head = get_head(in);
  const auto entries = in.get_array<BoundaryRegion>(head.regions());
  in.expect_end();
  check_entries(head, entries, from.file.name);
  if (head.parts != parts_) in.fail("is not of " + std::to_string(parts_) + " parts");
  made.columns = head.column_set();
  std::uint64_t offset = from.index.offset + from.index.size;
  for (const BoundaryRegion& entry : entries) {
    if (entry.triangles > from.file.size / head.triangle_bytes()) in.fail("too many triangles");
    made.sections.push_back({offset, entry.triangles * head.triangle_bytes(), entry.hash});
    offset += made.sections.back().size;
  }
  return made;
}

void BoundaryRegions::read(std::uint32_t region, std::vector<BoundaryTriangle>& triangles,
                           TriangleColumns& columns) {
  const auto next = std::upper_bound(
      files_.begin() + 1, files_.end(), region,
      [](std::uint32_t wanted, const BoundaryFile& each) { return wanted < each.first_region; });
  const auto number = static_cast<std::size_t>(next - files_.begin()) - 1;
  std::optional<Open>& from = open_[number];
  if (!from) from = open(files_[number]);
  const FileSection& section = from->sections.at(region);
  if (section.size == 0) return;
  const std::string bytes = from->file.read(section);
  ByteReader in(bytes, files_[number].file.name);
  const std::uint64_t each = sizeof(BoundaryTriangle) + from->columns.bytes();
  get_triangles(in, section.size / each, from->columns, triangles, columns);
}

}  // namespace meshfarm
