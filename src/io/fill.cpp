// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cstring>
#include <utility>

#include <meshfarm/io/fill.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {

Fill fill_from(std::string_view bytes, std::string what) {
  return [bytes, what = std::move(what), done = std::size_t{0}](std::span<char> buffer) mutable {
    if (buffer.size() > bytes.size() - done) {
      throw DataError(what + ": cut short at byte " + std::to_string(bytes.size()));
    }
    if (!buffer.empty()) std::memcpy(buffer.data(), bytes.data() + done, buffer.size());
    done += buffer.size();
  };
}

}  // namespace meshfarm
