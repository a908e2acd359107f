// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <bit>
#include <cmath>
#include <vector>

#include <meshfarm/util/errors.hpp>

#include "ply_binary_records.hpp"
#include "ply_body.hpp"

namespace meshfarm {
namespace {

/// How many values fit. Sizes are powers of two; a division per list would be noticeable.
std::uint64_t items_in(std::uint64_t bytes, PlyType type) {
  return bytes >> std::countr_zero(size_of(type));
}

/// Records of a binary PLY file.
template <std::endian Order>
class BinaryBody final : public PlyBody {
 public:
  BinaryBody(std::unique_ptr<ByteStream> stream, const std::filesystem::path& path)
      : stream_(std::move(stream)), path_(path) {}

  void read_vertices(const PlyElement& element, Batch<Vec3>& batch) override {
    begin(element);
    if (element.has_lists()) {
      for (; index_ < element.count; ++index_) read_vertex(batch);
    } else {
      read_vertex_runs(batch);
    }
    batch.flush();
  }

  void read_channels(const PlyElement& element, std::span<const PlyChannel> channels,
                     ChannelBatch& batch) override {
    begin(element);
    ChannelRow row(element, channels);
    for (; index_ < element.count; ++index_) {
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (row.wants(i)) {
          row.set(i, load_real<Order>(property.type, need(size_of(property.type))));
        }
        skip(property);
      }
      row.add_to(batch);
    }
    batch.flush();
  }

  void read_corners(const PlyElement& element, TriangleMaker& maker) override {
    begin(element);
    const std::optional<TriangleLayout> layout = triangle_layout(element);
    while (index_ < element.count) {
      if (layout && read_triangle_run(*layout, maker) > 0) continue;
      read_polygon(maker);
      ++index_;
    }
    maker.batch().flush();
  }

  void skip(const PlyElement& element) override {
    begin(element);
    if (element.has_lists()) {
      for (; index_ < element.count; ++index_) {
        for (const PlyProperty& property : element.properties) skip(property);
      }
      return;
    }
    const std::uint64_t record = element.record_bytes(PlyFormat::binary_little);
    if (record == 0) return;
    const std::uint64_t start = stream_->position();
    // A product beyond 64 bits is beyond any file, too.
    const bool too_many = element.count > UINT64_MAX / record;
    if (!stream_->skip(too_many ? UINT64_MAX : element.count * record)) {
      index_ = (stream_->position() - start) / record;
      fail_truncated();
    }
  }

  bool at_end() override { return stream_->window(1).empty(); }
  bool has_lost_digits() const override { return false; }
  std::string take_oddity() override { return {}; }

 private:
  void begin(const PlyElement& element) {
    element_ = &element;
    index_ = 0;
  }

  [[noreturn]] void fail(const std::string& why) const {
    throw DataError(path_.string() + ": " + element_->name + " " + std::to_string(index_) +
                    " at byte " + std::to_string(stream_->position()) + ": " + why);
  }
  [[noreturn]] void fail_truncated() const {
    throw DataError(path_.string() + ": truncated: the file ends at byte " +
                    std::to_string(stream_->position() + stream_->window(0).size()) + ", inside " +
                    element_->name + " " + std::to_string(index_) + " of " +
                    std::to_string(element_->count));
  }
  [[noreturn]] void fail_index(std::int64_t index, std::uint64_t vertices) const {
    fail("vertex index " + std::to_string(index) + " is out of range: there are " +
         std::to_string(vertices) + " vertices");
  }

  /// The next `count` bytes.
  const char* need(std::size_t count) {
    const std::string_view window = stream_->window(count);
    if (window.size() < count) fail_truncated();
    return window.data();
  }

  void read_vertex_runs(Batch<Vec3>& batch) {
    const VertexLayout layout = vertex_layout(*element_);
    while (index_ < element_->count) {
      need(layout.record_bytes);
      const std::span<Vec3> room = batch.room();
      const std::size_t whole = stream_->window(0).size() / layout.record_bytes;
      const auto count = std::min<std::uint64_t>({whole, room.size(), element_->count - index_});
      decode_vertices<Order>(layout, stream_->window(0).data(), room.first(count));
      for (Vec3& p : room.first(count)) {
        if (!is_finite(p)) p = k_no_position;
      }
      stream_->consume(count * layout.record_bytes);
      index_ += count;
      batch.added(count);
    }
  }

  void read_vertex(Batch<Vec3>& batch) {
    std::array<double, 3> xyz{};
    for (std::size_t i = 0; i < element_->properties.size(); ++i) {
      const PlyProperty& property = element_->properties[i];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (element_->axes[axis] != i) continue;
        xyz[axis] = load_real<Order>(property.type, need(size_of(property.type)));
      }
      skip(property);
    }
    const Vec3 p{xyz[0], xyz[1], xyz[2]};
    batch.add(is_finite(p) ? p : k_no_position);
  }

