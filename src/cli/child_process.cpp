// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/child_process.hpp"

#include <csignal>
#include <ctime>

#include <fcntl.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

sigset_t child_signal() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGCHLD);
  return set;
}

void write_to(const std::filesystem::path& path, int fd) {
  if (path.empty()) return;
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0 || ::dup2(file, fd) < 0) ::_exit(1);
  ::close(file);
}

[[noreturn]] void become(const std::vector<std::string>& words, pid_t parent,
                         const ChildOutput& output) {
  // A process group of its own: Ctrl-C reaches only the parent, which ends its children in order.
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(1);
  write_to(output.out, STDOUT_FILENO);
  write_to(output.err, STDERR_FILENO);
  const sigset_t set = child_signal();
  ::sigprocmask(SIG_UNBLOCK, &set, nullptr);
  std::vector<char*> argv;
  static char program[] = "meshfarm";
  argv.push_back(program);
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  ::execv("/proc/self/exe", argv.data());
  ::_exit(127);
}

}  // namespace

pid_t start_child(const std::vector<std::string>& words, const ChildOutput& output) {
  const sigset_t set = child_signal();
  ::sigprocmask(SIG_BLOCK, &set, nullptr);
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid < 0) throw_errno("cannot start a process for", words.front());
  if (pid == 0) become(words, parent, output);
  return pid;
}

void wait_for_child(int timeout_ms) {
  const sigset_t set = child_signal();
  const timespec timeout{timeout_ms / 1000, (timeout_ms % 1000) * 1'000'000L};
  ::sigtimedwait(&set, nullptr, &timeout);
}

}  // namespace meshfarm
