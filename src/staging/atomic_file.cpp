// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cerrno>
#include <random>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr std::size_t k_buffer_bytes = std::size_t{1} << 20;

/// Processes in two containers may have the same number and the same host name.
const std::string& process_token() {
  static const std::string token = [] {
    std::random_device device;
    const std::uint64_t random = (std::uint64_t{device()} << 32) | device();
    return std::to_string(::getpid()) + "-" + to_hex(random);
  }();
  return token;
}

constexpr std::string_view k_ending = ".tmp";

std::string beginning_of(const std::filesystem::path& final_path) {
  return "." + final_path.filename().string() + ".";
}

std::filesystem::path temporary_name(const std::filesystem::path& final_path,
                                     std::string_view unique) {
  std::string name = beginning_of(final_path);
  name += unique.empty() ? process_token() : std::string(unique);
  return final_path.parent_path() / name.append(k_ending);
}

/// As made by process_token(): a number, and 16 hexadecimal digits.
bool is_token(std::string_view token) {
  constexpr std::string_view k_digits = "0123456789";
  const std::size_t dash = token.find_first_not_of(k_digits);
  return dash != 0 && dash != std::string_view::npos && token[dash] == '-' &&
         token.size() - dash == 1 + 2 * sizeof(std::uint64_t) &&
         token.find_first_not_of("0123456789abcdef", dash + 1) == std::string_view::npos;
}

}  // namespace

void remove_unfinished(const std::filesystem::path& final_path) {
  const std::string beginning = beginning_of(final_path);
  const std::filesystem::path folder = final_path.parent_path();
  std::error_code ignored;
  for (std::filesystem::directory_iterator entry(folder.empty() ? "." : folder, ignored), end;
       !ignored && entry != end; entry.increment(ignored)) {
    const std::string found = entry->path().filename().string();
    const std::string_view name = found;
    if (!name.starts_with(beginning) || !name.ends_with(k_ending)) continue;
    const std::size_t around = beginning.size() + k_ending.size();
    if (name.size() <= around) continue;
    if (is_token(name.substr(beginning.size(), name.size() - around))) {
      std::filesystem::remove(entry->path(), ignored);
    }
  }
}

void rename_checked(const std::filesystem::path& from, const std::filesystem::path& to,
                    std::uint64_t size_bytes) {
  if (::rename(from.c_str(), to.c_str()) == 0) return;
  const int error = errno;
  struct stat status {};
  if (error == ENOENT && ::stat(to.c_str(), &status) == 0 &&
      static_cast<std::uint64_t>(status.st_size) == size_bytes) {
    return;
  }
  throw IoError("cannot rename " + from.string() + " to", to, error);
}

AtomicFile::AtomicFile(std::filesystem::path final_path, std::string_view unique, Readers readers)
    : final_path_(std::move(final_path)), temporary_path_(temporary_name(final_path_, unique)) {
  constexpr int k_flags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  const mode_t mode = readers == Readers::owner ? 0600 : 0644;
  fd_ = Fd(::open(temporary_path_.c_str(), k_flags, mode));
  if (!fd_ && errno == EEXIST) {  // left behind by a dead process with our name
    ::unlink(temporary_path_.c_str());
    fd_ = Fd(::open(temporary_path_.c_str(), k_flags, mode));
  }
  if (!fd_) throw_errno("cannot make", temporary_path_);
}

AtomicFile::~AtomicFile() {
  if (fd_) ::unlink(temporary_path_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  if (buffer_.size() + bytes.size() > k_buffer_bytes) flush();
  if (bytes.size() >= k_buffer_bytes) {
    write_all(fd_.get(), bytes, temporary_path_);
    flushed_ += bytes.size();
  } else {
    buffer_.append(bytes);
  }
}

void AtomicFile::overwrite(std::uint64_t offset, std::string_view bytes) {
  flush();
  while (!bytes.empty()) {
    const ssize_t count =
        ::pwrite(fd_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw_errno("cannot write", temporary_path_);
    bytes.remove_prefix(static_cast<std::size_t>(count));
    offset += static_cast<std::uint64_t>(count);
  }
}

void AtomicFile::flush() {
  write_all(fd_.get(), buffer_, temporary_path_);
  flushed_ += buffer_.size();
  buffer_.clear();
}

void AtomicFile::sync() {
  flush();
  if (::fsync(fd_.get()) != 0) throw_errno("cannot sync", temporary_path_);
}

void AtomicFile::sync_and_close() {
  sync();
  // The destructor no longer has anything to close, so a failure must be cleaned up here.
  const int close_error = fd_.close();
  if (close_error == 0) return;
  ::unlink(temporary_path_.c_str());
  throw IoError("cannot close", temporary_path_, close_error);
}

void AtomicFile::commit() {
  sync_and_close();
  try {
    rename_checked(temporary_path_, final_path_, flushed_);
  } catch (const IoError&) {
    ::unlink(temporary_path_.c_str());
    throw;
  }
}

bool AtomicFile::commit_new() {
  sync_and_close();
  bool ours = false;
  try {
    ours = link_final();
  } catch (const IoError&) {
    ::unlink(temporary_path_.c_str());
    throw;
  }
  ::unlink(temporary_path_.c_str());
  return ours;
}

bool AtomicFile::link_final() const {
  if (::link(temporary_path_.c_str(), final_path_.c_str()) == 0) return true;
  const int error = errno;
  struct stat ours {};
  struct stat theirs {};
  if (error == EEXIST) {
    // A restarting NFS server may have lost the answer to a link that succeeded: ours.
    return ::stat(temporary_path_.c_str(), &ours) == 0 &&
           ::stat(final_path_.c_str(), &theirs) == 0 && ours.st_ino == theirs.st_ino;
  }
  const bool no_links = error == EPERM || error == EOPNOTSUPP || error == ENOSYS || error == EMLINK;
  if (!no_links) throw IoError("cannot make", final_path_, error);
  if (::stat(final_path_.c_str(), &theirs) == 0) return false;
  rename_checked(temporary_path_, final_path_, flushed_);
  return true;
}

}  // namespace meshfarm