  /// Reads consecutive records of triangles, without looking at each property. Returns how many.
  std::size_t read_triangle_run(const TriangleLayout& layout, TriangleMaker& maker) {
    const std::string_view window = stream_->window(layout.record_bytes);
    const std::span<WideTriangle> room = maker.batch().room();
    const auto most = std::min<std::uint64_t>(
        {window.size() / layout.record_bytes, room.size(), element_->count - index_});
    const std::size_t count =
        decode_triangles<Order>(layout, window.data(), maker.vertices(), room.first(most));
    if (element_->label) {
      decode_labels<Order>(layout, window.data(), maker.batch().label_room().first(count));
      maker.batch().wrote_labels(count);
    }
    if (element_->uvs) {
      decode_uvs<Order>(layout, window.data(), maker.batch().uv_room().first(count));
      maker.batch().wrote_uvs(count);
    }
    maker.batch().added(count);
    stream_->consume(count * layout.record_bytes);
    index_ += count;
    return count;
  }

  void read_polygon(TriangleMaker& maker) {
    maker.begin(corner_order(*element_));
    uvs_.clear();
    for (std::size_t i = 0; i < element_->properties.size(); ++i) {
      const PlyProperty& property = element_->properties[i];
      if (i == element_->label) {
        maker.label(load_label<Order>(property.type, need(size_of(property.type))));
      }
      if (i == element_->index_list) {
        read_corner_list(property, maker);
      } else if (i == element_->uvs) {
        read_uv_list(property);
      } else {
        skip(property);
      }
    }
    maker.uvs(uvs_);
    maker.end();
  }

  void read_corner_list(const PlyProperty& property, TriangleMaker& maker) {
    const std::size_t size = size_of(property.type);
    std::uint64_t left = read_list_length(property);
    if (element_->has_late_label() && left > TriangleMaker::k_most_held_corners) {
      fail(TriangleMaker::k_too_long_for_label);
    }
    while (left > 0) {
      const char* bytes = need(size);
      const std::size_t count = std::min(left, items_in(stream_->window(0).size(), property.type));
      for (std::size_t i = 0; i < count; ++i) {
        const std::optional<std::int64_t> index =
            load_whole<Order>(property.type, bytes + i * size);
        if (index && maker.corner(*index)) continue;
        stream_->consume(i * size);
        if (!index) fail("a vertex index is not a whole number");
        fail_index(*index, maker.vertices());
      }
      stream_->consume(count * size);
      left -= count;
    }
  }

  /// Those of a face with too many corners to be kept are not kept.
  void read_uv_list(const PlyProperty& property) {
    const std::size_t size = size_of(property.type);
    std::uint64_t left = read_list_length(property);
    const bool are_kept = left % 2 == 0 && left / 2 <= TriangleMaker::k_most_held_corners;
    for (std::uint64_t i = 0; left > 0; ++i, --left) {
      const auto value = static_cast<float>(load_real<Order>(property.type, need(size)));
      stream_->consume(size);
      if (!are_kept) continue;
      if (i % 2 == 0) uvs_.emplace_back();
      uvs_.back()[i % 2] = std::isfinite(value) ? value : 0;
    }
  }

  /// Reads a list's count and checks it against what the file still holds.
  std::uint64_t read_list_length(const PlyProperty& property) {
    const std::size_t size = size_of(*property.count_type);
    const std::optional<std::int64_t> length = load_whole<Order>(*property.count_type, need(size));
    if (!length || *length < 0) fail("list " + property.name + " has a count below zero or broken");
    const auto count = static_cast<std::uint64_t>(*length);
    const bool in_view = count <= items_in(stream_->window(0).size() - size, property.type);
    if (!in_view) check_list_fits(property, count);
    stream_->consume(size);
    return count;
  }

  void check_list_fits(const PlyProperty& property, std::uint64_t count) const {
    if (!stream_->remaining()) return;  // decompression will find out
    const std::uint64_t ahead = *stream_->remaining() - size_of(*property.count_type);
    if (count > items_in(ahead, property.type)) {
      fail("list " + property.name + " claims " + std::to_string(count) + " items, but only " +
           std::to_string(ahead) + " bytes follow");
    }
  }

  void skip(const PlyProperty& property) {
    const std::size_t size = size_of(property.type);
    if (!property.is_list()) {
      need(size);
      stream_->consume(size);
      return;
    }
    const std::uint64_t count = read_list_length(property);
    if (!stream_->skip(count > UINT64_MAX / size ? UINT64_MAX : count * size)) fail_truncated();
  }

  std::unique_ptr<ByteStream> stream_;
  const std::filesystem::path& path_;
  const PlyElement* element_ = nullptr;
  std::uint64_t index_ = 0;
  std::vector<Uv> uvs_;  // of the face at hand
};

}  // namespace

std::unique_ptr<PlyBody> make_binary_body(std::unique_ptr<ByteStream> stream,
                                          const std::filesystem::path& path,
                                          const PlyHeader& header) {
  if (header.format == PlyFormat::binary_big) {
    return std::make_unique<BinaryBody<std::endian::big>>(std::move(stream), path);
  }
  return std::make_unique<BinaryBody<std::endian::little>>(std::move(stream), path);
}

}  // namespace meshfarm
