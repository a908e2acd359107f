// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Whole runs of the real program: ventilator, sink and workers are processes that talk over TCP,
// and are killed, stopped and restarted. Every run must end with the same bytes.
#include <algorithm>
#include <chrono>
#include <random>
#include <thread>

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include "support/farm_bench.hpp"
#include "support/process.hpp"

using meshfarm::test::FarmBench;
using meshfarm::test::listening_ports;
using meshfarm::test::Process;
using meshfarm::test::Ran;
using meshfarm::test::results_in;
using meshfarm::test::wait_for_results;
namespace fs = std::filesystem;

namespace {

/// A mesh of 300,000 triangles in 24 parts, its cut, and the result of an undisturbed run.
class Bench : public FarmBench {
 public:
  Bench() : FarmBench("300000") {
    const std::string output = path("expected.ply");
    expect(meshfarm({"simplify", mesh(), "-o", output, "--ratio", "0.02", "--parts", "24",
                     "--workers", "2"}),
           output);
  }

  std::string cut() { return FarmBench::cut({"--parts", "24"}); }
  Process ventilator(const std::string& stage) {
    return start(
        {"ventilator", stage, "--ratio", "0.02", "--bind", "127.0.0.1", "--heartbeat-ms", "150"});
  }
  Process sink(const std::string& stage) {
    return start({"sink", stage, "--ratio", "0.02", "--bind", "127.0.0.1", "-o", stage + ".ply"});
  }
  Process worker(const std::string& stage) { return start({"worker", stage}); }
};

Bench& bench() {
  static Bench instance;
  return instance;
}

/// Sends bytes to a port and closes; it does not matter whether anyone listens.
void send_bytes(std::uint16_t port, const std::string& bytes) {
  const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) {
    (void)::send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }
  ::close(fd);
}

/// The children of a process whose command line has `command` right after the program's name.
std::vector<pid_t> children_of(pid_t parent, const std::string& command) {
  const std::string self = std::to_string(parent);
  std::ifstream list("/proc/" + self + "/task/" + self + "/children");
  std::vector<pid_t> found;
  for (pid_t child = 0; list >> child;) {
    std::ifstream words("/proc/" + std::to_string(child) + "/cmdline");
    std::string program;
    std::string word;
    std::getline(std::getline(words, program, '\0'), word, '\0');
    if (word == command) found.push_back(child);
  }
  return found;
}

}  // namespace

TEST_CASE("1, 2 and 5 workers make the same bytes") {
  for (const char* workers : {"1", "5"}) {
    CAPTURE(workers);
    const std::string output = bench().path(std::string("w") + workers + ".ply");
    const Ran ran = bench().meshfarm({"simplify", bench().mesh(), "-o", output, "--ratio", "0.02",
                                      "--parts", "24", "--workers", workers});
    CHECK(ran.code == 0);
    bench().check_result(output);
    CHECK_FALSE(fs::exists(output + ".stage"));
  }
}

TEST_CASE("a cut, ventilator and sink, and two workers started by hand make the same bytes") {
  const std::string stage = bench().cut();
  Process one = bench().worker(stage);  // a worker may be started before all others
  Process run =
      bench().start({"run", stage, "--ratio", "0.02", "-o", stage + ".ply", "--bind", "127.0.0.1"});
  Process two = bench().worker(stage);
  CHECK(run.wait() == 0);
  CHECK(one.wait() == 0);
  CHECK(two.wait() == 0);
  bench().check_result(stage + ".ply");

  SUBCASE("and a replay of the same stage too, with nothing simplified again") {
    const std::size_t results = results_in(stage);
    const std::string output = stage + "-again.ply";
    const Ran ran = bench().meshfarm({"replay", stage, "-o", output, "--ratio", "0.02"});
    CHECK(ran.code == 0);
    bench().check_result(output);
    CHECK(results_in(stage) == results);
  }
  SUBCASE("and another target from the same cut is met") {
    const std::string output = stage + "-half.ply";
    const Ran ran =
        bench().meshfarm({"replay", stage, "-o", output, "--triangles", "12000", "--json"});
    CHECK(ran.code == 0);
    CHECK(ran.out.find("\"triangles\": 12000") != std::string::npos);
  }
}

