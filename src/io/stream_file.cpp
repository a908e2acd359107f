// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A stream, version 1, little endian. Vertices are numbered in the order they come.
//   stream = head | blocks, until the head's counts are reached | nothing more
//   head   = "MFRM" | "STRM" | version u32 | byte order u32 0x01020304 | vertex format u8 |
//            boundary vertices u32 | vertices u64 | triangles u64 | sum
//   block  = vertices u32 | boundary vertices u32 | triangles u32 | positions, 3 numbers a vertex |
//            appearances, 4 x u16 a vertex, if the format says so | boundary vertices, ascending,
//            u32: 2 x place among the block's vertices, + 1 if no triangle uses it | triangles x 3
//            x u32: 2 x vertex, + 1 at its last use | labels, u32 a triangle, and texture
//            coordinates, 6 x f32, if the format says so | sum
//   sum    = xxh3-64 of the sum before it (none in the head) and what stands between the two
// A block has at most 65536 vertices and as many triangles; it is never empty. Every vertex is
// finalised once: where it comes if no triangle uses it, else at its last use.
#include <algorithm>
#include <cstring>
#include <utility>

#include <meshfarm/geometry/vertices.hpp>
#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

#include "io/staged_positions.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_stream_magic = {'M', 'F', 'R', 'M'};
constexpr FileKind k_stream_kind = {'S', 'T', 'R', 'M'};
constexpr std::uint32_t k_stream_version = 1;
constexpr std::uint32_t k_byte_order = 0x01020304;
constexpr std::size_t k_head_bytes = 4 + 4 + 4 + 4 + 1 + 4 + 8 + 8;
constexpr std::size_t k_stream_sum_bytes = 8;
constexpr std::size_t k_block_head_bytes = 12;
constexpr std::uint32_t k_most_in_block = 65536;
constexpr std::uint32_t k_triangles_in_block = 16384;  // the writer's target
constexpr std::uint64_t k_most_vertices = std::uint64_t{1} << 31;
constexpr std::size_t k_forget_at = 1 << 16;
constexpr std::uint8_t k_unfinished = 0;
constexpr std::uint8_t k_finished = 1;

/// Chains checksums: that of a piece, continued from the previous sum.
std::uint64_t next_sum(std::uint64_t sum, std::string_view piece) {
  Checksum all;
  all.add({reinterpret_cast<const char*>(&sum), sizeof sum});
  all.add(piece);
  return all.value();
}

std::size_t triangle_bytes(const VertexFormat& format) {
  return sizeof(Triangle) + format.columns.bytes();
}

class StreamEncoder {
 public:
  explicit StreamEncoder(const StreamMesh& stream)
      : stream_(stream),
        format_{stream.positions, !stream.mesh.appearances.empty(), stream.mesh.columns.set()},
        triangles_(stream.mesh.triangles) {
    if (stream.mesh.positions.size() >= k_most_vertices) {
      throw UsageError("a stream would have 2^31 vertices or more; ask for more of them");
    }
    mark_last_uses();
  }

  std::string run() {
    put_head();
    std::size_t first = 0;
    while (first < triangles_.size()) {
      const std::size_t end = end_of_block(first);
      put_block(highest(first, end), first, end);
      first = end;
    }
    const auto all = static_cast<std::uint32_t>(stream_.mesh.positions.size());
    while (vertices_ < all) put_block(std::min(all, vertices_ + k_most_in_block), first, first);
    return std::move(file_);
  }

