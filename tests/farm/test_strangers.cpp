// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A run of the real processes under attack by strangers who reach its ports but do not have its
// keys. The run ends with the same bytes, the strangers are counted, and they cost no memory.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <random>
#include <sstream>

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/util/file.hpp>

#include "support/process.hpp"
#include "support/temp_folder.hpp"
#include "transport/sockets.hpp"

using namespace meshfarm;
using meshfarm::test::listening_ports;
using meshfarm::test::Process;
using meshfarm::test::read_text;
using meshfarm::test::run_meshfarm;
using meshfarm::test::TempFolder;
using meshfarm::test::wait_until;
namespace fs = std::filesystem;

namespace {

constexpr int k_idle_connections = 500;
constexpr std::size_t k_flood_bytes = 80'000'000;
#ifdef MESHFARM_SANITIZED
constexpr std::uint64_t k_most_growth_kb = 102'400;  // sanitizers need memory of their own
#else
constexpr std::uint64_t k_most_growth_kb = 10'240;
#endif

/// "VmRSS" or "VmHWM" of a process, in KiB.
std::uint64_t memory_kb(pid_t pid, const std::string& name) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(name + ":")) return std::stoull(line.substr(name.size() + 1));
  }
  return 0;
}

Fd connect_raw(std::uint16_t port) {
  Fd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  REQUIRE(::connect(fd.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0);
  return fd;
}

/// Sends as much as the other side takes, which may hang up at any byte or stop reading.
std::size_t send_raw(const Fd& fd, std::string_view bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    pollfd writable{fd.get(), POLLOUT, 0};
    if (::poll(&writable, 1, 200) <= 0) break;
    const ssize_t count =
        ::send(fd.get(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count <= 0) break;
    sent += static_cast<std::size_t>(count);
  }
  return sent;
}

/// The first 64 bytes of ZMTP 3.1 (rfc.zeromq.org/spec/23) of a client with this mechanism.
std::string greeting(const std::string& mechanism) {
  std::string bytes = "\xff" + std::string(8, '\0') + "\x7f\x03\x01" + mechanism;
  bytes.resize(64, '\0');
  return bytes;
}

std::string random_bytes(std::mt19937& random, std::size_t size) {
  std::string bytes(size, '\0');
  for (char& c : bytes) c = static_cast<char>(random());
  return bytes;
}

std::vector<std::string> garbage() {
  std::mt19937 random(7);
  std::vector<std::string> list = {"GET / HTTP/1.1\r\n\r\n", std::string(100'000, '\0')};
  const std::string endless_command = "\x06" + std::string(1, '\x01') + std::string(7, '\0');
  list.push_back(greeting("CURVE") + endless_command + random_bytes(random, 5'000));
  list.push_back(greeting("CURVE") + "\x04\xc8\x05HELLO" + random_bytes(random, 194));
  list.push_back(greeting("NULL") + std::string("\x04\x06\x05READY", 8));
  list.push_back(greeting("PLAIN") + std::string("\x04\x08\x05HELLO\0\0", 10));
  for (int i = 0; i < 20; ++i) list.push_back(random_bytes(random, random() % 3'000 + 1));
  return list;
}

/// An endless multipart message, sent without waiting for an answer.
void flood(std::uint16_t port) {
  const Fd fd = connect_raw(port);
  std::string bytes =
      greeting("NULL") + std::string("\x04\x19\x05READY\x0bSocket-Type\0\0\0\x04PUSH", 29);
  const std::string more_frame = "\x01\xff" + std::string(255, 'x');
  while (bytes.size() < 1'000'000) bytes += more_frame;
  for (std::size_t sent = 0; sent < k_flood_bytes; sent += bytes.size()) {
    if (send_raw(fd, bytes) < bytes.size()) return;
  }
}

/// ZeroMQ clients that speak our protocol but cannot prove that they belong to the run.
class Impostors {
 public:
  void attack(const std::string& address, const std::string& server_key) {
    Keys wrong = make_run_keys();
    visit(address, wrong);
    wrong->server_public = server_key;  // not a secret: the endpoint file contains it
    visit(address, wrong);
    visit(address, std::nullopt);
  }

 private:
  void visit(const std::string& address, const Keys& keys) {
    sockets_.push_back(make_results_client(context_, keys));
    sockets_.push_back(make_control_client(context_, keys, random_id()));
    for (auto socket = sockets_.end() - 2; socket != sockets_.end(); ++socket) {
      socket->set(zmq::sockopt::linger, 0);
      socket->connect(address);
      for (int i = 0; i < 100; ++i) send(*socket, forged_result());
      send(*socket, Failed{1, "forged"});
      send(*socket, Complete{1});
    }
  }
  static Message forged_result() {
    const std::string name = to_string(ResultName{1, 1, 5});
    return Result{7, 1, {1}, 5, 1, {1}, JobOutput{{name, 1, 2}, "forged"}};
  }

  zmq::context_t context_{1};
  std::vector<zmq::socket_t> sockets_;
};

std::string address_of(std::uint16_t port) {
  return "tcp://127.0.0.1:" + std::to_string(port);
}

/// N of "refused N connections" in a log; 0 if it has none.
std::uint64_t refused_in(const std::string& log) {
  const std::size_t at = log.find("refused ");
  return at == std::string::npos ? 0 : std::strtoull(log.c_str() + at + 8, nullptr, 10);
}

struct Memory {
  explicit Memory(pid_t process) : pid(process), before_kb(memory_kb(process, "VmRSS")) {}
  void check() const {
    const std::uint64_t peak_kb = memory_kb(pid, "VmHWM");
    MESSAGE("from ", before_kb, " to at most ", peak_kb, " KiB");
    CHECK(peak_kb < before_kb + k_most_growth_kb);
  }
  pid_t pid;
  std::uint64_t before_kb;
};

}  // namespace

TEST_CASE("strangers are refused and counted, cost no memory, and the run goes on") {
  const TempFolder folder;
  const auto path = [&](const std::string& name) { return (folder.path() / name).string(); };
  const std::string stage = path("stage");
  REQUIRE(run_meshfarm({"generate", "-o", path("mesh.ply"), "--triangles", "200000"}, path("log1"))
              .code == 0);
  REQUIRE(run_meshfarm({"cut", path("mesh.ply"), "--stage", stage, "--parts", "16"}, path("log2"))
              .code == 0);
  const std::vector<std::string> run = {stage, "--ratio", "0.02", "--bind", "127.0.0.1"};
  const auto start = [&](std::vector<std::string> words, const std::string& log) {
    words.insert(words.begin() + 1, run.begin(), run.end());
    return Process(words, path(log));
  };
  // Heartbeats are long enough that a worker which is stopped for a while is not declared lost.
  Process ventilator = start({"ventilator", "--heartbeat-ms", "20000"}, "ventilator");
  Process sink = start({"sink", "-o", path("out.ply")}, "sink");
  Process worker({"worker", stage}, path("worker"));
  REQUIRE(wait_until([&] { return !fs::is_empty(fs::path(stage) / "results"); }));
  worker.signal(SIGSTOP);

  const std::vector<std::uint16_t> at_ventilator = listening_ports(ventilator.pid());
  const std::vector<std::uint16_t> at_sink = listening_ports(sink.pid());
  REQUIRE(at_ventilator.size() == 2);  // control, and the worker's lane
  REQUIRE(at_sink.size() == 1);
  const std::vector<std::uint16_t> ports = {at_ventilator[0], at_ventilator[1], at_sink[0]};
  EndpointList endpoints;
  const std::string server_key = endpoints.look(Stage::open(stage)).back().server_key;
  const Memory of_ventilator(ventilator.pid());
  const Memory of_sink(sink.pid());

  std::vector<Fd> idle;
  for (int i = 0; i < k_idle_connections; ++i) {
    idle.push_back(connect_raw(ports[static_cast<std::size_t>(i) % ports.size()]));
    if (i % 2 == 0) send_raw(idle.back(), greeting("CURVE"));
  }
  Impostors impostors;
  const std::vector<std::string> blobs = garbage();
  for (const std::uint16_t port : ports) {
    impostors.attack(address_of(port), server_key);
    for (const std::string& bytes : blobs) send_raw(connect_raw(port), bytes);
    flood(port);
  }
  // Connections that have not identified themselves within five seconds are closed.
  CHECK(wait_until(
      [&] {
        return std::all_of(idle.begin(), idle.end(), [](const Fd& fd) {
          pollfd hung_up{fd.get(), POLLRDHUP, 0};
          return ::poll(&hung_up, 1, 0) == 1;
        });
      },
      20));
  of_ventilator.check();
  of_sink.check();

  worker.signal(SIGCONT);
  CHECK(sink.wait() == 0);
  CHECK(ventilator.wait() == 0);
  CHECK(worker.wait() == 0);
  const std::uint64_t each = blobs.size() + 1 + 6 + k_idle_connections / 3;  // at each port
  CHECK(refused_in(ventilator.err()) >= 2 * each);
  CHECK(refused_in(sink.err()) >= each);
  REQUIRE(run_meshfarm({"simplify", path("mesh.ply"), "--parts", "16", "--ratio", "0.02", "-o",
                        path("calm.ply")},
                       path("log3"))
              .code == 0);
  CHECK(read_text(path("out.ply")) == read_text(path("calm.ply")));
}
