// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {

void ByteWriter::put_string(std::string_view text) {
  put(static_cast<std::uint32_t>(text.size()));
  bytes_.append(text);
}

std::string ByteReader::get_string() {
  const auto size = get<std::uint32_t>();
  return std::string(take(size));
}

std::string_view ByteReader::take(std::size_t count) {
  if (count > remaining()) fail("cut short");
  const std::string_view view = bytes_.substr(offset_, count);
  offset_ += count;
  return view;
}

void ByteReader::expect_end() const {
  if (remaining() != 0) fail(std::to_string(remaining()) + " bytes too many");
}

void ByteReader::fail(std::string_view why) const {
  throw DataError(what_ + ": " + std::string(why) + " at byte " + std::to_string(offset_));
}

}  // namespace meshfarm
