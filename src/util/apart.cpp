// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <csignal>
#include <exception>
#include <fstream>
#include <new>
#include <utility>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <meshfarm/util/apart.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

namespace meshfarm {
namespace {

constexpr const char* k_pipe = "a pipe";

enum class Kind : std::uint64_t { bytes = 1, error, no_memory, done };

/// Precedes `size` bytes in the pipe.
struct Head {
  Kind kind{};
  std::uint64_t size = 0;
};

void send(int pipe, Kind kind, std::string_view bytes) {
  const Head head{kind, bytes.size()};
  write_all(pipe, {reinterpret_cast<const char*>(&head), sizeof head}, k_pipe);
  write_all(pipe, bytes, k_pipe);
}

void limit(int resource, std::uint64_t most) {
  rlimit now{};
  if (::getrlimit(resource, &now) != 0) return;
  now.rlim_cur = std::min<std::uint64_t>(now.rlim_cur, most);
  ::setrlimit(resource, &now);
}

void limit_memory(std::uint64_t more) {
  std::ifstream file("/proc/self/statm");
  std::uint64_t pages = 0;
  if (!(file >> pages)) return;
  limit(RLIMIT_AS, pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) + more);
}

/// Core dumps and crash messages are of no use to someone who has only the damaged bytes.
void die_quietly() {
  limit(RLIMIT_CORE, 0);
  for (const int number : {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL}) std::signal(number, SIG_DFL);
  const int null = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (null >= 0) ::dup2(null, STDERR_FILENO);
}

[[noreturn]] void work_and_exit(int pipe, const std::function<void(const SendBytes&)>& work,
                                std::optional<std::uint64_t> most_bytes) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  die_quietly();
  try {
    if (most_bytes) limit_memory(*most_bytes);
    try {
      work([pipe](std::string_view bytes) { send(pipe, Kind::bytes, bytes); });
      send(pipe, Kind::done, {});
    } catch (const Error& error) {
      send(pipe, Kind::error, error.what());
    } catch (const std::bad_alloc&) {
      send(pipe, Kind::no_memory, {});
    }
  } catch (...) {
    // The other side sees that the pipe is closed.
  }
  ::_exit(0);
}

/// A process that is killed and waited for.
class Copy {
 public:
  explicit Copy(pid_t pid) : pid_(pid) {}
  Copy(const Copy&) = delete;
  Copy& operator=(const Copy&) = delete;
  ~Copy() {
    ::kill(pid_, SIGKILL);
    while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }

 private:
  pid_t pid_;
};

std::optional<Head> receive_head(int pipe) {
  std::array<char, sizeof(Head)> bytes{};
  if (read_up_to(pipe, bytes, k_pipe) != bytes.size()) return std::nullopt;
  Head head;
  std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(&head));
  return head;
}

/// Allocates memory as bytes arrive: a copy that goes wrong may announce any size.
std::optional<std::string> receive_bytes(int pipe, std::uint64_t size) {
  constexpr std::uint64_t k_block = 1 << 20;
  std::string bytes;
  while (bytes.size() < size) {
    const std::size_t start = bytes.size();
    const auto block = static_cast<std::size_t>(std::min(k_block, size - start));
    if (bytes.capacity() < start + block) bytes.reserve(2 * start + block);
    bytes.resize(start + block);
    if (read_up_to(pipe, {bytes.data() + start, block}, k_pipe) != block) return std::nullopt;
  }
  return bytes;
}

ApartEnd receive_all(int pipe, const std::function<void(std::string)>& take) {
  while (const std::optional<Head> head = receive_head(pipe)) {
    if (head->kind == Kind::done) return ApartEnd::done;
    if (head->kind == Kind::no_memory) return ApartEnd::out_of_memory;
    if (head->kind != Kind::bytes && head->kind != Kind::error) break;
    std::optional<std::string> bytes = receive_bytes(pipe, head->size);
    if (!bytes) break;
    if (head->kind == Kind::error) throw DataError(*bytes);
    take(std::move(*bytes));
  }
  return ApartEnd::died;
}

}  // namespace

ApartEnd run_apart(const std::function<void(const SendBytes&)>& work,
                   const std::function<void(std::string)>& take,
                   std::optional<std::uint64_t> most_bytes) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw_errno("cannot make", k_pipe);
  const Fd from(ends[0]);
  Fd to(ends[1]);
  const pid_t pid = ::fork();
  if (pid < 0) throw_errno("cannot start a process for", "damaged bytes");
  if (pid == 0) work_and_exit(to.get(), work, most_bytes);
  const Copy copy(pid);
  to = Fd();
  return receive_all(from.get(), take);
}

}  // namespace meshfarm
