// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The input, all of it little endian:
//   file  = 80 bytes of any text, uint32 count, { facet }
//   facet = float normal[3], float vertex[3][3], uint16 attribute
#include <algorithm>
#include <bit>
#include <string>
#include <utility>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "ply_types.hpp"
#include "stl_reader.hpp"
#include "triangle_maker.hpp"
#include "vertex_store.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_header_bytes = 84;
constexpr std::uint64_t k_facet_bytes = 50;
constexpr std::size_t k_corners_at = 12;

/// A file's size and its count.
struct BinaryStl {
  std::uint64_t bytes = 0;
  std::uint64_t claimed = 0;

  bool has_count() const { return bytes >= k_header_bytes; }
  std::uint64_t whole() const { return (bytes - k_header_bytes) / k_facet_bytes; }
  bool is_whole() const { return has_count() && (bytes - k_header_bytes) % k_facet_bytes == 0; }
  bool is_as_claimed() const { return is_whole() && whole() == claimed; }
};

/// A compressed file is read to the end, as nothing else tells its size.
BinaryStl measure(const InputFile& file) {
  BinaryStl made;
  const std::unique_ptr<ByteStream> stream = file.open();
  const std::string_view start = stream->window(k_header_bytes);
  if (start.size() >= k_header_bytes) {
    made.claimed = load_ply<std::uint32_t, std::endian::little>(start.data() + 80);
  }
  if (const std::optional<std::uint64_t> bytes = stream->remaining()) {
    made.bytes = *bytes;
  } else {
    stream->skip(UINT64_MAX);
    made.bytes = stream->position();
  }
  return made;
}

class BinaryStlSource final : public MeshSource {
 public:
  BinaryStlSource(InputFile file, const OpenOptions& options)
      : file_(std::move(file)), keep_(VertexStore::Keep::no) {
    const bool is_slow = file_.compression() != Compression::none;
    if (is_slow && options.scans == Scans::many) keep_ = VertexStore::Keep::where_possible;
    info_.format = "STL binary";
    info_.compression = name_of(file_.compression());
    info_.faces = triangles();
    info_.vertices = 3 * info_.faces;
    info_.skipped = {"facet.normal", "facet.attribute"};
  }

  const MeshFileInfo& info() const override { return info_; }

  void scan_vertices(const std::function<void(std::span<const Vec3>)>& take) override {
    if (store_.is_filled()) return store_.scan(take);
    store_.fill({info_.positions, info_.vertices, keep_}, take, [&](const VertexStore::Take& pass) {
      read_vertices(pass);
      return true;
    });
  }

  void scan_triangles(const std::function<void(const TriangleView&)>& take) override {
    take_soup(info_.faces, take);
  }

 private:
  std::uint64_t triangles() const {
    const BinaryStl stl = measure(file_);
    const std::string claim = file_.path().string() + ": the header of this STL counts " +
                              std::to_string(stl.claimed) + " triangles, ";
    if (stl.is_as_claimed()) return stl.claimed;
    if (stl.is_whole()) {
      log_warning(claim + "but its size is that of " + std::to_string(stl.whole()) +
                  ", which are read");
      return stl.whole();
    }
    if (!stl.has_count()) {
      throw DataError(file_.path().string() + ": truncated: a binary STL has 84 bytes at least, " +
                      "but the file ends at byte " + std::to_string(stl.bytes));
    }
    if (stl.claimed > stl.whole()) {
      throw DataError(claim + "and would end at byte " +
                      std::to_string(k_header_bytes + k_facet_bytes * stl.claimed) +
                      ", but the file ends at byte " + std::to_string(stl.bytes) +
                      ", in triangle " + std::to_string(stl.whole()));
    }
    log_warning(file_.path().string() + ": there is more in the file than its header says");
    return stl.claimed;
  }

  void read_vertices(const VertexStore::Take& take) const {
    const std::unique_ptr<ByteStream> stream = file_.open();
    if (!stream->skip(k_header_bytes)) fail_changed();
    Batch<Vec3> batch(take);
    for (std::uint64_t done = 0; done < info_.faces;) {
      const std::string_view window = stream->window(k_facet_bytes);
      const auto count = std::min<std::uint64_t>(window.size() / k_facet_bytes, info_.faces - done);
      if (count == 0) fail_changed();
      const char* facet = window.data();
      for (std::uint64_t i = 0; i < count; ++i, facet += k_facet_bytes) add_corners(facet, batch);
      stream->consume(count * k_facet_bytes);
      done += count;
    }
    batch.flush();
  }

  static void add_corners(const char* facet, Batch<Vec3>& batch) {
    const auto real = [facet](std::size_t at) {
      const char* bytes = facet + k_corners_at + at * sizeof(float);
      return static_cast<double>(load_ply<float, std::endian::little>(bytes));
    };
    for (std::size_t corner = 0; corner < 9; corner += 3) {
      const Vec3 p{real(corner), real(corner + 1), real(corner + 2)};
      batch.add(is_finite(p) ? p : k_no_position);
    }
  }

  [[noreturn]] void fail_changed() const {
    throw DataError(file_.path().string() + ": changed while it was read");
  }

  InputFile file_;
  VertexStore::Keep keep_;
  VertexStore store_;
  MeshFileInfo info_;
};

}  // namespace

void take_soup(std::uint64_t triangles, const std::function<void(const TriangleView&)>& take) {
  TriangleBatch batch(take);
  for (std::uint64_t t = 0; t < triangles; ++t) batch.add({3 * t, 3 * t + 1, 3 * t + 2});
  batch.flush();
}

bool is_binary_stl_file(const InputFile& file) {
  const bool is_named = has_extension(file, ".stl");
  // No need to decompress a file of another name to learn that it is something else.
  if (file.compression() != Compression::none && !is_named) return false;
  return is_named || measure(file).is_as_claimed();
}

std::unique_ptr<MeshSource> open_binary_stl(InputFile file, const OpenOptions& options) {
  return std::make_unique<BinaryStlSource>(std::move(file), options);
}

}  // namespace meshfarm
