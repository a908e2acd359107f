// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The manifest, kind "MNFT", version 9; the payload of a sealed file. Strings are u32 + characters,
// a file is name | size u64 | xxh3-64 u64:
//   input | input format | scheme u8 (0 cut, 1 stream) | partitioner | window u64 | position type
//   u8 | box 6 x f64 | input vertices u64 | input triangles u64 | near merges (distance f64 |
//   vertices u64) | coincident vertices u64 | dropped degenerate u64 | coincident corners u64 |
//   dropped not finite u64 | dropped duplicate u64 |
//   channels u32 x (name | type u8, its bytes | role u8), if any: file | points u64 |
//   columns u8: 1 labels, 2 texture coordinates | of labels: name | materials u32 x (name | colour
//   4 x f32 | with texture coordinates wrap u8 u8 | maps u32 x (use u8 | picture u32)) | label
//   corners u64 | of texture coordinates: floor u64 | side f64 | pictures u32 x (name | file) |
//   skipped u32 x string | cut seconds f64 | boundary triangles u64 | boundary file | its index
//   (offset u64 | size u64 | checksum u64) | sorting | cutting |
//   parts u32 x (file | vertices u64 | triangles u64 | boundary vertices u32 | shared triangles u64
//   | shared boundary vertices u32) | samples u32 x the same: none, or one a part, its file's name
//   empty where it has none
//   sorting = u8 0: parts and streams are there | u8 1: slabs are, and how they are to be sorted
//   (io/sorting.hpp)
//   cutting = u8 0: parts are there | u8 1: path | bytes u64 | changed i64 | parts u32 | vertex
//   blocks u32 | triangle blocks u32; there are no parts then, and the boundary has no name
// Version 1 had no scheme, window and samples, version 2 no sorting, version 3 no partitioner, no
// coincident corners and no dropped not finite, version 4 no channels, version 5 no
// labels, version 6 no index of the boundary, version 7 no cutting and nothing shared, version 8 no
// near merges.
#include <algorithm>
#include <cmath>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/sorting.hpp>
#include <meshfarm/staging/file_ref.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>

#include "io/staged_positions.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_manifest_kind = {'M', 'N', 'F', 'T'};
constexpr std::uint32_t k_manifest_version = 9;

/// A manifest may name only files of the kind that belongs in that place.
template <class Name>
void check_name(const ByteReader& in, const FileRef& file) {
  const auto name = parse_staged_name(file.name);
  if (!name || !std::holds_alternative<Name>(*name)) in.fail("not the name of a staged file");
}

void put_channels(ByteWriter& out, const StagedChannels& staged) {
  out.put(static_cast<std::uint32_t>(staged.channels.size()));
  for (const Channel& channel : staged.channels) {
    out.put_string(channel.name);
    out.put(channel.type);
    out.put(channel.role);
  }
  if (staged.channels.empty()) return;
  put_file(out, staged.file);
  out.put(staged.points);
}

StagedChannels get_channels(ByteReader& in) {
  StagedChannels staged;
  const auto count = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    Channel channel;
    channel.name = in.get_string();
    channel.type = in.get<ChannelType>();
    channel.role = in.get<ChannelRole>();
    const bool is_known = channel.type == ChannelType::uint8 ||
                          channel.type == ChannelType::uint16 ||
                          channel.type == ChannelType::float32;
    if (!is_known || channel.role > ChannelRole::quality) in.fail("an unknown kind of channel");
    staged.channels.push_back(std::move(channel));
  }
  if (staged.channels.empty()) return staged;
  staged.file = get_file(in);
  check_name<ChannelsName>(in, staged.file);
  staged.points = in.get<std::uint64_t>();
  return staged;
}

constexpr std::uint8_t k_has_labels = 1;
constexpr std::uint8_t k_has_uvs = 2;

void put_material(ByteWriter& out, const Material& material, bool uvs) {
  out.put_string(material.name);
  out.put(material.colour);
  if (!uvs) return;
  out.put(material.wrap_u);
  out.put(material.wrap_v);
  out.put(static_cast<std::uint32_t>(material.maps.size()));
  for (const MaterialMap& map : material.maps) {
    out.put(map.use);
    out.put(map.picture);
  }
}

Material get_material(ByteReader& in, bool uvs) {
  Material material;
  material.name = in.get_string();
  material.colour = in.get<std::array<float, 4>>();
  if (!uvs) return material;
  material.wrap_u = in.get<TextureWrap>();
  material.wrap_v = in.get<TextureWrap>();
  if (std::max(material.wrap_u, material.wrap_v) > TextureWrap::clamp) in.fail("unknown wrapping");
  const auto maps = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < maps; ++i) {
    const auto use = in.get<MapUse>();
    if (use > MapUse::emission) in.fail("a picture of no known use");
    material.maps.push_back({use, in.get<std::uint32_t>()});
  }
  return material;
}

