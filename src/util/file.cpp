// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

namespace meshfarm {

std::filesystem::path temporary_folder() {
  const char* named = std::getenv("TMPDIR");
  std::filesystem::path folder = named != nullptr && *named != '\0' ? named : "/tmp";
  std::error_code error;
  if (std::filesystem::is_directory(folder, error)) return folder;
  throw IoError("no folder for temporary files, set TMPDIR to one:", folder,
                error ? error.value() : ENOTDIR);
}

Fd::~Fd() {
  if (fd_ >= 0) ::close(fd_);
}

Fd& Fd::operator=(Fd&& other) noexcept {
  if (this != &other) {
    if (fd_ >= 0) ::close(fd_);
    fd_ = std::exchange(other.fd_, -1);
  }
  return *this;
}

int Fd::close() {
  const int fd = std::exchange(fd_, -1);
  return fd >= 0 && ::close(fd) != 0 ? errno : 0;
}

Fd open_for_read(const std::filesystem::path& path) {
  Fd fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!fd) throw_errno("cannot open", path);
  return fd;
}

void write_all(int fd, std::string_view bytes, const std::filesystem::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      throw_errno("cannot write", path);
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

std::uint64_t file_size(int fd, const std::filesystem::path& path) {
  struct stat status {};
  if (::fstat(fd, &status) != 0) throw_errno("cannot stat", path);
  return static_cast<std::uint64_t>(status.st_size);
}

std::size_t read_up_to(int fd, std::span<char> buffer, const std::filesystem::path& path) {
  std::size_t done = 0;
  while (done < buffer.size()) {
    const ssize_t got = ::read(fd, buffer.data() + done, buffer.size() - done);
    if (got < 0) {
      if (errno == EINTR) continue;
      throw_errno("cannot read", path);
    }
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::size_t read_at(int fd, std::uint64_t offset, std::span<char> buffer,
                    const std::filesystem::path& path) {
  std::size_t done = 0;
  while (done < buffer.size()) {
    const ssize_t got =
        ::pread(fd, buffer.data() + done, buffer.size() - done, static_cast<off_t>(offset + done));
    if (got < 0) {
      if (errno == EINTR) continue;
      throw_errno("cannot read", path);
    }
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

std::string read_file(int fd, const std::filesystem::path& path) {
  std::string bytes(file_size(fd, path), '\0');
  bytes.resize(read_up_to(fd, bytes, path));  // shorter than fstat said: the caller checks the size
  return bytes;
}

std::string read_file(const std::filesystem::path& path) {
  return read_file(open_for_read(path).get(), path);
}

bool reports_late(int fd) {
  constexpr decltype(std::declval<struct statfs>().f_type) k_nfs = 0x6969;
  constexpr decltype(std::declval<struct statfs>().f_type) k_fuse = 0x65735546;
  struct statfs status {};
  return ::fstatfs(fd, &status) != 0 || status.f_type == k_nfs || status.f_type == k_fuse;
}

namespace {

/// Reserves blocks now: a full disk is then an error here, not a SIGBUS later. If the file system
/// cannot reserve (NFS 3), the blocks are written, and fsync asks the server whether it has them.
void reserve(int fd, std::uint64_t size_bytes, const std::filesystem::path& folder) {
  if (::fallocate(fd, 0, 0, static_cast<off_t>(size_bytes)) == 0) return;
  if (errno != EOPNOTSUPP && errno != ENOSYS && errno != EINVAL) {
    throw_errno("cannot reserve a scratch file in", folder);
  }
  const std::string zeros(std::size_t{1} << 20, '\0');
  for (std::uint64_t left = size_bytes; left > 0;) {
    const std::size_t piece = std::min<std::uint64_t>(left, zeros.size());
    write_all(fd, std::string_view(zeros).substr(0, piece), folder);
    left -= piece;
  }
  if (::fsync(fd) != 0) throw_errno("cannot reserve a scratch file in", folder);
}

}  // namespace

MappedFile MappedFile::scratch(const std::filesystem::path& folder, std::uint64_t size_bytes) {
  std::string name = (folder / "scratch.XXXXXX").string();
  const Fd fd(::mkostemp(name.data(), O_CLOEXEC));
  if (!fd) throw_errno("cannot make", name);
  ::unlink(name.c_str());
  MappedFile mapped;
  mapped.size_ = size_bytes;
  if (size_bytes == 0) return mapped;
  reserve(fd.get(), size_bytes, folder);
  void* data = ::mmap(nullptr, mapped.size_, PROT_READ | PROT_WRITE, MAP_SHARED, fd.get(), 0);
  if (data == MAP_FAILED) throw_errno("cannot map a scratch file in", folder);
  mapped.data_ = static_cast<char*>(data);
  return mapped;
}

MappedFile MappedFile::memory(std::uint64_t size_bytes) {
  MappedFile mapped;
  mapped.size_ = size_bytes;
  if (size_bytes == 0) return mapped;
  constexpr int k_flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE;
  void* data = ::mmap(nullptr, mapped.size_, PROT_READ | PROT_WRITE, k_flags, -1, 0);
  if (data == MAP_FAILED) throw_errno("cannot map", "memory");
  mapped.data_ = static_cast<char*>(data);
  return mapped;
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) ::munmap(data_, size_);
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : data_(std::exchange(other.data_, nullptr)), size_(std::exchange(other.size_, 0)) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

}  // namespace meshfarm