TEST_CASE("a worker killed half-way costs nothing but time") {
  const std::string stage = bench().cut();
  Process ventilator = bench().ventilator(stage);
  Process sink = bench().sink(stage);
  Process killed = bench().worker(stage);
  REQUIRE(wait_for_results(stage, 3));
  killed.signal(SIGKILL);
  CHECK(killed.wait() == -SIGKILL);
  Process heir = bench().worker(stage);
  CHECK(sink.wait() == 0);
  CHECK(ventilator.wait() == 0);
  CHECK(heir.wait() == 0);
  bench().check_result(stage + ".ply");
}

TEST_CASE("a worker that hangs loses its jobs to another, and its late results do no harm") {
  const std::string stage = bench().cut();
  Process ventilator = bench().ventilator(stage);
  Process sink = bench().sink(stage);
  Process hung = bench().worker(stage);
  REQUIRE(wait_for_results(stage, 2));
  hung.signal(SIGSTOP);
  Process heir = bench().worker(stage);
  REQUIRE(wait_for_results(stage, 20));
  hung.signal(SIGCONT);
  CHECK(sink.wait() == 0);
  CHECK(ventilator.wait() == 0);
  CHECK(heir.wait() == 0);
  bench().check_result(stage + ".ply");
}

TEST_CASE("sink, then ventilator, killed and started again: the run goes on") {
  const std::string stage = bench().cut();
  Process ventilator = bench().ventilator(stage);
  Process sink = bench().sink(stage);
  Process one = bench().worker(stage);
  Process two = bench().worker(stage);
  REQUIRE(wait_for_results(stage, 4));
  sink.signal(SIGKILL);
  CHECK(sink.wait() == -SIGKILL);
  sink = bench().sink(stage);
  REQUIRE(wait_for_results(stage, 10));
  ventilator.signal(SIGKILL);
  CHECK(ventilator.wait() == -SIGKILL);
  ventilator = bench().ventilator(stage);
  CHECK(sink.wait() == 0);
  CHECK(ventilator.wait() == 0);
  CHECK(one.wait() == 0);
  CHECK(two.wait() == 0);
  bench().check_result(stage + ".ply");
}

TEST_CASE("a ventilator started again when the sink has ended sees that the run is over") {
  const std::string stage = bench().cut();
  const auto start_ventilator = [&](const char* ratio) {
    return bench().start(
        {"ventilator", stage, "--ratio", ratio, "--bind", "127.0.0.1", "--wait", "1"});
  };
  Process ventilator = start_ventilator("0.02");
  Process sink = bench().start({"sink", stage, "--ratio", "0.02", "--bind", "127.0.0.1", "-o",
                                stage + ".ply", "--wait", "1"});
  Process worker = bench().worker(stage);
  // The sink has everything it needs, and the ventilator is killed before it hears of the end.
  CHECK(meshfarm::test::wait_until([&] { return results_in(stage) == 24; }));
  ventilator.signal(SIGSTOP);
  CHECK(meshfarm::test::wait_until([&] { return fs::exists(stage + ".ply"); }));
  ventilator.signal(SIGKILL);
  CHECK(ventilator.wait() == -SIGKILL);
  CHECK(sink.wait() == 0);
  ventilator = start_ventilator("0.02");
  CHECK(ventilator.wait() == 0);
  CHECK(ventilator.err().find("was made while no ventilator was there") != std::string::npos);
  CHECK(worker.wait() == 0);
}

TEST_CASE("a ventilator without a sink does not end as if there were a result") {
  const std::string stage = bench().cut();
  REQUIRE(bench().meshfarm({"replay", stage, "--ratio", "0.02", "-o", stage + ".ply"}).code == 0);
  // The earlier run is over: its results do not count for this one.
  Process ventilator =
      bench().start({"ventilator", stage, "--ratio", "0.02", "--bind", "127.0.0.1", "--wait", "1"});
  CHECK(ventilator.wait(3) == -1000);
  ventilator.signal(SIGTERM);
  CHECK(ventilator.wait() == 3);
}

TEST_CASE("everything killed, everything started again: only what was not accepted is done") {
  const std::string stage = bench().cut();
  {
    Process ventilator = bench().ventilator(stage);
    Process sink = bench().sink(stage);
    Process worker = bench().worker(stage);
    REQUIRE(wait_for_results(stage, 8));
  }  // all are killed here
  const std::size_t before = results_in(stage);
  const Ran ran = bench().meshfarm({"replay", stage, "-o", stage + ".ply", "--ratio", "0.02"});
  CHECK(ran.code == 0);
  bench().check_result(stage + ".ply");
  const std::size_t journalled_before = before - 5;  // those that the worker held may be lost
  CHECK(results_in(stage) <= 24 + before - journalled_before);
}