 private:
  /// Goes backwards: the first use that it meets is the last one.
  void mark_last_uses() {
    used_.assign(stream_.mesh.positions.size(), 0);
    codes_.resize(triangles_.size());
    for (std::size_t i = triangles_.size(); i-- > 0;) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = triangles_[i][k];
        const std::uint32_t last = used_[vertex] == 0 ? 1 : 0;
        used_[vertex] = 1;
        codes_[i][k] = vertex << 1 | last;
      }
    }
  }

  static std::uint32_t highest_corner(const Triangle& t) { return std::max({t[0], t[1], t[2]}); }

  /// One past the highest vertex of the triangles and of all earlier blocks.
  std::uint32_t highest(std::size_t first, std::size_t end) const {
    std::uint32_t vertices = vertices_;
    for (std::size_t i = first; i < end; ++i) {
      vertices = std::max(vertices, highest_corner(triangles_[i]) + 1);
    }
    return vertices;
  }

  /// The end of the block that begins with this triangle. First puts blocks of vertices only, if
  /// the first triangle reaches that far ahead.
  std::size_t end_of_block(std::size_t first) {
    while (highest(first, first + 1) - vertices_ > k_most_in_block) {
      put_block(vertices_ + k_most_in_block, first, first);
    }
    std::size_t end = first;
    const std::size_t most = std::min<std::size_t>(triangles_.size(), first + k_triangles_in_block);
    std::uint32_t vertices = vertices_;
    for (; end < most; ++end) {
      vertices = std::max(vertices, highest_corner(triangles_[end]) + 1);
      if (vertices - vertices_ > k_most_in_block) break;
    }
    return end;
  }

  void put_head() {
    ByteWriter out;
    out.put(k_stream_magic);
    out.put(k_stream_kind);
    out.put(k_stream_version);
    out.put(k_byte_order);
    put_vertex_format(out, format_);
    out.put(static_cast<std::uint32_t>(
        std::count(stream_.boundary.begin(), stream_.boundary.end(), 1)));
    out.put(static_cast<std::uint64_t>(stream_.mesh.positions.size()));
    out.put(static_cast<std::uint64_t>(triangles_.size()));
    sum_ = checksum(out.bytes());
    out.put(sum_);
    const std::size_t all = stream_.mesh.positions.size() * format_.bytes() +
                            triangles_.size() * triangle_bytes(format_);
    file_.reserve(all + all / 64 + 4096);
    file_ += out.bytes();
  }

  void put_block(std::uint32_t end_vertex, std::size_t first, std::size_t end) {
    std::vector<std::uint32_t> boundary;
    for (std::uint32_t v = vertices_; v < end_vertex; ++v) {
      if (stream_.boundary[v] != 0) boundary.push_back((v - vertices_) << 1 | (used_[v] ^ 1U));
    }
    ByteWriter out;
    out.put(end_vertex - vertices_);
    out.put(static_cast<std::uint32_t>(boundary.size()));
    out.put(static_cast<std::uint32_t>(end - first));
    const VertexView all(stream_.mesh);
    put_vertices(out, all.part(vertices_, end_vertex - vertices_), format_);
    out.put_array(std::span<const std::uint32_t>(boundary));
    out.put_array(std::span<const Triangle>(codes_).subspan(first, end - first));
    const TriangleColumnsView columns = stream_.mesh.columns;
    put_columns(out, columns.part(first, end - first));
    sum_ = next_sum(sum_, out.bytes());
    out.put(sum_);
    file_ += out.bytes();
    vertices_ = end_vertex;
  }

  const StreamMesh& stream_;
  VertexFormat format_;
  const std::vector<Triangle>& triangles_;
  std::vector<std::uint8_t> used_;
  std::vector<Triangle> codes_;
  std::uint32_t vertices_ = 0;  // put so far
  std::uint64_t sum_ = 0;
  std::string file_;
};

}  // namespace

std::string encode_stream(const StreamMesh& stream) {
  return StreamEncoder(stream).run();
}

StreamReader::StreamReader(Fill fill, std::string what)
    : fill_(std::move(fill)), what_(std::move(what)) {
  read_head();
}

void StreamReader::fail(const std::string& why) const {
  throw DataError(what_ + ": block " + std::to_string(block_) + ": " + why);
}

