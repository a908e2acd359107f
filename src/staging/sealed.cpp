// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A staged file:
//   magic "MFRM" | kind, 4 characters | version u32 | byte order u32 0x01020304 | payload size u64
//   | payload | xxh3-64 of everything before it
// Little endian. Version history is kept with each kind of payload.
#include <algorithm>

#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr FileKind k_magic = {'M', 'F', 'R', 'M'};
constexpr std::uint32_t k_byte_order = 0x01020304;

std::uint64_t read_head(ByteReader& in, FileKind kind, std::uint32_t version) {
  if (in.get<FileKind>() != k_magic) in.fail("not a meshfarm file");
  const auto found_kind = in.get<FileKind>();
  if (found_kind != kind) {
    in.fail("a '" + std::string(found_kind.data(), 4) + "' file where a '" +
            std::string(kind.data(), 4) + "' file is wanted");
  }
  const auto found_version = in.get<std::uint32_t>();
  if (found_version != version) {
    in.fail("format version " + std::to_string(found_version) + " is unknown to this meshfarm");
  }
  if (in.get<std::uint32_t>() != k_byte_order) in.fail("written with another byte order");
  return in.get<std::uint64_t>();
}

}  // namespace

std::string seal_head(FileKind kind, std::uint32_t version, std::uint64_t payload_bytes) {
  ByteWriter out;
  out.put(k_magic);
  out.put(kind);
  out.put(version);
  out.put(k_byte_order);
  out.put(payload_bytes);
  return out.take();
}

std::string seal(FileKind kind, std::uint32_t version, std::string_view payload) {
  ByteWriter out;
  out.reserve(k_seal_head_bytes + payload.size() + sizeof(std::uint64_t));
  out.put_array(std::span<const char>(seal_head(kind, version, payload.size())));
  out.put_array(std::span<const char>(payload));
  const std::uint64_t sum = checksum(out.bytes());
  out.put(sum);
  return out.take();
}

std::string_view unseal(std::string_view file, FileKind kind, std::uint32_t version,
                        std::string_view what) {
  ByteReader in(file, what);
  const std::uint64_t size = read_head(in, kind, version);
  if (size > in.remaining()) in.fail("cut short");
  const std::string_view payload = in.take(size);
  const std::size_t covered = in.offset();
  if (in.get<std::uint64_t>() != checksum(file.substr(0, covered))) in.fail("damaged (checksum)");
  in.expect_end();
  return payload;
}

std::uint64_t unseal_head(std::string_view head, FileKind kind, std::uint32_t version,
                          std::string_view what) {
  ByteReader in(head, what);
  return read_head(in, kind, version);
}

}  // namespace meshfarm