TEST_CASE("after Ctrl-C the same command goes on") {
  const std::string output = bench().path("again.ply");
  const std::vector<std::string> words = {"simplify", bench().mesh(), "-o", output,      "--ratio",
                                          "0.02",     "--parts",      "24", "--workers", "1"};
  Process simplify = bench().start(words);
  REQUIRE(wait_for_results(output + ".stage", 3));
  const Ran second = bench().meshfarm(words);
  CHECK(second.code == 1);
  CHECK(second.err.find("process " + std::to_string(simplify.pid())) != std::string::npos);
  simplify.signal(SIGINT);
  CHECK(simplify.wait() == 3);
  CHECK(simplify.err().find("to continue, run the same command again") != std::string::npos);
  const Ran ran = bench().meshfarm(words);
  CHECK(ran.code == 0);
  CHECK(ran.err.find("already holds this cut") != std::string::npos);
  bench().check_result(output);
  CHECK_FALSE(fs::exists(output + ".stage"));
}

TEST_CASE("Ctrl-C leaves a stage that replay takes up") {
  const std::string output = bench().path("interrupted.ply");
  Process simplify = bench().start({"simplify", bench().mesh(), "-o", output, "--ratio", "0.02",
                                    "--parts", "24", "--workers", "1"});
  const std::string stage = output + ".stage";
  REQUIRE(wait_for_results(stage, 3));
  simplify.signal(SIGINT);
  CHECK(simplify.wait() == 3);
  CHECK(simplify.err().find("meshfarm replay " + stage) != std::string::npos);
  CHECK_FALSE(fs::exists(output));
  const Ran ran = bench().meshfarm({"replay", stage, "-o", output, "--ratio", "0.02"});
  CHECK(ran.code == 0);
  bench().check_result(output);
}

TEST_CASE("a worker that is asked to leave gives back what it holds") {
  const std::string stage = bench().cut();
  Process ventilator = bench().ventilator(stage);
  Process sink = bench().sink(stage);
  Process leaving = bench().worker(stage);
  REQUIRE(wait_for_results(stage, 3));
  leaving.signal(SIGTERM);
  CHECK(leaving.wait(10) == 3);
  Process heir = bench().worker(stage);
  CHECK(sink.wait() == 0);
  CHECK(ventilator.wait() == 0);
  bench().check_result(stage + ".ply");
}

TEST_CASE("random bytes to every socket are refused and the run goes on") {
  const std::string stage = bench().cut();
  Process ventilator = bench().ventilator(stage);
  Process sink = bench().sink(stage);
  Process worker = bench().worker(stage);
  REQUIRE(wait_for_results(stage, 1));
  std::vector<std::uint16_t> ports = listening_ports(ventilator.pid());
  CHECK(ports.size() == 2);  // control, and the worker's lane
  for (const std::uint16_t port : listening_ports(sink.pid())) ports.push_back(port);
  CHECK(ports.size() == 3);  // and results

  std::mt19937 random(7);
  const auto blob = [&](std::size_t size) {
    std::string bytes(size, '\0');
    for (char& c : bytes) c = static_cast<char>(random());
    return bytes;
  };
  const std::string greeting = std::string("\xff\0\0\0\0\0\0\0\x01\x7f\x03\0NULL", 16);
  for (int i = 0; i < 20; ++i) {
    for (const std::uint16_t port : ports) {
      send_bytes(port, blob(random() % 5000));
      send_bytes(port, "GET / HTTP/1.1\r\n\r\n");
      send_bytes(port, greeting + std::string(48, '\0') + blob(300));
    }
  }
  CHECK(sink.wait() == 0);
  CHECK(ventilator.wait() == 0);
  CHECK(worker.wait() == 0);
  bench().check_result(stage + ".ply");
}

