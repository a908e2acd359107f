// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The output, all of it little endian:
//   "glTF", uint32 2, uint32 length of all
//   uint32 length, "JSON", the document and blanks
//   uint32 length, "BIN\0", { vertex }, { triangle }, zeros up to a multiple of 4, { image }
//   vertex, triangle and image are as gltf_document.hpp has them
// For a .gltf, these are a file beside it, and the document is the .gltf. The translation and the
// bounds are known only at the end: the document of a .glb is then rewritten in place, with room
// for its longest form. Where triangles have columns, nothing is written before the end, and all
// input is kept.
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "glb_compressed.hpp"
#include "gltf_document.hpp"
#include "gltf_encoder.hpp"
#include "mesh_writers.hpp"
#include "pictures_beside.hpp"

namespace meshfarm {
namespace {

using Numbers = std::array<double, 3>;

constexpr std::uint64_t k_json_at = 20;
constexpr std::uint64_t k_most_glb_bytes = UINT32_MAX;
constexpr std::uint64_t k_most_for_viewers = std::uint64_t{1} << 31;
constexpr std::uint64_t k_most_items = std::uint64_t{1} << 32;  // products fit 64 bits

/// The greatest length that it can have.
std::uint64_t document_bytes(const GltfLayout& layout, const MeshSinkOptions& options) {
  constexpr double k_longest = std::numeric_limits<double>::lowest();
  const Numbers longest{k_longest, k_longest, k_longest};
  GltfBounds bounds{.lo = longest, .hi = longest};
  if (options.positions == PositionType::float64) bounds.translation = longest;
  return padded_to_4(gltf_document(layout, bounds, {.comment = options.comment}).size());
}

void warn_of_viewers(const std::filesystem::path& path, std::uint64_t bytes) {
  if (bytes <= k_most_for_viewers) return;
  log_warning(path.string() +
              ": a glTF of more than 2 GiB is written; many programs cannot open it");
}

/// The length of the file. Throws if it is too large.
std::uint64_t checked_glb_bytes(const std::filesystem::path& path, const MeshSinkOptions& options) {
  const GltfLayout layout(options);
  const bool is_counted = options.vertices < k_most_items && options.triangles < k_most_items;
  const std::uint64_t bytes =
      k_json_at + document_bytes(layout, options) + 8 + padded_to_4(layout.binary_bytes());
  if (!is_counted || bytes > k_most_glb_bytes) {
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

/// Encoded as in a URI: all but letters, digits and a few marks as "%20".
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

class GlbSink final : public GltfEncoder {
 public:
  GlbSink(const std::filesystem::path& path, const MeshSinkOptions& options)
      : GltfEncoder(path, checked_glb(path, options)),
        json_bytes_(document_bytes(layout(), options)) {
    if (!is_kept()) begin(std::string(json_bytes_, ' '), padded_to_4(layout().binary_bytes()));
  }

 private:
  /// Writes all that precedes the vertices. The document must be padded, and the binary's length,
  /// too.
  void begin(std::string_view document, std::uint64_t binary) {
    const bool has_binary = layout().vertices > 0;
    const std::uint64_t bytes = k_json_at + document.size() + (has_binary ? 8 + binary : 0);
    check_length(bytes);
    write_words({0x46546c67, 2, static_cast<std::uint32_t>(bytes),
                 static_cast<std::uint32_t>(document.size()), 0x4e4f534a});
    write(document);
    if (has_binary) write_words({static_cast<std::uint32_t>(binary), 0x004e4942});
  }

  void check_length(std::uint64_t bytes) const {
    if (bytes > k_most_glb_bytes) throw UsageError(path().string() + ": is longer than 4 GiB");
  }

  void write_body(std::string_view bytes) override { write(bytes); }

  void finish() override {
    if (is_kept()) return finish_kept();
    std::string text = gltf_document(layout(), bounds(), words());
    text.resize(json_bytes_, ' ');
    write_padding(layout().binary_bytes());
    overwrite(k_json_at, text);
  }

  void finish_kept() {
    const GltfWords all = words();
    const std::uint64_t binary = padded_to_4(layout().binary_bytes()) + all.image_bytes();
    check_length(binary);
    if (options().packing == Packing::compressed && can_compress_glb(layout())) {
      std::string plain;
      plain.reserve(layout().binary_bytes());
      write_kept([&](std::string_view bytes) { plain += bytes; });
      write(compressed_glb(layout(), bounds(), all, std::move(plain)));
    } else {
      std::string text = gltf_document(layout(), bounds(), all);
      text.resize(padded_to_4(text.size()), ' ');
      begin(text, binary);
      write_kept([this](std::string_view bytes) { write(bytes); });
      write_padding(layout().binary_bytes());
    }
    for (const GltfImage& image : all.images) write_image(image);
  }

  void write_image(const GltfImage& image) {
    const std::string bytes = options().pictures.load(image.picture);
    if (bytes.size() != image.bytes) {
      throw DataError(options().pictures.names[image.picture] + ": has changed while it was read");
    }
    write(bytes);
    write_padding(bytes.size());
  }

  void write_padding(std::uint64_t after) { write(std::string(padded_to_4(after) - after, '\0')); }

  void write_words(std::initializer_list<std::uint32_t> words) {
    for (const std::uint32_t word : words) {
      write({reinterpret_cast<const char*>(&word), sizeof word});
    }
  }

  std::uint64_t json_bytes_;
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
  void finish() override { write(compressed_glb(layout(), bounds(), words(), std::move(binary_))); }

  std::string binary_;
};

class GltfSink final : public GltfEncoder {
 public:
  GltfSink(const std::filesystem::path& path, const MeshSinkOptions& options)
      : GltfEncoder(path, checked_gltf(path, options)),
        binary_path_(std::filesystem::path(path).replace_extension(".bin")),
        binary_(checked_output(binary_path_)),
        pictures_(path, options.pictures) {}

 private:
  void write_body(std::string_view bytes) override { binary_.write(bytes); }

  /// The document is written last.
  void finish() override {
    GltfWords all = words(percent_encoded(binary_path_.filename().native()));
    for (GltfImage& image : all.images) {
      image.uri = percent_encoded(pictures_.name_of(image.picture));
    }
    write(gltf_document(layout(), bounds(), all));
    write_kept([this](std::string_view bytes) { binary_.write(bytes); });
    pictures_.finish();
    binary_.sync();
    sync();
    if (layout().vertices == 0) return;
    make_way();
    pictures_.commit();
    binary_.commit();
  }

  std::filesystem::path binary_path_;
  AtomicFile binary_;
  PicturesBeside pictures_;
};

}  // namespace

void check_fits_glb(const std::filesystem::path& path, const MeshSinkOptions& options) {
  checked_glb_bytes(path, options);
}

std::unique_ptr<MeshSink> create_glb(const std::filesystem::path& path,
                                     const MeshSinkOptions& options) {
  const bool is_streamed = !options.labels && !options.uvs;
  if (is_streamed && options.packing == Packing::compressed &&
      can_compress_glb(GltfLayout(options))) {
    return std::make_unique<CompressedGlbSink>(path, options);
  }
  return std::make_unique<GlbSink>(path, options);
}

std::unique_ptr<MeshSink> create_gltf(const std::filesystem::path& path,
                                      const MeshSinkOptions& options) {
  return std::make_unique<GltfSink>(path, options);
}

}  // namespace meshfarm
