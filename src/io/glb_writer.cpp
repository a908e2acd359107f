// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// What is written, all of it little endian:
//   "glTF", uint32 2, uint32 length of all
//   uint32 length, "JSON", the document and blanks
//   uint32 length, "BIN\0", { vertex }, { triangle }, zeros up to a multiple of 4
//   vertex and triangle are as gltf_document.hpp has them
// Of a .gltf they are a file beside it, and the document is the .gltf.
// The translation and the bounds are known at the end: the document of a .glb is written again
// then, into the place that its longest form would take. Where triangles have labels nothing is
// written before the end, and what comes is kept.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "file_sink.hpp"
#include "glb_compressed.hpp"
#include "gltf_document.hpp"
#include "gltf_parts.hpp"
#include "mesh_writers.hpp"
#include "scratch_array.hpp"
#include "srgb.hpp"

namespace meshfarm {
namespace {

using Numbers = std::array<double, 3>;
static_assert(std::endian::native == std::endian::little);

constexpr std::uint64_t k_json_at = 20;
constexpr std::uint64_t k_most_bytes = UINT32_MAX;
constexpr std::uint64_t k_most_for_viewers = std::uint64_t{1} << 31;
constexpr std::uint64_t k_most_items = std::uint64_t{1} << 32;  // products fit 64 bits

std::uint64_t padded(std::uint64_t bytes) {
  return (bytes + 3) / 4 * 4;
}

/// The longest that it can become.
std::uint64_t document_bytes(const GltfLayout& layout, const MeshSinkOptions& options) {
  constexpr double k_longest = std::numeric_limits<double>::lowest();
  const Numbers longest{k_longest, k_longest, k_longest};
  GltfBounds bounds{.lo = longest, .hi = longest};
  if (options.positions == PositionType::float64) bounds.translation = longest;
  return padded(gltf_document(layout, bounds, {.comment = options.comment}).size());
}

void warn_of_viewers(const std::filesystem::path& path, std::uint64_t bytes) {
  if (bytes <= k_most_for_viewers) return;
  log_warning(path.string() +
              ": a glTF of more than 2 GiB is written; many programs cannot open it");
}

/// The length of the file, checked.
std::uint64_t checked_glb_bytes(const std::filesystem::path& path, const MeshSinkOptions& options) {
  const GltfLayout layout(options);
  const bool is_counted = options.vertices < k_most_items && options.triangles < k_most_items;
  const std::uint64_t bytes =
      k_json_at + document_bytes(layout, options) + 8 + padded(layout.binary_bytes());
  if (!is_counted || bytes > k_most_bytes) {
    throw UsageError(path.string() + ": a GLB file with " + std::to_string(options.vertices) +
                     " vertices and " + std::to_string(options.triangles) +
                     " triangles cannot be written: it would be longer than 4 GiB; a .gltf may be");
  }
  return bytes;
}

const MeshSinkOptions& checked_glb(const std::filesystem::path& path,
                                   const MeshSinkOptions& options) {
  warn_of_viewers(path, checked_glb_bytes(path, options));
  return options;
}

const MeshSinkOptions& checked_gltf(const std::filesystem::path& path,
                                    const MeshSinkOptions& options) {
  constexpr std::uint64_t k_most_triangles = std::uint64_t{1} << 40;  // products are below 2^53
  if (options.vertices >= k_most_items || options.triangles >= k_most_triangles) {
    throw UsageError(path.string() + ": a glTF file with " + std::to_string(options.vertices) +
                     " vertices and " + std::to_string(options.triangles) +
                     " triangles cannot be written: its indices have 32 bits");
  }
  warn_of_viewers(path, GltfLayout(options).binary_bytes());
  return options;
}

/// As a URI has it: all but letters, digits and a few marks as "%20".
std::string percent_encoded(std::string_view text) {
  constexpr std::string_view k_digits = "0123456789ABCDEF";
  constexpr std::string_view k_marks = "-._~";
  std::string made;
  for (const char c : text) {
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                          (c >= 'A' && c <= 'Z') || k_marks.find(c) != std::string_view::npos;
    if (is_plain) {
      made += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    made += '%';
    made += k_digits[byte >> 4];
    made += k_digits[byte & 15];
  }
  return made;
}

/// Encodes vertices and triangles; where they go is another's matter.
class GltfEncoder : public FileSink {
 public:
  GltfEncoder(const std::filesystem::path& path, const MeshSinkOptions& options)
      : FileSink(path, options), layout_(options) {
    if (options.labels) parts_.emplace(*options.labels, options.triangles);
  }

 protected:
  bool has_labels() const { return parts_.has_value(); }
  /// When all is put: what the document says.
  GltfWords words(std::string uri = {}) {
    GltfWords made{.comment = options().comment, .uri = std::move(uri)};
    if (parts_) made.parts = parts_->finish(path());
    return made;
  }
  /// After that.
  void write_triangles(const std::function<void(std::string_view)>& to) {
    if (parts_) parts_->write(layout_.index_bytes, to);
  }
  const GltfLayout& layout() const { return layout_; }
  /// When all is put.
  GltfBounds bounds() const {
    GltfBounds made{.lo = lo_, .hi = hi_};
    if (options().positions == PositionType::float64) {
      const Vec3 origin = origin_.value_or(Vec3{});
      made.translation = {origin.x, origin.y, origin.z};
    }
    return made;
  }

 private:
  virtual void write_body(std::string_view bytes) = 0;

  void put(std::span<const Vec3> batch, std::span<const float> values) override {
    begin_positions(batch);
    char* out = buffer_.data();
    const std::size_t channels = options().channels.size();
    for (const Vec3& p : batch) {
      out = put_position(p, out);
      if (layout_.normals) out = put_normal(values.first(channels), out);
      if (layout_.colours) out = put_colour(values.first(channels), out);
      values = values.subspan(channels);
    }
    write_up_to(out);
  }

  void put(const TriangleView& batch) override {
    if (parts_) return parts_->add(batch);
    char* out = buffer_.data();
    for (const WideTriangle& triangle : batch.corners) {
      for (const std::uint64_t index : triangle) {
        std::memcpy(out, &index, layout_.index_bytes);  // its low bytes
        out += layout_.index_bytes;
      }
    }
    write_up_to(out);
  }

  /// Doubles are written relative to the first position, so that floats keep their digits; floats
  /// as they are. A vertex without a position, which no triangle has, is put where another is.
  void begin_positions(std::span<const Vec3> batch) {
    if (filler_) return;
    const auto found = std::find_if(batch.begin(), batch.end(), has_position);
    if (found == batch.end()) return;
    filler_ = *found;
    if (options().positions == PositionType::float64) origin_ = *found;
  }

  char* put_position(Vec3 p, char* out) {
    const Vec3 shown = has_position(p) ? p : filler_.value_or(Vec3{});
    const Vec3 relative = origin_ ? shown - *origin_ : shown;
    const std::array<float, 3> xyz{static_cast<float>(relative.x), static_cast<float>(relative.y),
                                   static_cast<float>(relative.z)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(xyz[axis])) {
        throw DataError(path().string() +
                        ": glTF cannot hold a coordinate that is too large for a float");
      }
      lo_[axis] = std::min(lo_[axis], static_cast<double>(xyz[axis]));
      hi_[axis] = std::max(hi_[axis], static_cast<double>(xyz[axis]));
    }
    std::memcpy(out, xyz.data(), sizeof xyz);
    return out + sizeof xyz;
  }

  /// Of length 1, as glTF has them; what has no length shows up.
  char* put_normal(std::span<const float> of_vertex, char* out) const {
    const auto& [x, y, z] = *layout_.normals;
    Vec3 normal{of_vertex[x], of_vertex[y], of_vertex[z]};
    const double size = length(normal);
    const bool is_fit = size > 0 && std::isfinite(size);
    if (!is_fit) {
      normal = {0, 0, 1};
    } else if (std::abs(size - 1) > 1e-4) {
      normal = normal * (1 / size);
    }
    const std::array<float, 3> xyz{static_cast<float>(normal.x), static_cast<float>(normal.y),
                                   static_cast<float>(normal.z)};
    std::memcpy(out, xyz.data(), sizeof xyz);
    return out + sizeof xyz;
  }

  char* put_colour(std::span<const float> of_vertex, char* out) const {
    std::array<float, 4> rgba{};
    const auto level = [&](std::size_t column) {
      return static_cast<double>(colour_level(options().channels[column].type, of_vertex[column]));
    };
    for (std::size_t i = 0; i < 3; ++i) {
      rgba[i] = static_cast<float>(linear_of_srgb(level((*layout_.colours)[i])));
    }
    if (layout_.alpha) {
      const double alpha =
          level(*layout_.alpha);  // in a mesh that is converted it may be no number
      rgba[3] = alpha > 0 ? static_cast<float>(std::min(alpha, 1.0)) : 0;
    }
    if (layout_.colour_type != ChannelType::uint8) {
      std::memcpy(out, rgba.data(), layout_.colour_bytes);
      return out + layout_.colour_bytes;
    }
    std::array<std::uint16_t, 4> whole{};
    for (std::size_t i = 0; i < 4; ++i) {
      const double linear = static_cast<double>(rgba[i]) * UINT16_MAX;
      whole[i] = static_cast<std::uint16_t>(std::floor(linear + 0.5));
    }
    std::memcpy(out, whole.data(), sizeof whole);
    return out + sizeof whole;
  }

  void write_up_to(const char* end) {
    write_body({buffer_.data(), static_cast<std::size_t>(end - buffer_.data())});
  }

  GltfLayout layout_;
  std::optional<GltfParts> parts_;  // if there are labels
  std::optional<Vec3> filler_;
  std::optional<Vec3> origin_;
  Numbers lo_{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  Numbers hi_{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  std::vector<char> buffer_ =
      std::vector<char>(k_most_at_once * std::max<std::size_t>(layout_.vertex_bytes, 12));
};

class GlbSink final : public GltfEncoder {
 public:
  GlbSink(const std::filesystem::path& path, const MeshSinkOptions& options)
      : GltfEncoder(path, checked_glb(path, options)),
        json_bytes_(document_bytes(layout(), options)) {
    if (has_labels()) {
      kept_ = ScratchArray<char>(layout().vertices_bytes());
    } else {
      begin(std::string(json_bytes_, ' '));
    }
  }

 private:
  /// All that is before the vertices. The document is padded.
  void begin(std::string_view document) {
    const std::uint64_t binary = padded(layout().binary_bytes());
    const bool has_binary = layout().vertices > 0;
    const std::uint64_t bytes = k_json_at + document.size() + (has_binary ? 8 + binary : 0);
    if (bytes > k_most_bytes) throw UsageError(path().string() + ": is longer than 4 GiB");
    write_words({0x46546c67, 2, static_cast<std::uint32_t>(bytes),
                 static_cast<std::uint32_t>(document.size()), 0x4e4f534a});
    write(document);
    if (has_binary) write_words({static_cast<std::uint32_t>(binary), 0x004e4942});
  }

  void write_body(std::string_view bytes) override {
    if (!has_labels()) return write(bytes);
    std::copy(bytes.begin(), bytes.end(),
              kept_.items().begin() + static_cast<std::ptrdiff_t>(kept_bytes_));
    kept_bytes_ += bytes.size();
    kept_.used(bytes.size());
  }

  void finish() override {
    std::string text = gltf_document(layout(), bounds(), words());
    text.resize(has_labels() ? padded(text.size()) : json_bytes_, ' ');
    if (has_labels()) {
      begin(text);
      write_kept();
      write_triangles([this](std::string_view bytes) { write(bytes); });
    }
    write(std::string(padded(layout().binary_bytes()) - layout().binary_bytes(), '\0'));
    if (!has_labels()) overwrite(k_json_at, text);
  }

  void write_kept() {
    constexpr std::uint64_t k_at_once = std::uint64_t{1} << 20;
    for (std::uint64_t first = 0; first < kept_bytes_; first += k_at_once) {
      const std::uint64_t count = std::min(k_at_once, kept_bytes_ - first);
      write({kept_.items().data() + first, count});
      kept_.used(count);
    }
  }

  void write_words(std::initializer_list<std::uint32_t> words) {
    for (const std::uint32_t word : words) {
      write({reinterpret_cast<const char*>(&word), sizeof word});
    }
  }

  std::uint64_t json_bytes_;
  ScratchArray<char> kept_;  // vertices, if there are labels
  std::uint64_t kept_bytes_ = 0;
};

/// Keeps all bytes until the end.
class CompressedGlbSink final : public GltfEncoder {
 public:
  CompressedGlbSink(const std::filesystem::path& path, const MeshSinkOptions& options)
      : GltfEncoder(path, options) {
    binary_.reserve(layout().binary_bytes());
  }

 private:
  void write_body(std::string_view bytes) override { binary_ += bytes; }
  void finish() override {
    write(compressed_glb(layout(), bounds(), options().comment, std::move(binary_)));
  }

  std::string binary_;
};

class GltfSink final : public GltfEncoder {
 public:
  GltfSink(const std::filesystem::path& path, const MeshSinkOptions& options)
      : GltfEncoder(path, checked_gltf(path, options)),
        binary_path_(std::filesystem::path(path).replace_extension(".bin")),
        binary_(checked_output(binary_path_)) {}

 private:
  void write_body(std::string_view bytes) override { binary_.write(bytes); }

  /// The document is the last to come. One that is there already must not be found with the new
  /// bytes; it goes when nothing is left to do but to rename.
  void finish() override {
    write(gltf_document(layout(), bounds(),
                        words(percent_encoded(binary_path_.filename().native()))));
    write_triangles([this](std::string_view bytes) { binary_.write(bytes); });
    sync();
    binary_.sync();
    if (layout().vertices == 0) return;
    std::error_code error;
    std::filesystem::remove(path(), error);
    if (error) throw IoError("cannot replace", path(), error.value());
    binary_.commit();
  }

  std::filesystem::path binary_path_;
  AtomicFile binary_;
};

}  // namespace

void check_fits_glb(const std::filesystem::path& path, const MeshSinkOptions& options) {
  checked_glb_bytes(path, options);
}

std::unique_ptr<MeshSink> create_glb(const std::filesystem::path& path,
                                     const MeshSinkOptions& options) {
  if (options.packing == Packing::compressed && can_compress_glb(options)) {
    return std::make_unique<CompressedGlbSink>(path, options);
  }
  return std::make_unique<GlbSink>(path, options);
}

std::unique_ptr<MeshSink> create_gltf(const std::filesystem::path& path,
                                      const MeshSinkOptions& options) {
  return std::make_unique<GltfSink>(path, options);
}

}  // namespace meshfarm
