// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Loaded into a meshfarm process by LD_PRELOAD: the n-th call that writes, reads, creates, names or
// removes a file below a folder fails, is cut short, or ends the process. Sockets and eventfds are
// not affected, which is why strace cannot be used for this. Configured by the environment:
//
//   MESHFARM_FAULT        CALL:KIND:N    write|fsync|close|rename|link|open|read|pread|unlink|
//                                        fdatasync : an errno | short | kill | lost | hang
//   MESHFARM_FAULT_ROLE   only in processes of this command: worker, sink, ventilator
//   MESHFARM_FAULT_BELOW  the folder
//   MESHFARM_FAULT_WHILE  a file: while it exists, each write and fsync below the folder fails with
//                         ENOSPC, and no other fault happens
//   MESHFARM_FAULT_SICK   a file: while it exists, the mount is sick: nothing below the folder is
//                         found or opened (ESTALE) or read (EIO)
//   MESHFARM_FAULT_HOST   the host's name
//   MESHFARM_FAULT_DELAY_MS  the longest delay, in milliseconds, of each write, fsync, fdatasync,
//                         rename and link below the folder; it depends on the process's and the
//                         call's number
//   MESHFARM_FAULT_CLOCK_S  how many seconds the host's clock is ahead of the file server's
//   MESHFARM_FAULT_FIRED  a file that is created when the fault happens, which then happens only
//                         once; empty: once in each process
//
// "lost" (of rename, link, unlink): it is done, but answered with ENOENT or EEXIST, as by an NFS
// server that restarted. Staged files are opened by a system call of their own, which does not
// count as "open", but the sick mount affects it.
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>

#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace {

template <class F>
F* real(const char* name) {
  return reinterpret_cast<F*>(::dlsym(RTLD_NEXT, name));
}

std::string text_of(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? "" : text;
}

struct Fault {
  std::string call;
  std::string kind;
  long nth = 0;
  std::string below;
  std::string fired;
  std::string full_while;
  std::string sick_while;
  unsigned long longest_delay_ms = 0;
  std::atomic<long> count{0};
  std::atomic<unsigned long> delays{0};

  Fault() {
    char words[4096] = {};
    const int fd = real<int(const char*, int, ...)>("open")("/proc/self/cmdline", O_RDONLY);
    const ssize_t size = real<ssize_t(int, void*, size_t)>("read")(fd, words, sizeof words - 1);
    real<int(int)>("close")(fd);
    const char* role = size > 0 ? words + std::strlen(words) + 1 : words;
    const std::string wanted = text_of("MESHFARM_FAULT_ROLE");
    if (!wanted.empty() && wanted != role) return;
    below = text_of("MESHFARM_FAULT_BELOW");
    full_while = text_of("MESHFARM_FAULT_WHILE");
    sick_while = text_of("MESHFARM_FAULT_SICK");
    longest_delay_ms = std::strtoul(text_of("MESHFARM_FAULT_DELAY_MS").c_str(), nullptr, 10);
    const std::string fault = text_of("MESHFARM_FAULT");
    const std::size_t first = fault.find(':');
    const std::size_t second = fault.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) return;
    call = fault.substr(0, first);
    kind = fault.substr(first + 1, second - first - 1);
    nth = std::atol(fault.c_str() + second + 1);
    fired = text_of("MESHFARM_FAULT_FIRED");
  }

  bool covers(const char* path) const {
    return !below.empty() && std::strncmp(path, below.c_str(), below.size()) == 0;
  }
  bool covers(int fd) const {
    if (below.empty()) return false;
    const std::string link = "/proc/self/fd/" + std::to_string(fd);
    char path[4096] = {};
    return ::readlink(link.c_str(), path, sizeof path - 1) > 0 && covers(path);
  }
  template <class Where>
  bool is_full(const Where& where) const {
    return !full_while.empty() && ::access(full_while.c_str(), F_OK) == 0 && covers(where);
  }
  template <class Where>
  bool is_sick(const Where& where) const {
    return !sick_while.empty() && ::access(sick_while.c_str(), F_OK) == 0 && covers(where);
  }
  bool is_sick(int folder, const char* name) const {
    if (sick_while.empty()) return false;
    const std::string link = "/proc/self/fd/" + std::to_string(folder);
    char path[4096] = {};
    if (::readlink(link.c_str(), path, sizeof path - 1) <= 0) return false;
    return is_sick((std::string(path) + "/" + name).c_str());
  }
  template <class Where>
  void delay(const Where& where) {
    if (longest_delay_ms == 0 || !covers(where)) return;
    // One call in four waits; most go on at once, so that the order of events changes.
    const unsigned long drawn =
        (static_cast<unsigned long>(::getpid()) * 1000003 + ++delays) * 0x9e3779b97f4a7c15 >> 33;
    if (drawn % 4 == 0) ::poll(nullptr, 0, static_cast<int>(drawn / 4 % longest_delay_ms));
  }
  /// Whether the fault strikes this call. If the fault is "kill" or "hang", does not return.
  template <class Where>
  bool strikes(const char* name, const Where& where) {
    if (call != name || !covers(where) || ++count != nth) return false;
    if (!fired.empty()) {
      const int fd = real<int(const char*, int, ...)>("open")(
          fired.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
      if (fd < 0) return false;  // it has struck in another process
      real<int(int)>("close")(fd);
    }
    if (kind == "kill") ::raise(SIGKILL);
    while (kind == "hang") ::pause();
    return true;
  }
  int error() const {
    if (kind == "ENOSPC") return ENOSPC;
    if (kind == "EDQUOT") return EDQUOT;
    return kind == "ESTALE" ? ESTALE : EIO;
  }
  int fails() const {
    errno = error();
    return -1;
  }
  static int is_stale() {
    errno = ESTALE;
    return -1;
  }
};