TEST_CASE("a staged part with a flipped byte, or cut short, is named and nothing is written") {
  for (const bool cut_short : {false, true}) {
    CAPTURE(cut_short);
    const std::string stage = bench().cut();
    const fs::path part = fs::path(stage) / "parts" / "000005.part";
    if (cut_short) {
      fs::resize_file(part, fs::file_size(part) - 1);
    } else {
      std::fstream file(part, std::ios::in | std::ios::out | std::ios::binary);
      file.seekp(1000);
      file.put('\x55');
    }
    const Ran ran = bench().meshfarm(
        {"replay", stage, "-o", stage + ".ply", "--ratio", "0.02", "--workers", "2", "-q"});
    CHECK(ran.code == 1);
    CHECK(ran.err.find("error: 1 job failed for good: ") != std::string::npos);
    CHECK(ran.err.find("000005.part") != std::string::npos);
    CHECK(std::count(ran.err.begin(), ran.err.end(), '\n') == 1);
    CHECK_FALSE(fs::exists(stage + ".ply"));
  }
}

TEST_CASE("an accepted result that is damaged later is noticed and made again") {
  const std::string stage = bench().cut();
  REQUIRE(bench().meshfarm({"replay", stage, "-o", stage + ".ply", "--ratio", "0.02"}).code == 0);
  for (const auto& entry : fs::directory_iterator(fs::path(stage) / "results")) {
    std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(200);
    file.put('\x55');
    break;
  }
  const std::string output = stage + "-again.ply";
  const Ran ran = bench().meshfarm({"replay", stage, "-o", output, "--ratio", "0.02"});
  CHECK(ran.code == 0);
  bench().check_result(output);
}

TEST_CASE("results damaged while no sink is there are made again, whenever sinks are killed") {
  const std::string stage = bench().cut();
  Process ventilator = bench().ventilator(stage);
  Process sink = bench().sink(stage);
  Process one = bench().worker(stage);
  Process two = bench().worker(stage);
  REQUIRE(wait_for_results(stage, 10));
  sink.signal(SIGKILL);
  CHECK(sink.wait() == -SIGKILL);
  int damaged = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(stage) / "results")) {
    if (++damaged > 6) break;
    if (damaged % 3 == 0) {
      fs::resize_file(entry.path(), fs::file_size(entry.path()) - 1);
      continue;
    }
    std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(200);
    file.put('\x55');
  }
  // Killed once when it has just begun to look, once when it may be taking back damaged results.
  for (const int life_ms : {30, 250}) {
    sink = bench().sink(stage);
    std::this_thread::sleep_for(std::chrono::milliseconds(life_ms));
    sink.signal(SIGKILL);
    sink.wait();
  }
  sink = bench().sink(stage);
  CHECK(sink.wait() == 0);
  CHECK(ventilator.wait() == 0);
  CHECK(one.wait() == 0);
  CHECK(two.wait() == 0);
  bench().check_result(stage + ".ply");
}

TEST_CASE("a damaged manifest is one clear line") {
  const std::string stage = bench().cut();
  std::ofstream(fs::path(stage) / "manifest", std::ios::app) << "x";
  const Ran ran = bench().meshfarm({"replay", stage, "-o", stage + ".ply", "--ratio", "0.02"});
  CHECK(ran.code == 1);
  CHECK(ran.err == "meshfarm replay: error: " + (fs::path(stage) / "manifest").string() +
                       ": 1 bytes too many at byte " +
                       std::to_string(fs::file_size(fs::path(stage) / "manifest") - 1) + "\n");
}

TEST_CASE("two runs of different targets do not mix") {
  const std::string stage = bench().cut();
  Process ventilator = bench().ventilator(stage);
  Process stranger = bench().start({"sink", stage, "--ratio", "0.5", "--bind", "127.0.0.1", "-o",
                                    stage + "-other.ply", "--wait", "1"});
  CHECK(stranger.wait() == 3);
  CHECK(stranger.err().find("another run") != std::string::npos);
  Process sink = bench().sink(stage);
  Process worker = bench().worker(stage);
  CHECK(sink.wait() == 0);
  CHECK(ventilator.wait() == 0);
  bench().check_result(stage + ".ply");
}

TEST_CASE("a run and two replays of one stage at once have their own workers, and each ends") {
  const std::string stage = bench().cut();
  Process run =
      bench().start({"run", stage, "--ratio", "0.02", "-o", stage + ".ply", "--bind", "127.0.0.1"});
  std::vector<Process> replays;
  for (const char* ratio : {"0.05", "0.1"}) {
    replays.push_back(bench().start(
        {"replay", stage, "--ratio", ratio, "--workers", "1", "-o", stage + ratio + ".ply"}));
  }
  for (Process& replay : replays) CHECK(replay.wait() == 0);
  const Ran key = bench().meshfarm({"run", stage, "--ratio", "0.02", "--worker-words"});
  CHECK(key.code == 0);
  REQUIRE(key.out.rfind("--run\n", 0) == 0);
  Process worker = bench().start({"worker", stage, "--run", key.out.substr(6, 16)});
  CHECK(run.wait() == 0);
  CHECK(worker.wait() == 0);
  bench().check_result(stage + ".ply");
}

