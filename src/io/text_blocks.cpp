// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "text_blocks.hpp"

#include <algorithm>
#include <cstring>

namespace meshfarm {
namespace {

constexpr std::size_t k_piece_bytes = std::size_t{512} << 10;
constexpr std::size_t k_worth_dividing = std::size_t{64} << 10;
constexpr std::size_t k_longest_unit = std::size_t{64} << 20;

}  // namespace

char line_end_of(std::string_view start) {
  return start.find('\n') == std::string_view::npos && start.find('\r') != std::string_view::npos
             ? '\r'
             : '\n';
}

bool is_text(std::string_view start) {
  return start.find('\0') == std::string_view::npos;
}

TextBlocks::TextBlocks(const InputFile& file, TextUnits units, unsigned threads)
    : path_(file.path()),
      stream_(file.open()),
      units_(units),
      threads_(threads),
      capacity_(threads * k_piece_bytes),
      buffer_(std::make_unique_for_overwrite<char[]>(capacity_)) {}

std::span<const std::string_view> TextBlocks::next() {
  lines_ += static_cast<std::uint64_t>(
      std::count(buffer_.get(), buffer_.get() + block_, units_.line_end));
  held_ -= block_;
  std::memmove(buffer_.get(), buffer_.get() + block_, held_);
  block_ = 0;
  fill();
  while ((block_ = whole_units()) == 0 && !at_end_) {
    if (capacity_ >= k_longest_unit) fail({buffer_.get(), "what begins here has no end in 64 MB"});
    auto larger = std::make_unique_for_overwrite<char[]>(2 * capacity_);
    std::memcpy(larger.get(), buffer_.get(), held_);
    buffer_ = std::move(larger);
    capacity_ *= 2;
    fill();
  }
  divide({buffer_.get(), block_});
  return pieces_;
}

void TextBlocks::fill() {
  while (held_ < capacity_ && !at_end_) {
    const std::string_view window = stream_->window(1);
    const std::size_t count = std::min(window.size(), capacity_ - held_);
    std::memcpy(buffer_.get() + held_, window.data(), count);
    stream_->consume(count);
    held_ += count;
    at_end_ = count == 0;
  }
}

/// How many of the held bytes form whole units.
std::size_t TextBlocks::whole_units() const {
  if (at_end_) return held_;
  const std::string_view text(buffer_.get(), held_);
  std::size_t at = text.rfind(units_.line_end);
  while (at != std::string_view::npos && !units_.ends_at(text, at)) {
    at = at == 0 ? std::string_view::npos : text.rfind(units_.line_end, at - 1);
  }
  return at + 1;  // npos + 1 is 0
}

void TextBlocks::divide(std::string_view text) {
  pieces_.clear();
  const std::size_t most = std::min<std::size_t>(threads_, text.size() / k_worth_dividing + 1);
  for (std::size_t left = most; !text.empty() && left > 0; --left) {
    std::size_t at = left == 1 ? std::string_view::npos : text.size() / left;
    while (at != std::string_view::npos) {
      at = text.find(units_.line_end, at);
      if (at == std::string_view::npos || units_.ends_at(text, at)) break;
      ++at;
    }
    const std::size_t size = at == std::string_view::npos ? text.size() : at + 1;
    pieces_.push_back(text.substr(0, size));
    text.remove_prefix(size);
  }
}

std::uint64_t TextBlocks::line_of(const char* at) const {
  const auto before = std::count<const char*>(buffer_.get(), at, units_.line_end);
  return lines_ + static_cast<std::uint64_t>(before) + 1;
}

void TextBlocks::fail(const TextError& error) const {
  throw DataError(path_.string() + ": line " + std::to_string(line_of(error.at)) + ": " +
                  error.why);
}

}  // namespace meshfarm
