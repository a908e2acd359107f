// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A journal:  head = "MFJL" | version u32 = 1      record = size u32 | xxh3-64 u64 | bytes
// A crash leaves at most one torn record, the last; a file shorter than its head is all torn.
#include <array>

#include <fcntl.h>
#include <unistd.h>

#include <meshfarm/staging/journal.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr std::array<char, 4> k_journal_magic = {'M', 'F', 'J', 'L'};
constexpr std::uint32_t k_journal_version = 1;
constexpr std::size_t k_head_bytes = 8;
constexpr std::size_t k_record_head_bytes = 12;

}  // namespace

JournalWriter::JournalWriter(std::filesystem::path path) : path_(std::move(path)) {
  fd_ = Fd(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644));
  if (!fd_) throw_errno("cannot make the journal", path_);
  ByteWriter head;
  head.put(k_journal_magic);
  head.put(k_journal_version);
  try {
    write_all(fd_.get(), head.bytes(), path_);
    if (::fsync(fd_.get()) != 0) throw_errno("cannot sync the journal", path_);
  } catch (const IoError&) {
    ::unlink(path_.c_str());  // repeated attempts would each leave one behind
    throw;
  }
}

void JournalWriter::append(std::string_view record) {
  const std::string one(record);
  append_all({&one, 1});
}

void JournalWriter::append_all(std::span<const std::string> records) {
  ByteWriter out;
  for (const std::string& record : records) {
    out.put(static_cast<std::uint32_t>(record.size()));
    out.put(checksum(record));
    out.put_array(std::span<const char>(record));
  }
  write_all(fd_.get(), out.bytes(), path_);
  if (::fsync(fd_.get()) != 0) throw_errno("cannot sync the journal", path_);
}

JournalContent parse_journal(std::string_view bytes, std::string_view what) {
  JournalContent content;
  if (bytes.size() < k_head_bytes) {
    content.torn_bytes = bytes.size();
    return content;
  }
  ByteReader in(bytes, what);
  if (in.get<std::array<char, 4>>() != k_journal_magic) in.fail("not a journal");
  if (in.get<std::uint32_t>() != k_journal_version) in.fail("a journal of an unknown version");
  while (in.remaining() >= k_record_head_bytes) {
    const std::size_t start = in.offset();
    const auto size = in.get<std::uint32_t>();
    const auto sum = in.get<std::uint64_t>();
    if (size > in.remaining() || checksum(bytes.substr(in.offset(), size)) != sum) {
      content.torn_bytes = bytes.size() - start;
      return content;
    }
    content.records.emplace_back(in.take(size));
  }
  content.torn_bytes = in.remaining();
  return content;
}

}  // namespace meshfarm
