// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The input, all of it little endian:
//   .glb  = "glTF", uint32 version 2, uint32 length of all, { chunk }
//   chunk = uint32 length, uint32 type, bytes; the first is the JSON, the next "BIN\0" the binary
//   .gltf = the JSON alone
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "gltf_buffers.hpp"
#include "ply_types.hpp"
#include "text_blocks.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_glb_header_bytes = 12;
constexpr std::uint64_t k_chunk_header_bytes = 8;
constexpr std::uint32_t k_json_chunk = 0x4e4f534a;
constexpr std::uint32_t k_binary_chunk = 0x004e4942;

std::uint32_t word(const char* bytes) {
  return load_ply<std::uint32_t, std::endian::little>(bytes);
}

/// The decompressed file, with random access.
GltfBuffer whole_file(const std::shared_ptr<const InputFile>& file) {
  if (file->compression() == Compression::none) {
    return {file->size(),
            [file](std::uint64_t offset, std::span<char> out) { file->read(offset, out); }};
  }
  ScratchFile scratch = make_scratch_file();
  const std::unique_ptr<ByteStream> stream = file->open();
  // No .glb is longer than 4 GiB; anything after that is ignored.
  constexpr std::uint64_t k_most_bytes = std::uint64_t{1} << 32;
  for (;;) {
    const std::string_view window = stream->window(ByteStream::k_max_window_bytes);
    if (window.empty() || stream->position() >= k_most_bytes) break;
    write_all(scratch.fd.get(), window, scratch.folder);
    stream->consume(window.size());
  }
  const std::uint64_t size = stream->position();
  return buffer_in_scratch(std::make_shared<const ScratchFile>(std::move(scratch)), 0, size);
}

struct Chunk {
  std::uint32_t type = 0;
  std::uint64_t start = 0;
  std::uint64_t bytes = 0;
};

class GlbFile {
 public:
  explicit GlbFile(const std::shared_ptr<const InputFile>& file)
      : path_(file->path().string()), file_(whole_file(file)), length_(checked_length()) {}

  GltfContainer container() const {
    GltfContainer made{.format = "GLB"};
    std::uint64_t at = k_glb_header_bytes;
    const Chunk json = chunk(at);
    if (json.type != k_json_chunk) fail(at, "the first chunk is not the JSON");
    if (json.bytes > k_most_gltf_json) {
      fail(at, "the JSON of " + std::to_string(json.bytes) + " bytes is longer than the most, " +
                   std::to_string(k_most_gltf_json));
    }
    made.json_start = json.start;
    made.json.resize(json.bytes);
    file_.read(json.start, made.json);
    for (at = json.start + json.bytes; at < length_ && !made.binary;) {
      const Chunk next = chunk(at);
      if (next.type == k_binary_chunk) made.binary = part(next);
      at = next.start + next.bytes;
    }
    return made;
  }

 private:
  std::uint64_t checked_length() const {
    if (file_.size < k_glb_header_bytes) {
      fail(file_.size, "truncated: the header of a GLB has 12 bytes");
    }
    std::array<char, k_glb_header_bytes> header{};
    file_.read(0, header);
    const std::uint32_t version = word(header.data() + 4);
    const std::uint64_t length = word(header.data() + 8);
    if (version != 2) fail(4, "version " + std::to_string(version) + " of GLB is not 2");
    if (length > file_.size) {
      fail(8, "truncated: the header promises " + std::to_string(length) +
                  " bytes, but the file ends at byte " + std::to_string(file_.size));
    }
    if (length < k_glb_header_bytes) fail(8, "the length is less than the header's own");
    if (length < file_.size) {
      log_warning(path_ + ": there is more in the file than its header says");
    }
    return length;
  }

  Chunk chunk(std::uint64_t at) const {
    if (length_ - at < k_chunk_header_bytes) fail(at, "a chunk's header is cut off");
    std::array<char, k_chunk_header_bytes> header{};
    file_.read(at, header);
    const Chunk made{word(header.data() + 4), at + k_chunk_header_bytes, word(header.data())};
    if (made.bytes > length_ - made.start) {
      fail(at, "a chunk of " + std::to_string(made.bytes) + " bytes is longer than what follows");
    }
    return made;
  }

  std::shared_ptr<GltfBuffer> part(const Chunk& chunk) const {
    return std::make_shared<GltfBuffer>(
        GltfBuffer{chunk.bytes,
                   [read = file_.read, start = chunk.start](
                       std::uint64_t offset, std::span<char> out) { read(start + offset, out); }});
  }

  [[noreturn]] void fail(std::uint64_t at, const std::string& why) const {
    throw DataError(path_ + ": byte " + std::to_string(at) + ": " + why);
  }

  std::string path_;
  GltfBuffer file_;
  std::uint64_t length_;
};

}  // namespace

bool is_glb_file(const InputFile& file) {
  return file.open()->window(4).starts_with("glTF");
}

bool is_gltf_file(const InputFile& file) {
  constexpr std::size_t k_most_blank = 4096;
  const std::unique_ptr<ByteStream> stream = file.open();
  std::string_view text = stream->window(k_most_blank);
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  // The header of a binary STL may also begin with this character.
  return first != std::string_view::npos && text[first] == '{' && is_text(text);
}

GltfContainer open_glb_container(const std::shared_ptr<const InputFile>& file) {
  return GlbFile(file).container();
}

GltfContainer open_gltf_container(const InputFile& file) {
  GltfContainer made{.format = "glTF"};
  const std::unique_ptr<ByteStream> stream = file.open();
  for (;;) {
    const std::string_view window = stream->window(ByteStream::k_max_window_bytes);
    if (window.empty()) return made;
    if (made.json.size() + window.size() > k_most_gltf_json) {
      throw DataError(file.path().string() + ": more than " + std::to_string(k_most_gltf_json) +
                      " bytes of JSON; put the buffers into files beside it, or into a .glb");
    }
    made.json += window;
    stream->consume(window.size());
  }
}

}  // namespace meshfarm