TEST_CASE("clean leaves what a killed run needs, and takes what finished ones made") {
  const std::string stage = bench().cut();
  const auto replay = [&](const char* ratio) {
    return bench().meshfarm({"replay", stage, "--ratio", ratio, "-o", stage + ".ply", "-q"});
  };
  REQUIRE(replay("0.05").code == 0);
  REQUIRE(replay("0.2").code == 0);
  const std::size_t finished = results_in(stage);
  Process run = bench().start({"replay", stage, "--ratio", "0.02", "-o", stage + ".ply"});
  CHECK(wait_for_results(stage, finished + 8));
  run.signal(SIGKILL);
  CHECK(run.wait() == -SIGKILL);
  // Its processes end shortly after it.
  const auto kept_for_sink = [&] {
    return bench().meshfarm({"clean", stage, "--dry-run"}).out.find("a sink is at work") !=
           std::string::npos;
  };
  CHECK(meshfarm::test::wait_until([&] { return !kept_for_sink(); }));
  const std::size_t before = results_in(stage);
  const Ran cleaned = bench().meshfarm({"clean", stage});
  CAPTURE(cleaned.out);
  CHECK(cleaned.code == 0);
  CHECK(cleaned.out.find("results of finished runs") != std::string::npos);
  CHECK(before - results_in(stage) >= finished / 2);
  CHECK(results_in(stage) >= 1);
  CHECK(replay("0.02").code == 0);
  bench().check_result(stage + ".ply");
  CHECK(bench().meshfarm({"clean", stage}).code == 0);
  CHECK(results_in(stage) == 0);
  CHECK(replay("0.02").code == 0);  // everything is made again
  bench().check_result(stage + ".ply");
}

TEST_CASE("a worker of a pool serves one run after another, and looks on") {
  const std::string pool = bench().path("pool");
  fs::create_directory(pool);
  std::vector<std::string> stages;
  for (const char* name : {"one", "two"}) {
    stages.push_back(bench().cut());
    fs::create_directory_symlink(stages.back(), fs::path(pool) / name);
  }
  Process worker = bench().start({"worker", "--pool", pool});
  std::vector<Process> centre;
  for (const std::string& stage : stages) {
    centre.push_back(bench().ventilator(stage));
    centre.push_back(bench().sink(stage));
  }
  for (Process& each : centre) CHECK(each.wait() == 0);
  for (const std::string& stage : stages) bench().check_result(stage + ".ply");
  CHECK(bench().meshfarm({"clean", stages[0]}).code == 0);
  Process ventilator = bench().ventilator(stages[0]);  // another run comes later
  Process sink = bench().sink(stages[0]);
  CHECK(sink.wait() == 0);
  CHECK(ventilator.wait() == 0);
  worker.signal(SIGTERM);
  CHECK(worker.wait() == 0);
  CHECK(bench().meshfarm({"worker", "--pool", pool, "--wait", "1"}).code == 0);
  CHECK(bench().meshfarm({"worker"}).code == 2);
  CHECK(bench().meshfarm({"worker", stages[0], "--pool", pool}).code == 2);
}

TEST_CASE("a run's processes show as meshfarm, and a worker that left before the end is replaced") {
  const std::string stage = bench().cut();
  Process replay =
      bench().start({"replay", stage, "--ratio", "0.02", "--workers", "1", "-o", stage + ".ply"});
  REQUIRE(wait_for_results(stage, 2));
  for (const char* command : {"ventilator", "sink", "worker"}) {
    CAPTURE(command);
    const std::vector<pid_t> pids = children_of(replay.pid(), command);
    REQUIRE(pids.size() == 1);
    CHECK(meshfarm::test::read_text("/proc/" + std::to_string(pids[0]) + "/comm") == "meshfarm\n");
    if (command == std::string("worker")) ::kill(pids[0], SIGTERM);
  }
  CHECK(replay.wait() == 0);
  CHECK(replay.err().find("started again") != std::string::npos);
  bench().check_result(stage + ".ply");
}