Fault& fault() {
  static Fault instance;
  return instance;
}

}  // namespace

extern "C" {

ssize_t write(int fd, const void* bytes, size_t size) {
  fault().delay(fd);
  if (fault().is_full(fd)) {
    errno = ENOSPC;
    return -1;
  }
  if (fault().strikes("write", fd)) {
    if (fault().kind == "short")
      return real<ssize_t(int, const void*, size_t)>("write")(fd, bytes, size / 2 + size % 2);
    errno = fault().error();
    return -1;
  }
  return real<ssize_t(int, const void*, size_t)>("write")(fd, bytes, size);
}

int fsync(int fd) {
  fault().delay(fd);
  const bool full = fault().is_full(fd);
  if (full || fault().strikes("fsync", fd)) {
    errno = full ? ENOSPC : fault().error();
    return -1;
  }
  return real<int(int)>("fsync")(fd);
}

int close(int fd) {
  const bool strikes = fault().strikes("close", fd);
  const int result = real<int(int)>("close")(fd);
  if (!strikes) return result;
  errno = fault().error();
  return -1;
}

int rename(const char* from, const char* to) {
  fault().delay(to);
  const bool strikes = fault().strikes("rename", to);
  if (strikes && fault().kind != "lost") {
    errno = fault().error();
    return -1;
  }
  const int result = real<int(const char*, const char*)>("rename")(from, to);
  if (!strikes) return result;
  errno = ENOENT;
  return -1;
}

int open(const char* path, int flags, ...) {
  mode_t mode = 0;
  if ((flags & (O_CREAT | O_TMPFILE)) != 0) {
    va_list rest;
    va_start(rest, flags);
    mode = va_arg(rest, mode_t);
    va_end(rest);
  }
  if (fault().is_sick(path)) return Fault::is_stale();
  if (fault().strikes("open", path)) return fault().fails();
  return real<int(const char*, int, ...)>("open")(path, flags, mode);
}

/// The system call that opens staged files; others are passed through.
long syscall(long number, ...) {
  va_list rest;
  va_start(rest, number);
  long words[6];
  for (long& word : words) word = va_arg(rest, long);
  va_end(rest);
  if (number == SYS_openat2 &&
      fault().is_sick(static_cast<int>(words[0]), reinterpret_cast<const char*>(words[1]))) {
    return Fault::is_stale();
  }
  static auto* const next = real<long(long, ...)>("syscall");
  return next(number, words[0], words[1], words[2], words[3], words[4], words[5]);
}

DIR* opendir(const char* path) {
  if (fault().is_sick(path)) {
    errno = ESTALE;
    return nullptr;
  }
  return real<DIR*(const char*)>("opendir")(path);
}

int stat(const char* path, struct stat* status) {
  if (fault().is_sick(path)) return Fault::is_stale();
  return real<int(const char*, struct stat*)>("stat")(path, status);
}

int gethostname(char* name, size_t size) {
  static const std::string told = text_of("MESHFARM_FAULT_HOST");
  if (told.empty()) return real<int(char*, size_t)>("gethostname")(name, size);
  std::snprintf(name, size, "%s", told.c_str());
  return 0;
}

ssize_t read(int fd, void* bytes, size_t size) {
  if (fault().is_sick(fd)) {
    errno = EIO;
    return -1;
  }
  if (fault().strikes("read", fd)) {
    if (fault().kind != "short") return fault().fails();
    size = size / 2 + size % 2;
  }
  return real<ssize_t(int, void*, size_t)>("read")(fd, bytes, size);
}

ssize_t pread(int fd, void* bytes, size_t size, off_t offset) {
  if (fault().is_sick(fd)) {
    errno = EIO;
    return -1;
  }
  if (fault().strikes("pread", fd)) {
    if (fault().kind != "short") return fault().fails();
    size = size / 2 + size % 2;
  }
  return real<ssize_t(int, void*, size_t, off_t)>("pread")(fd, bytes, size, offset);
}

int fdatasync(int fd) {
  fault().delay(fd);
  if (fault().strikes("fdatasync", fd)) return fault().fails();
  return real<int(int)>("fdatasync")(fd);
}

int clock_gettime(clockid_t clock, timespec* time) {
  static const long ahead = std::atol(text_of("MESHFARM_FAULT_CLOCK_S").c_str());
  const int result = real<int(clockid_t, timespec*)>("clock_gettime")(clock, time);
  if (result == 0 && clock == CLOCK_REALTIME) time->tv_sec += ahead;
  return result;
}

int link(const char* from, const char* to) {
  fault().delay(to);
  const bool strikes = fault().strikes("link", to);
  if (strikes && fault().kind != "lost") return fault().fails();
  const int result = real<int(const char*, const char*)>("link")(from, to);
  if (!strikes) return result;
  errno = EEXIST;
  return -1;
}

int unlink(const char* path) {
  const bool strikes = fault().strikes("unlink", path);
  if (strikes && fault().kind != "lost") return fault().fails();
  const int result = real<int(const char*)>("unlink")(path);
  if (!strikes) return result;
  errno = ENOENT;
  return -1;
}

}  // extern "C"