/// The columns of the triangles, and what belongs to them.
void put_columns(ByteWriter& out, const Manifest& m) {
  out.put(static_cast<std::uint8_t>((m.labels ? k_has_labels : 0) | (m.uvs ? k_has_uvs : 0)));
  if (m.labels) {
    out.put_string(m.labels->name);
    out.put(static_cast<std::uint32_t>(m.labels->materials.size()));
    for (const Material& material : m.labels->materials) put_material(out, material, m.uvs);
  }
  out.put(m.label_corners);
  if (!m.uvs) return;
  out.put(m.uv_floor);
  out.put(m.uv_side);
  out.put(static_cast<std::uint32_t>(m.pictures.size()));
  for (const StagedPicture& picture : m.pictures) {
    out.put_string(picture.name);
    put_file(out, picture.file);
  }
}

LabelMeaning get_labels(ByteReader& in, bool uvs) {
  LabelMeaning labels;
  labels.name = in.get_string();
  const auto count = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) labels.materials.push_back(get_material(in, uvs));
  return labels;
}

void get_pictures(ByteReader& in, Manifest& m) {
  const auto count = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    StagedPicture picture;
    picture.name = in.get_string();
    picture.file = get_file(in);
    check_name<PictureName>(in, picture.file);
    m.pictures.push_back(std::move(picture));
  }
  if (!m.labels) return;
  for (const Material& material : m.labels->materials) {
    for (const MaterialMap& map : material.maps) {
      if (map.picture >= m.pictures.size()) in.fail("a material with a picture that is not there");
    }
  }
}

void get_columns(ByteReader& in, Manifest& m) {
  const auto columns = in.get<std::uint8_t>();
  if (columns > (k_has_labels | k_has_uvs)) in.fail("unknown columns of triangles");
  m.uvs = (columns & k_has_uvs) != 0;
  if ((columns & k_has_labels) != 0) m.labels = get_labels(in, m.uvs);
  m.label_corners = in.get<std::uint64_t>();
  if (!m.uvs) return;
  m.uv_floor = in.get<std::uint64_t>();
  m.uv_side = in.get<double>();
  if (!(m.uv_side >= 0 && std::isfinite(m.uv_side))) in.fail("impossible size of pictures");
  get_pictures(in, m);
}

void put_parts(ByteWriter& out, const std::vector<PartEntry>& parts) {
  out.put(static_cast<std::uint32_t>(parts.size()));
  for (const PartEntry& part : parts) {
    put_file(out, part.file);
    out.put(part.vertices);
    out.put(part.triangles);
    out.put(part.boundary_vertices);
    out.put(part.shared_triangles);
    out.put(part.shared_boundary);
  }
}

