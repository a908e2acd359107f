// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The live status: on a terminal, as lines, and as a page.
#include <array>
#include <cstdlib>
#include <string>

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>

#include "support/shell.hpp"

using meshfarm::test::has;
using meshfarm::test::listening_ports;
using meshfarm::test::Process;
using meshfarm::test::Ran;
using meshfarm::test::read_text;
using meshfarm::test::Shell;
using meshfarm::test::wait_until;

namespace {

constexpr const char* k_enter = "\x1b[?1049h";
constexpr const char* k_leave = "\x1b[?1049l";

/// A meshfarm process on a terminal of its own.
class OnTerminal {
 public:
  explicit OnTerminal(const std::vector<std::string>& words) : master_(::posix_openpt(O_RDWR)) {
    REQUIRE(master_ >= 0);
    REQUIRE(::grantpt(master_) == 0);
    REQUIRE(::unlockpt(master_) == 0);
    const winsize size{20, 80, 0, 0};
    ::ioctl(master_, TIOCSWINSZ, &size);
    const std::string name = ::ptsname(master_);
    slave_ = ::open(name.c_str(), O_RDWR | O_NOCTTY);
    pid_ = ::fork();
    if (pid_ == 0) become(words, name);
  }
  ~OnTerminal() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    ::close(slave_);
    ::close(master_);
  }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  void press(char key) const { REQUIRE(::write(master_, &key, 1) == 1); }
  bool echoes() const {
    termios now{};
    REQUIRE(::tcgetattr(slave_, &now) == 0);
    return (now.c_lflag & ECHO) != 0;
  }
  /// Whether `what` appears on the screen; reads all output up to then.
  bool shows(const std::string& what) {
    ::fcntl(master_, F_SETFL, O_NONBLOCK);
    return wait_until(
        [&] {
          std::array<char, 4096> bytes{};
          const ssize_t count = ::read(master_, bytes.data(), bytes.size());
          if (count > 0) seen_.append(bytes.data(), static_cast<std::size_t>(count));
          const std::size_t at = seen_.find(what);
          if (at == std::string::npos) return false;
          seen_.erase(0, at + what.size());
          return true;
        },
        20);
  }
  int wait() {
    int status = 0;
    REQUIRE(wait_until([&] { return ::waitpid(pid_, &status, WNOHANG) == pid_; }, 20));
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  bool is_stopped() const {
    const std::string stat = read_text("/proc/" + std::to_string(pid_) + "/stat");
    return has(stat, ") T ");
  }
  pid_t pid() const { return pid_; }

 private:
  [[noreturn]] static void become(const std::vector<std::string>& words, const std::string& name) {
    ::setsid();
    const int terminal = ::open(name.c_str(), O_RDWR);
    ::ioctl(terminal, TIOCSCTTY, 0);
    for (int fd = 0; fd < 3; ++fd) ::dup2(terminal, fd);
    ::setenv("TERM", "xterm", 1);
    ::setenv("LC_ALL", "C.UTF-8", 1);
    std::string program = MESHFARM_PROGRAM;
    std::vector<char*> argv = {program.data()};
    for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    ::execv(program.c_str(), argv.data());
    ::_exit(127);
  }

  int master_;
  int slave_ = -1;
  pid_t pid_ = -1;
  std::string seen_;
};

std::string cut_stage(Shell& shell) {
  const std::string sphere = shell.path("sphere.ply");
  REQUIRE(shell({"generate", "-o", sphere, "--triangles", "20000", "-q"}).code == 0);
  REQUIRE(shell({"cut", sphere, "--stage", shell.path("s.stage"), "--parts", "4", "-q"}).code == 0);
  return shell.path("s.stage");
}

std::vector<std::string> replay_of(const Shell& shell, const std::string& stage) {
  return {"replay", stage, "--ratio", "0.1", "--workers", "1", "-q", "-o", shell.path("o.ply")};
}

std::string fetch(std::uint16_t port, const std::string& path) {
  const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  REQUIRE(::connect(fd, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0);
  const std::string ask =
      "GET " + path + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
  REQUIRE(::write(fd, ask.data(), ask.size()) == static_cast<ssize_t>(ask.size()));
  std::string answer;
  std::array<char, 4096> bytes{};
  for (ssize_t count = 0; (count = ::read(fd, bytes.data(), bytes.size())) > 0;) {
    answer.append(bytes.data(), static_cast<std::size_t>(count));
  }
  ::close(fd);
  return answer;
}

}  // namespace

TEST_CASE("status --watch is a screen until the run is over, and leaves its end on the terminal") {
  Shell shell;
  const std::string stage = cut_stage(shell);
  OnTerminal watch({"status", stage, "--watch"});
  CHECK(watch.shows(k_enter));
  CHECK(watch.shows("none yet"));
  CHECK_FALSE(watch.echoes());
  REQUIRE(shell(replay_of(shell, stage)).code == 0);
  CHECK(watch.shows(k_leave));
  CHECK(watch.shows("phase            done"));
  CHECK(watch.shows("4 of 4 done"));
  CHECK(watch.wait() == 0);
  CHECK(watch.echoes());
}

TEST_CASE("status --watch gives the terminal back whoever ends or stops it") {
  Shell shell;
  const std::string stage = cut_stage(shell);
  const auto ends = [&](char key) {
    OnTerminal watch({"status", stage, "--watch"});
    CHECK(watch.shows("none yet"));
    watch.press(key);
    CHECK(watch.shows(k_leave));
    CHECK(watch.wait() == 0);
    CHECK(watch.echoes());
  };
  ends('q');
  ends('\x03');  // SIGINT

  OnTerminal watch({"status", stage, "--watch"});
  CHECK(watch.shows("none yet"));
  watch.press('\x1a');  // SIGTSTP; nobody in its session would continue it, so it continues itself
  CHECK(watch.shows(k_leave));
  CHECK(watch.shows(k_enter));
  ::kill(watch.pid(), SIGTERM);
  CHECK(watch.shows(k_leave));
  CHECK(watch.wait() == 0);
  CHECK(watch.echoes());
}

TEST_CASE("status --watch writes lines where there is no terminal") {
  Shell shell;
  const std::string stage = cut_stage(shell);
  Process watch({"status", stage, "--watch"}, shell.path("watch"));
  CHECK(wait_until([&] { return has(watch.out(), "runs: none yet; the cut is whole\n"); }, 20));
  REQUIRE(shell(replay_of(shell, stage)).code == 0);
  CHECK(watch.wait(20) == 0);
  CHECK(has(watch.out(), "phase            done"));
  CHECK_FALSE(has(watch.out(), "\x1b"));
}

TEST_CASE("status --serve shows the run to browsers of this host, through its end") {
  Shell shell;
  const std::string stage = cut_stage(shell);
  Process server({"status", stage, "--serve", "0"}, shell.path("serve"));
  REQUIRE(wait_until([&] { return has(server.out(), "\n"); }, 20));
  const std::vector<std::uint16_t> ports = listening_ports(server.pid());
  REQUIRE(ports.size() == 1);
  CHECK(server.out() == "http://localhost:" + std::to_string(ports[0]) + "\n");
  std::array<char, 16> hex{};
  std::snprintf(hex.data(), hex.size(), "%04X", ports[0]);
  CHECK(has(read_text("/proc/net/tcp"), "0100007F:" + std::string(hex.data())));
  CHECK(has(fetch(ports[0], "/"), "<!DOCTYPE html>"));
  CHECK(has(fetch(ports[0], "/status.json"), "\"phase\": \"cut\""));
  CHECK(has(fetch(ports[0], "/../manifest"), " 404 "));
  const auto is_done = [&](bool first) {
    return wait_until(
        [&] {
          const std::string status = fetch(ports[0], "/status.json");
          return has(status, "\"phase\": \"done\"") && has(status, "\"epoch\": 1,") == first;
        },
        20);
  };
  REQUIRE(shell(replay_of(shell, stage)).code == 0);
  CHECK(is_done(true));
  REQUIRE(shell(replay_of(shell, stage)).code == 0);
  CHECK(is_done(false));
  server.signal(SIGINT);
  CHECK(server.wait(20) == 0);
  CHECK(shell({"status", stage, "--serve", "0", "--watch"}).code == 2);
  CHECK(shell({"status", stage, "--serve", "65536"}).code == 2);
}