void StreamReader::read_head() {
  bytes_.resize(k_head_bytes + k_stream_sum_bytes);
  fill_(bytes_);
  ByteReader in(bytes_, what_);
  if (in.get<FileKind>() != k_stream_magic) in.fail("not a meshfarm file");
  if (in.get<FileKind>() != k_stream_kind) in.fail("not a stream");
  if (in.get<std::uint32_t>() != k_stream_version) in.fail("a stream of an unknown version");
  if (in.get<std::uint32_t>() != k_byte_order) in.fail("written with another byte order");
  sum_ = checksum(std::string_view(bytes_).substr(0, k_head_bytes));
  const VertexFormat format = get_vertex_format(in);
  info_.positions = format.positions;
  info_.appearances = format.appearances;
  info_.columns = format.columns;
  info_.boundary_vertices = in.get<std::uint32_t>();
  info_.vertices = in.get<std::uint64_t>();
  info_.triangles = in.get<std::uint64_t>();
  if (in.get<std::uint64_t>() != sum_) in.fail("damaged head (checksum)");
  if (info_.vertices >= k_most_vertices) in.fail("too many vertices for a stream");
  if (info_.boundary_vertices > info_.vertices) in.fail("more boundary vertices than vertices");
}

bool StreamReader::next(StreamBlock& block) {
  if (vertices_ == info_.vertices && triangles_ == info_.triangles) return false;
  bytes_.resize(k_block_head_bytes);
  fill_(bytes_);
  std::array<std::uint32_t, 3> counts{};
  std::memcpy(counts.data(), bytes_.data(), k_block_head_bytes);
  const std::uint32_t vertices = counts[0];
  const std::uint32_t boundary = counts[1];
  const std::uint32_t triangles = counts[2];
  if (vertices > k_most_in_block || triangles > k_most_in_block || boundary > vertices) {
    fail("damaged: impossible counts");
  }
  if (vertices + triangles == 0) fail("empty, before the end of the stream");
  if (vertices > info_.vertices - vertices_ || triangles > info_.triangles - triangles_) {
    fail("more than the head of the stream says");
  }
  const VertexFormat format{info_.positions, info_.appearances, info_.columns};
  const std::size_t size = k_block_head_bytes + vertices * format.bytes() +
                           boundary * sizeof(std::uint32_t) + triangles * triangle_bytes(format);
  bytes_.resize(size + k_stream_sum_bytes);
  fill_(std::span<char>(bytes_).subspan(k_block_head_bytes));
  sum_ = next_sum(sum_, std::string_view(bytes_).substr(0, size));
  std::uint64_t stored = 0;
  std::memcpy(&stored, bytes_.data() + size, k_stream_sum_bytes);
  if (stored != sum_) fail("damaged (checksum)");
  ByteReader in(bytes_, what_);
  in.take(k_block_head_bytes);
  block.positions.clear();
  block.appearances.clear();
  get_vertices(in, vertices, format, block.positions, block.appearances);
  block.boundary = in.get_array<StreamCorner>(boundary);
  block.triangles = in.get_array<std::array<StreamCorner, 3>>(triangles);
  block.columns.clear();
  get_columns(in, triangles, format.columns, block.columns);
  add_vertices(block);
  for (std::size_t i = 0; i < block.triangles.size(); ++i) finish_corners(block.triangles[i], i);
  ++block_;
  triangles_ += triangles;
  if (states_.size() > 2 * k_forget_at) forget_finished();
  if (vertices_ == info_.vertices && triangles_ == info_.triangles) check_end();
  return true;
}

/// Adds the states of the new vertices.
void StreamReader::add_vertices(const StreamBlock& block) {
  states_.resize(states_.size() + block.positions.size(), k_unfinished);
  unfinished_ += block.positions.size();
  std::uint32_t next = 0;
  for (const StreamCorner corner : block.boundary) {
    if (corner.vertex() < next || corner.vertex() >= block.positions.size()) {
      fail("boundary vertices out of order");
    }
    next = corner.vertex() + 1;
    if (corner.last_use()) finish(vertices_ + corner.vertex());
  }
  boundary_ += block.boundary.size();
  if (boundary_ > info_.boundary_vertices) fail("more boundary vertices than the head says");
  vertices_ += block.positions.size();
}

