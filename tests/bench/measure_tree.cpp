// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// measure_tree REPORT.json COMMAND [ARGUMENT ...]: runs a command and reports wall time, the CPU
// time of all processes that it starts, and the peak of their total anonymous memory, sampled every
// few milliseconds. Exits with the command's exit code.
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

using Clock = std::chrono::steady_clock;

constexpr timespec k_interval{0, 5'000'000};

[[noreturn]] void die(const char* what) {
  std::fprintf(stderr, "measure_tree: %s: %s\n", what, std::strerror(errno));
  std::exit(125);
}

/// A process may be gone before its /proc entry is read: then it has no children.
std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> children;
  std::error_code gone;
  const auto tasks = "/proc/" + std::to_string(parent) + "/task";
  std::filesystem::directory_iterator task(tasks, gone);
  for (; !gone && task != std::filesystem::directory_iterator(); task.increment(gone)) {
    std::ifstream file(task->path() / "children");
    for (pid_t child = 0; file >> child;) children.push_back(child);
  }
  return children;
}

std::uint64_t anonymous_kb(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("RssAnon:", 0) == 0) return std::strtoull(line.c_str() + 8, nullptr, 10);
  }
  return 0;
}

std::uint64_t anonymous_kb_below(pid_t root) {
  std::uint64_t sum = 0;
  std::vector<pid_t> todo = children_of(root);
  while (!todo.empty()) {
    const pid_t pid = todo.back();
    todo.pop_back();
    sum += anonymous_kb(pid);
    for (const pid_t child : children_of(pid)) todo.push_back(child);
  }
  return sum;
}

pid_t start(char** command, const sigset_t& before) {
  const pid_t pid = fork();
  if (pid < 0) die("fork");
  if (pid > 0) return pid;
  sigprocmask(SIG_SETMASK, &before, nullptr);
  execvp(command[0], command);
  std::fprintf(stderr, "measure_tree: %s: %s\n", command[0], std::strerror(errno));
  _exit(127);
}

struct Measured {
  int status = 0;
  double wall_s = 0;
  std::uint64_t peak_kb = 0;
};

/// Returns when all descendants have ended; orphans are re-parented to us, so none is missed.
Measured watch(pid_t first, const sigset_t& child_ended) {
  Measured out;
  const Clock::time_point begin = Clock::now();
  for (;;) {
    int status = 0;
    const pid_t ended = waitpid(-1, &status, WNOHANG);
    if (ended < 0 && errno == ECHILD) return out;
    if (ended == first) {
      out.status = status;
      out.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
    }
    if (ended > 0) continue;
    out.peak_kb = std::max(out.peak_kb, anonymous_kb_below(getpid()));
    sigtimedwait(&child_ended, nullptr, &k_interval);
  }
}

double seconds(timeval t) {
  return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

bool write_report(const char* path, const Measured& measured) {
  rusage usage{};
  if (getrusage(RUSAGE_CHILDREN, &usage) != 0) die("getrusage");
  std::ofstream file(path);
  file << "{\"wall_s\": " << measured.wall_s
       << ", \"cpu_s\": " << seconds(usage.ru_utime) + seconds(usage.ru_stime)
       << ", \"peak_anon_mb\": " << static_cast<double>(measured.peak_kb) / 1024 << "}\n";
  file.close();
  return !file.fail();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: measure_tree REPORT.json COMMAND [ARGUMENT ...]\n");
    return 2;
  }
  if (prctl(PR_SET_CHILD_SUBREAPER, 1) != 0) die("prctl");
  if (!std::filesystem::exists("/proc/thread-self/children")) {
    std::fprintf(stderr, "measure_tree: /proc does not tell a process's children here\n");
    return 125;
  }
  sigset_t child_ended;
  sigset_t before;
  sigemptyset(&child_ended);
  sigaddset(&child_ended, SIGCHLD);
  if (sigprocmask(SIG_BLOCK, &child_ended, &before) != 0) die("sigprocmask");
  const pid_t first = start(argv + 2, before);
  // On a busy machine samples would be late. Where raising the priority is refused, they may be.
  setpriority(PRIO_PROCESS, 0, -10);
  const Measured measured = watch(first, child_ended);
  if (!write_report(argv[1], measured)) die(argv[1]);
  if (WIFEXITED(measured.status)) return WEXITSTATUS(measured.status);
  return 128 + WTERMSIG(measured.status);
}
