// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace meshfarm::test {

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Polls until `done` returns true, for at most `seconds`. Returns whether it did.
inline bool wait_until(const std::function<bool()>& done, double seconds = 60) {
  using namespace std::chrono;
  const auto begin = steady_clock::now();
  while (!done()) {
    const auto waited = steady_clock::now() - begin;
    if (waited > duration<double>(seconds)) return false;
    // After a long wait a delay does not matter, and polling takes time.
    std::this_thread::sleep_for(std::clamp<nanoseconds>(waited / 50, 2ms, 100ms));
  }
  return true;
}

/// A meshfarm process. Its output goes to files beside `log`; it is killed if it outlives its
/// owner.
class Process {
 public:
  Process(std::vector<std::string> words, const std::filesystem::path& log)
      : out_(log.string() + ".out"), err_(log.string() + ".err") {
    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error("cannot fork");
    if (pid_ == 0) become(words);
  }
  ~Process() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
  }
  Process(Process&& other) noexcept
      : pid_(std::exchange(other.pid_, -1)), out_(other.out_), err_(other.err_) {}
  Process& operator=(Process&& other) noexcept {
    std::swap(pid_, other.pid_);
    std::swap(out_, other.out_);
    std::swap(err_, other.err_);
    return *this;
  }

  pid_t pid() const { return pid_; }
  void signal(int number) const { ::kill(pid_, number); }
  /// The exit code, or minus the signal that ended it; -1000 if it did not end in time.
  int wait(double seconds = 120) {
    int status = 0;
    if (!wait_until([&] { return ::waitpid(pid_, &status, WNOHANG) == pid_; }, seconds)) {
      return -1000;
    }
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  std::string out() const { return read_text(out_); }
  std::string err() const { return read_text(err_); }

 private:
  [[noreturn]] void become(const std::vector<std::string>& words) const {
    const auto redirect = [](const std::string& path, int to) {
      const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
      ::dup2(fd, to);
    };
    redirect(out_, STDOUT_FILENO);
    redirect(err_, STDERR_FILENO);
    std::vector<char*> argv;
    static std::string program = MESHFARM_PROGRAM;
    argv.push_back(program.data());
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    ::execv(program.c_str(), argv.data());
    ::_exit(127);
  }

  pid_t pid_ = -1;
  std::string out_;
  std::string err_;
};

/// Runs a command to its end and returns its exit code, and what it wrote to `out` and `err`.
struct Ran {
  int code = 0;
  std::string out;
  std::string err;
};
inline Ran run_meshfarm(const std::vector<std::string>& words, const std::filesystem::path& log) {
  Process process(words, log);
  const int code = process.wait();
  return {code, process.out(), process.err()};
}

/// The tcp ports that a process listens on: the socket inodes among those of /proc/net/tcp in the
/// state LISTEN (0A).
inline std::vector<std::uint16_t> listening_ports(pid_t pid) {
  const std::string process = "/proc/" + std::to_string(pid);
  std::vector<std::string> inodes;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(process + "/fd", ignored)) {
    const std::string target = std::filesystem::read_symlink(entry.path(), ignored).string();
    if (target.starts_with("socket:[")) inodes.push_back(target.substr(8, target.size() - 9));
  }
  std::vector<std::uint16_t> ports;
  std::ifstream table(process + "/net/tcp");
  for (std::string line; std::getline(table, line);) {
    std::istringstream words(line);
    std::array<std::string, 10> field;
    for (std::string& each : field) words >> each;
    if (field[3] != "0A" || std::find(inodes.begin(), inodes.end(), field[9]) == inodes.end()) {
      continue;
    }
    const std::string port = field[1].substr(field[1].find(':') + 1);
    ports.push_back(static_cast<std::uint16_t>(std::stoul(port, nullptr, 16)));
  }
  return ports;
}

}  // namespace meshfarm::test
