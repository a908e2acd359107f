// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace meshfarm {

/// $TMPDIR, or /tmp. Throws IoError if there is no such folder.
std::filesystem::path temporary_folder();

/// Owns a file descriptor.
class Fd {
 public:
  Fd() = default;
  explicit Fd(int fd) : fd_(fd) {}
  ~Fd();
  Fd(Fd&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Fd& operator=(Fd&& other) noexcept;
  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }
  /// Closes the file. Returns 0, or the errno of close() (a full NFS disk shows here).
  int close();

 private:
  int fd_ = -1;
};

/// Opens for reading. Throws IoError.
Fd open_for_read(const std::filesystem::path& path);
/// Writes everything, handling short writes and EINTR. Throws IoError.
void write_all(int fd, std::string_view bytes, const std::filesystem::path& path);
/// Reads until the buffer is full or the file ends; returns the number of bytes. Throws IoError.
std::size_t read_up_to(int fd, std::span<char> buffer, const std::filesystem::path& path);
/// Like read_up_to(), from `offset`. Throws IoError.
std::size_t read_at(int fd, std::uint64_t offset, std::span<char> buffer,
                    const std::filesystem::path& path);
/// Reads the whole file by read(). Throws IoError.
std::string read_file(const std::filesystem::path& path);
std::string read_file(int fd, const std::filesystem::path& path);
std::uint64_t file_size(int fd, const std::filesystem::path& path);

/// Whether write errors of this file may show only at fsync, as on NFS.
bool reports_late(int fd);

/// Mapped memory. scratch() maps a file that is unlinked as soon as it is created, so that it never
/// outlives its owner. memory() is anonymous memory, initially zero; only touched pages are
/// allocated. Do not map a file that another process may shorten: a missing page is a SIGBUS.
class MappedFile {
 public:
  MappedFile() = default;
  static MappedFile scratch(const std::filesystem::path& folder, std::uint64_t size_bytes);
  static MappedFile memory(std::uint64_t size_bytes);
  ~MappedFile();
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;

  std::string_view bytes() const { return {data_, size_}; }

  template <class T>
  requires std::is_trivially_copyable_v<T> std::span<T> as_span()
  const { return {reinterpret_cast<T*>(data_), size_ / sizeof(T)}; }

 private:
  char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace meshfarm
