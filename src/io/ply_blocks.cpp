// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <meshfarm/io/mesh_blocks.hpp>
#include <meshfarm/util/errors.hpp>

#include "byte_stream.hpp"
#include "ply_binary_records.hpp"
#include "ply_header.hpp"

namespace meshfarm {
namespace {

/// Consecutive records of one size.
struct Records {
  std::uint64_t offset = 0;
  std::uint64_t count = 0;
  std::size_t bytes = 0;  // of one
};

class PlyBlocks final : public MeshBlocks {
 public:
  struct Layout {
    PlyFormat format = PlyFormat::binary_little;
    PositionType positions = PositionType::float32;
    Records vertices;
    VertexLayout vertex;
    Records faces;
    TriangleLayout triangle;
  };
  PlyBlocks(InputFile file, const Layout& layout) : file_(std::move(file)), layout_(layout) {}

  std::uint64_t vertices() const override { return layout_.vertices.count; }
  std::uint64_t triangles() const override { return layout_.faces.count; }
  PositionType positions() const override { return layout_.positions; }

  void scan_vertices(const BlockRange& range,
                     const std::function<void(std::span<const Vec3>)>& take) const override {
    std::vector<Vec3> batch;
    read(layout_.vertices, range, [&](const char* records, std::uint64_t, std::size_t count) {
      batch.resize(count);
      layout_.format == PlyFormat::binary_big
          ? decode_vertices<std::endian::big>(layout_.vertex, records, batch)
          : decode_vertices<std::endian::little>(layout_.vertex, records, batch);
      for (Vec3& p : batch) {
        if (!is_finite(p)) p = k_no_position;
      }
      take(batch);
    });
  }

  void scan_triangles(
      const BlockRange& range,
      const std::function<void(std::span<const WideTriangle>)>& take) const override {
    std::vector<WideTriangle> batch;
    read(layout_.faces, range, [&](const char* records, std::uint64_t first, std::size_t count) {
      batch.resize(count);
      const std::size_t decoded =
          layout_.format == PlyFormat::binary_big
              ? decode_triangles<std::endian::big>(layout_.triangle, records, vertices(), batch)
              : decode_triangles<std::endian::little>(layout_.triangle, records, vertices(), batch);
      if (decoded < count) {
        throw DataError(file_.path().string() + ": face " + std::to_string(first + decoded) +
                        ": no triangle, or a vertex index is out of range; '--cut here' reads "
                        "polygons, and tells what is wrong");
      }
      take(batch);
    });
  }

 private:
  template <class Take>
  void read(const Records& records, const BlockRange& range, const Take& take) const {
    constexpr std::size_t k_piece_bytes = std::size_t{1} << 18;  // stays in the caches
    const std::uint64_t most = std::max<std::uint64_t>(1, k_piece_bytes / records.bytes);
    std::vector<char> bytes;
    if (range.first > records.count || range.count > records.count - range.first) {
      throw DataError(file_.path().string() + ": has no such records: it was changed");
    }
    for (std::uint64_t done = 0; done < range.count;) {
      const std::uint64_t count = std::min(most, range.count - done);
      bytes.resize(count * records.bytes);
      file_.read(records.offset + (range.first + done) * records.bytes, bytes);
      take(bytes.data(), range.first + done, count);
      done += count;
    }
  }

  InputFile file_;
  Layout layout_;
};

/// Nothing unless all records that are read have one size and the file ends where it should.
std::optional<PlyBlocks::Layout> layout_of(const PlyHeader& header, std::uint64_t file_bytes) {
  PlyBlocks::Layout layout;
  layout.format = header.format;
  std::uint64_t at = header.size_bytes;
  bool has_faces = false;
  for (const PlyElement& element : header.elements) {
    Records records{at, element.count, element.record_bytes(header.format)};
    if (element.role == PlyRole::faces && element.count > 0) {
      const std::optional<TriangleLayout> triangle = triangle_layout(element);
      if (!triangle || has_faces) return std::nullopt;
      has_faces = true;
      records.bytes = triangle->record_bytes;
      layout.triangle = *triangle;
      layout.faces = records;
    } else if (element.has_lists()) {
      if (element.count > 0) return std::nullopt;
    } else if (element.role == PlyRole::vertices) {
      layout.vertices = records;
      layout.vertex = vertex_layout(element);
      layout.positions = position_type_of(element);
    }
    if (records.bytes != 0 && element.count > (file_bytes - at) / records.bytes) {
      return std::nullopt;
    }
    at += records.count * records.bytes;
  }
  if (at != file_bytes || !has_faces || layout.vertices.count == 0) return std::nullopt;
  return layout;
}

}  // namespace

BlockRange block_of(std::uint64_t records, std::uint64_t blocks, std::uint64_t block) {
  const std::uint64_t size = (records + blocks - 1) / blocks;
  const std::uint64_t first = std::min(records, size * block);
  return {first, std::min(size, records - first)};
}

std::unique_ptr<MeshBlocks> open_blocks(const std::filesystem::path& path) {
  InputFile file(path);
  if (file.compression() != Compression::none) return nullptr;
  const std::unique_ptr<ByteStream> stream = file.open();
  const std::string_view start =
      stream->window(ByteStream::k_max_window_bytes).substr(0, ByteStream::k_max_window_bytes);
  if (!is_ply(start)) return nullptr;
  const PlyHeader header = parse_ply_header(start, path);
  if (header.format == PlyFormat::ascii) return nullptr;
  const std::optional<PlyBlocks::Layout> layout = layout_of(header, file.size());
  if (!layout) return nullptr;
  return std::make_unique<PlyBlocks>(std::move(file), *layout);
}

}  // namespace meshfarm