std::vector<PartEntry> get_parts(ByteReader& in) {
  std::vector<PartEntry> parts;
  const auto count = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    PartEntry part;
    part.file = get_file(in);
    part.vertices = in.get<std::uint64_t>();
    part.triangles = in.get<std::uint64_t>();
    part.boundary_vertices = in.get<std::uint32_t>();
    part.shared_triangles = in.get<std::uint64_t>();
    part.shared_boundary = in.get<std::uint32_t>();
    if (part.boundary_vertices > part.vertices) in.fail("more boundary vertices than vertices");
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace

std::uint64_t Manifest::triangles() const {
  if (cutting) return input_triangles;
  std::uint64_t sum = boundary_triangles;
  for (const PartEntry& part : parts) sum += part.triangles;
  return sum;
}

void set_uv_facts(Manifest& manifest, std::span<const UvFacts> of_parts) {
  UvFacts facts;
  for (const UvFacts& each : of_parts) facts += each;
  std::uint64_t inner = 0;
  std::uint64_t all = 0;
  for (const PartEntry& part : manifest.parts) {
    inner += part.vertices - part.boundary_vertices;
    all += part.vertices;
  }
  const double share = inner > 0 ? static_cast<double>(all) / static_cast<double>(inner) : 1;
  manifest.uv_floor = static_cast<std::uint64_t>(share * static_cast<double>(facts.floor));
  manifest.uv_side = facts.side();
}

void put_cutting(ByteWriter& out, const Cutting& cutting) {
  out.put_string(cutting.path);
  out.put(cutting.bytes);
  out.put(cutting.changed_ns);
  out.put(cutting.parts);
  out.put(cutting.vertex_blocks);
  out.put(cutting.triangle_blocks);
}

Cutting get_cutting(ByteReader& in) {
  constexpr std::uint32_t k_most_parts = 1'000'000;
  Cutting cutting;
  cutting.path = in.get_string();
  cutting.bytes = in.get<std::uint64_t>();
  cutting.changed_ns = in.get<std::int64_t>();
  cutting.parts = in.get<std::uint32_t>();
  cutting.vertex_blocks = in.get<std::uint32_t>();
  cutting.triangle_blocks = in.get<std::uint32_t>();
  const auto is_possible = [](std::uint32_t blocks) {
    return blocks > 0 && blocks <= k_most_cut_blocks;
  };
  if (cutting.parts == 0 || cutting.parts > k_most_parts || !is_possible(cutting.vertex_blocks) ||
      !is_possible(cutting.triangle_blocks)) {
    in.fail("impossible cut");
  }
  return cutting;
}

std::string encode_manifest(const Manifest& m) {
  ByteWriter out;
  out.put_string(m.input);
  out.put_string(m.input_format);
  out.put(m.scheme);
  out.put_string(m.partitioner);
  out.put(m.window_triangles);
  out.put(m.positions);
  out.put(m.box.lo);
  out.put(m.box.hi);
  out.put(m.input_vertices);
  out.put(m.input_triangles);
  out.put(m.near_merges.distance);
  out.put(m.near_merges.vertices);
  out.put(m.coincident_vertices);
  out.put(m.dropped_degenerate);
  out.put(m.coincident_corners);
  out.put(m.dropped_not_finite);
  out.put(m.dropped_duplicate);
  put_channels(out, m.channels);
  put_columns(out, m);
  out.put(static_cast<std::uint32_t>(m.skipped.size()));
  for (const std::string& name : m.skipped) out.put_string(name);
  out.put(m.cut_seconds);
  out.put(m.boundary_triangles);
  const BoundaryFile boundary = m.boundary.empty() ? BoundaryFile{} : m.boundary.front();
  put_file(out, boundary.file);
  out.put(boundary.index);
  out.put(static_cast<std::uint8_t>(m.sorting ? 1 : 0));
  if (m.sorting) put(out, *m.sorting);
  out.put(static_cast<std::uint8_t>(m.cutting ? 1 : 0));
  if (m.cutting) put_cutting(out, *m.cutting);
  put_parts(out, m.parts);
  put_parts(out, m.samples);
  return seal(k_manifest_kind, k_manifest_version, out.bytes());
}

Manifest decode_manifest(std::string_view file, std::string_view what) {
  ByteReader in(unseal(file, k_manifest_kind, k_manifest_version, what), what);
  Manifest m;
  m.input = in.get_string();
  m.input_format = in.get_string();
  m.scheme = in.get<Scheme>();
  if (m.scheme > Scheme::stream) in.fail("unknown scheme");
  m.partitioner = in.get_string();
  m.window_triangles = in.get<std::uint64_t>();
  m.positions = get_position_type(in);
  m.box.lo = in.get<Vec3>();
  m.box.hi = in.get<Vec3>();
  m.input_vertices = in.get<std::uint64_t>();
  m.input_triangles = in.get<std::uint64_t>();
  m.near_merges.distance = in.get<double>();
  m.near_merges.vertices = in.get<std::uint64_t>();
  m.coincident_vertices = in.get<std::uint64_t>();
  m.dropped_degenerate = in.get<std::uint64_t>();
  m.coincident_corners = in.get<std::uint64_t>();
  m.dropped_not_finite = in.get<std::uint64_t>();
  m.dropped_duplicate = in.get<std::uint64_t>();
  m.channels = get_channels(in);
  get_columns(in, m);
  const auto skipped = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < skipped; ++i) m.skipped.push_back(in.get_string());
  m.cut_seconds = in.get<double>();
  m.boundary_triangles = in.get<std::uint64_t>();
  BoundaryFile boundary;
  boundary.file = get_file(in);
  boundary.index = in.get<FileSection>();
  const auto unsorted = in.get<std::uint8_t>();
  if (unsorted > (m.scheme == Scheme::stream ? 1 : 0)) in.fail("parts are not to be sorted");
  if (unsorted == 1) m.sorting = get_sorting(in);
  const auto uncut = in.get<std::uint8_t>();
  if (uncut > (m.scheme == Scheme::cut ? 1 : 0)) in.fail("streams are not to be cut");
  if (uncut == 1) m.cutting = get_cutting(in);
  if (!m.cutting) {
    check_name<BoundaryName>(in, boundary.file);
    m.boundary = {boundary};
  }
  m.parts = get_parts(in);
  if (m.cutting && !m.parts.empty()) in.fail("parts that are to be cut");
  for (const PartEntry& part : m.parts) {
    if (m.scheme == Scheme::cut) {
      check_name<PartName>(in, part.file);
    } else if (m.sorting) {
      check_name<SlabName>(in, part.file);
    } else {
      check_name<StreamName>(in, part.file);
    }
  }
  m.samples = get_parts(in);
  const std::size_t most = m.sorting ? 0 : m.parts.size();
  if (!m.samples.empty() && m.samples.size() != most) in.fail("stray samples");
  for (const PartEntry& sample : m.samples) {
    if (!sample.file.name.empty()) check_name<PartName>(in, sample.file);
  }
  in.expect_end();
  return m;
}

}  // namespace meshfarm
