// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cerrno>
#include <chrono>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

namespace meshfarm {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double wall_clock_s() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// A file of a probe, removed whatever happens.
class ProbeFile {
 public:
  explicit ProbeFile(std::filesystem::path path) : path_(std::move(path)) {}
  ~ProbeFile() { ::unlink(path_.c_str()); }
  ProbeFile(const ProbeFile&) = delete;
  ProbeFile& operator=(const ProbeFile&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct stat status_of(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) throw_errno("cannot look at", path);
  return status;
}

Fd make_file(const std::filesystem::path& path, mode_t mode) {
  Fd fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode));
  if (!fd) throw_errno("cannot make", path);
  return fd;
}

RoundTrip make_round_trip(const std::filesystem::path& folder, const std::string& name,
                          const std::string& bytes) {
  const ProbeFile temporary(folder / ("." + name + ".tmp"));
  const ProbeFile final_file(folder / ("." + name));
  RoundTrip trip;
  auto start = Clock::now();
  Fd fd = make_file(temporary.path(), 0644);
  write_all(fd.get(), bytes, temporary.path());
  trip.write = ms_since(start);
  start = Clock::now();
  if (::fsync(fd.get()) != 0) throw_errno("cannot sync", temporary.path());
  if (const int error = fd.close(); error != 0) {
    throw IoError("cannot close", temporary.path(), error);
  }
  trip.sync = ms_since(start);
  start = Clock::now();
  rename_checked(temporary.path(), final_file.path(), bytes.size());
  trip.rename = ms_since(start);
  start = Clock::now();
  if (read_file(final_file.path()) != bytes) {
    throw DataError(final_file.path().string() + ": not what was written");
  }
  trip.read = ms_since(start);
  return trip;
}

/// The server's clock minus ours, from the time that the server gives a new file.
double clock_ahead(const std::filesystem::path& folder, const std::string& name) {
  const ProbeFile file(folder / ("." + name));
  const double before = wall_clock_s();
  Fd fd = make_file(file.path(), 0644);
  write_all(fd.get(), "x", file.path());
  if (::fsync(fd.get()) != 0) throw_errno("cannot sync", file.path());
  fd.close();
  const double after = wall_clock_s();
  const struct stat status = status_of(file.path());
  const double theirs = static_cast<double>(status.st_mtim.tv_sec) +
                        1e-9 * static_cast<double>(status.st_mtim.tv_nsec);
  return theirs - (before + after) / 2;
}

}  // namespace

void probe_room(const std::filesystem::path& folder, std::uint64_t bytes) {
  constexpr std::uint64_t k_piece = std::uint64_t{1} << 20;
  const ProbeFile file(folder / (".room." + std::to_string(::getpid()) + ".tmp"));
  ::unlink(file.path().c_str());  // left behind by a dead process with our pid
  Fd fd = make_file(file.path(), 0600);
  const std::string piece(std::min(bytes, k_piece), 'r');
  for (; bytes > 0; bytes -= std::min(bytes, k_piece)) {
    write_all(fd.get(), std::string_view(piece).substr(0, std::min(bytes, k_piece)), file.path());
  }
  if (::fsync(fd.get()) != 0) throw_errno("cannot sync", file.path());
  if (const int error = fd.close(); error != 0) throw IoError("cannot close", file.path(), error);
}

std::optional<std::filesystem::file_time_type> server_clock(const std::filesystem::path& folder) {
  const ProbeFile file(folder / (".clock." + std::to_string(::getpid()) + ".tmp"));
  ::unlink(file.path().c_str());  // left behind by a dead process with our pid
  constexpr int k_new = O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC;
  if (!Fd(::open(file.path().c_str(), k_new, 0600))) return std::nullopt;
  std::error_code error;
  const auto time = std::filesystem::last_write_time(file.path(), error);
  return error ? std::nullopt : std::optional(time);
}

std::optional<double> server_unix_s(const std::filesystem::path& folder) {
  const auto clock = server_clock(folder);
  if (!clock) return std::nullopt;
  const auto since = std::chrono::file_clock::to_sys(*clock).time_since_epoch();
  return std::chrono::duration<double>(since).count();
}

std::filesystem::file_time_type clock_of(const std::filesystem::path& folder) {
  return server_clock(folder).value_or(std::filesystem::file_time_type::clock::now());
}

bool keeps_private(const std::filesystem::path& folder) {
  const ProbeFile file(folder / (".private." + std::to_string(::getpid())));
  const Fd fd = make_file(file.path(), 0600);
  return (status_of(file.path()).st_mode & (S_IRWXG | S_IRWXO)) == 0;
}

FolderProbe probe_folder(const std::filesystem::path& folder, int count, std::size_t size_bytes) {
  const std::string name = "doctor." + std::to_string(::getpid());
  const std::string bytes(size_bytes, 'd');
  FolderProbe probe;
  try {
    for (int i = 0; i < count; ++i) {
      probe.trips.push_back(make_round_trip(folder, name + "." + std::to_string(i), bytes));
    }
    probe.clock_ahead_s = clock_ahead(folder, name + ".clock");
    probe.keeps_private = keeps_private(folder);
    const ProbeFile one(folder / ("." + name + ".one"));
    const ProbeFile two(folder / ("." + name + ".two"));
    make_file(one.path(), 0644);
    probe.has_links = ::link(one.path().c_str(), two.path().c_str()) == 0;
  } catch (const Error& error) {
    probe.problem = error.what();
  }
  return probe;
}

}  // namespace meshfarm
