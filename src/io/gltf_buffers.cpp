// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "gltf_buffers.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

#include "files_beside.hpp"
#include "ply_types.hpp"

namespace meshfarm {
namespace {

/// Nothing for invalid base64.
std::optional<std::string> decode_base64(std::string_view text) {
  static constexpr std::string_view k_digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<std::int8_t, 256> values{};
  values.fill(-1);
  for (std::size_t i = 0; i < k_digits.size(); ++i) {
    values[static_cast<unsigned char>(k_digits[i])] = static_cast<std::int8_t>(i);
  }
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::int8_t value = values[static_cast<unsigned char>(c)];
    if (value < 0) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xff);
  }
  return bytes;
}

/// The part of a buffer that a view, or its compression extension, names.
std::shared_ptr<const GltfBuffer> part_of(const std::shared_ptr<const GltfBuffer>& buffer,
                                          const GltfValue& view) {
  const std::uint64_t start = view.whole_or("byteOffset", 0);
  const std::uint64_t bytes = view.at("byteLength").whole();
  if (start + bytes > buffer->size) {
    view.fail("ends at byte " + std::to_string(start + bytes) + " of a buffer of " +
              std::to_string(buffer->size));
  }
  return std::make_shared<const GltfBuffer>(
      GltfBuffer{bytes, [buffer, start](std::uint64_t offset, std::span<char> out) {
                   buffer->read(start + offset, out);
                 }});
}

}  // namespace

std::optional<std::string> decode_percents(std::string_view text) {
  std::string made;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      made += text[i];
      continue;
    }
    const std::string_view digits = text.substr(i + 1, 2);
    unsigned value = 0;
    const auto [stop, error] =
        std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (digits.size() < 2 || error != std::errc() || stop != digits.data() + 2) return std::nullopt;
    made += static_cast<char>(value);
    i += 2;
  }
  return made;
}

std::shared_ptr<const GltfBuffer> GltfBuffers::open_view(const GltfValue& document,
                                                         std::uint64_t index) {
  std::shared_ptr<const GltfBuffer>& opened = views_[index];
  if (opened) return opened;
  const GltfValue view = document.at("bufferViews").item(index);
  const std::optional<GltfValue> extensions = view.find("extensions");
  const auto compression =
      extensions ? extensions->find("EXT_meshopt_compression") : std::optional<GltfValue>();
  const GltfValue& stored = compression ? *compression : view;
  opened = part_of(open(document, stored.at("buffer").whole()), stored);
  if (compression) {
    opened =
        std::make_shared<const GltfBuffer>(decode_meshopt(view, *compression, *opened, store_));
  }
  return opened;
}

std::shared_ptr<const GltfBuffer> GltfBuffers::unpacked(std::uint64_t accessor) const {
  const auto found = unpacked_.find(accessor);
  return found == unpacked_.end() ? nullptr : found->second;
}

void GltfBuffers::keep_unpacked(std::uint64_t accessor, std::string bytes) {
  unpacked_[accessor] = std::make_shared<const GltfBuffer>(store_.keep(std::move(bytes)));
}

std::shared_ptr<const GltfBuffer> GltfBuffers::open(const GltfValue& document,
                                                    std::uint64_t index) {
  std::shared_ptr<const GltfBuffer>& opened = opened_[index];
  if (!opened) opened = open_buffer(document.at("buffers").item(index), index == 0);
  return opened;
}

std::shared_ptr<const GltfBuffer> GltfBuffers::open_buffer(const GltfValue& buffer,
                                                           bool is_first) const {
  const std::uint64_t bytes = buffer.at("byteLength").whole();
  const std::optional<GltfValue> uri = buffer.find("uri");
  if (!uri && !(is_first && binary_))
    buffer.fail("has no uri, and the file no binary chunk for it");
  const std::shared_ptr<const GltfBuffer> opened = uri ? open_uri(*uri) : binary_;
  if (opened->size < bytes) {
    buffer.fail("is truncated: it is to have " + std::to_string(bytes) + " bytes, but has " +
                std::to_string(opened->size));
  }
  return std::make_shared<const GltfBuffer>(GltfBuffer{bytes, opened->read});
}

std::shared_ptr<const GltfBuffer> GltfBuffers::open_uri(const GltfValue& uri) const {
  const std::string_view text = uri.text();
  if (text.starts_with("data:")) {
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos || !text.substr(0, comma).ends_with(";base64")) {
      uri.fail("is not base64");
    }
    std::optional<std::string> bytes = decode_base64(text.substr(comma + 1));
    if (!bytes) uri.fail("is malformed base64");
    return std::make_shared<const GltfBuffer>(buffer_in_memory(*std::move(bytes)));
  }
  const std::optional<std::string> name = decode_percents(text);
  const bool is_elsewhere = text.substr(0, text.find('/')).find(':') != std::string_view::npos;
  if (!name || is_elsewhere || !is_beneath(*name)) {
    uri.fail(shown(text) + " does not name a file beside this one, or in a folder below");
  }
  const std::filesystem::path beside = folder_ / *name;
  std::error_code ignored;
  if (std::filesystem::status(beside, ignored).type() == std::filesystem::file_type::not_found) {
    uri.fail("names a buffer that is not there: " + beside.string());
  }
  return std::make_shared<const GltfBuffer>(buffer_in_file(files_, beside));
}

}  // namespace meshfarm