void StreamReader::finish(std::uint64_t vertex) {
  states_[vertex - first_state_] = k_finished;
  --unfinished_;
}

void StreamReader::finish_corners(const std::array<StreamCorner, 3>& triangle, std::size_t index) {
  const auto refuse = [&](StreamCorner corner, const char* why) {
    fail("triangle " + std::to_string(triangles_ + index) + " uses vertex " +
         std::to_string(corner.vertex()) + why);
  };
  for (const StreamCorner corner : triangle) {
    const std::uint64_t vertex = corner.vertex();
    if (vertex >= vertices_) refuse(corner, ", which is not there yet");
    if (vertex < first_state_ || states_[vertex - first_state_] == k_finished) {
      refuse(corner, ", which was finalised before");
    }
    if (corner.last_use()) finish(vertex);
  }
}

/// Forgets the states of the oldest vertices, up to the first that is unfinished.
void StreamReader::forget_finished() {
  const auto first = std::find(states_.begin(), states_.end(), k_unfinished);
  if (static_cast<std::size_t>(first - states_.begin()) < k_forget_at) return;
  first_state_ += static_cast<std::uint64_t>(first - states_.begin());
  states_.erase(states_.begin(), first);
}

void StreamReader::check_end() const {
  if (unfinished_ > 0) fail(std::to_string(unfinished_) + " vertices are never finalised");
  if (boundary_ != info_.boundary_vertices) fail("fewer boundary vertices than the head says");
}

bool is_stream(std::string_view start) {
  const std::array<FileKind, 2> kinds = {k_stream_magic, k_stream_kind};
  return start.size() >= sizeof kinds && std::memcmp(start.data(), &kinds, sizeof kinds) == 0;
}

StreamMesh read_stream_mesh(StreamReader& reader) {
  StreamMesh stream;
  stream.positions = reader.info().positions;
  StreamBlock block;
  while (reader.next(block)) {
    const std::size_t first = stream.mesh.positions.size();
    append_vertices({block.positions, block.appearances}, stream.mesh);
    stream.boundary.resize(stream.mesh.positions.size(), 0);
    for (const StreamCorner vertex : block.boundary) stream.boundary[first + vertex.vertex()] = 1;
    for (const auto& [a, b, c] : block.triangles) {
      stream.mesh.triangles.push_back({a.vertex(), b.vertex(), c.vertex()});
    }
    stream.mesh.columns.append(block.columns);
  }
  return stream;
}

Part read_stream(StreamReader& reader) {
  const StreamInfo& info = reader.info();
  Part part;
  part.positions = info.positions;
  part.boundary_vertices = info.boundary_vertices;
  resize_vertices(part.mesh, info.boundary_vertices, info.appearances);
  std::vector<std::uint32_t> number;  // of each vertex of the stream: its index in the part
  std::uint32_t boundary = 0;
  StreamBlock block;
  while (reader.next(block)) {
    std::size_t next_boundary = 0;
    const VertexView vertices = {block.positions, block.appearances};
    for (std::uint32_t i = 0; i < block.positions.size(); ++i) {
      if (next_boundary < block.boundary.size() && block.boundary[next_boundary].vertex() == i) {
        ++next_boundary;
        put_vertex(vertices, i, part.mesh, boundary);
        number.push_back(boundary++);
      } else {
        number.push_back(static_cast<std::uint32_t>(part.mesh.positions.size()));
        append_vertex(vertices, i, part.mesh);
      }
    }
    for (const auto& [a, b, c] : block.triangles) {
      part.mesh.triangles.push_back({number[a.vertex()], number[b.vertex()], number[c.vertex()]});
    }
    part.mesh.columns.append(block.columns);
  }
  return part;
}

Part decode_part_or_stream(std::string_view file, const std::string& what) {
  if (!is_stream(file)) return decode_part(file, what);
  StreamReader reader(fill_from(file, what), what);
  return read_stream(reader);
}

}  // namespace meshfarm
