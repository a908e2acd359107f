// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#define DOCTEST_CONFIG_IMPLEMENT
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <doctest/doctest.h>
#include <unistd.h>

#include "cli/supervisor.hpp"
#include "support/temp_folder.hpp"

// The supervisor starts this program again as ventilator, sink or worker: it then acts as the words
// after the name say.

using namespace meshfarm;

namespace {

namespace fs = std::filesystem;

std::string content_of(const fs::path& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

void append_to(const fs::path& path, char c) {
  std::ofstream(path, std::ios::app) << c;
}

/// The words of a child: its name, the file that gets a letter at each start, and what it does at
/// its first start, its second and so on; any further start repeats the last one given.
///   done, left, bad   exits with 0, 3, 1
///   killed            is ended by a signal
///   waits             until SIGTERM ends it, or for a minute
///   NAME:N            exits with 0 once the child NAME was started N times, or after a minute
///   dies              is ended by a signal two seconds after the first start of worker0
std::vector<std::string> child(const std::string& name, const fs::path& starts,
                               const std::vector<std::string>& acts) {
  std::vector<std::string> words = {name, starts.string()};
  words.insert(words.end(), acts.begin(), acts.end());
  return words;
}

void await_starts(const fs::path& starts, std::size_t count) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (content_of(starts).size() < count && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

int act(const std::string& what, const fs::path& folder) {
  if (what == "left") return 3;
  if (what == "bad") return 1;
  if (what == "killed") ::raise(SIGKILL);
  if (what == "waits") ::sleep(60);
  if (what == "dies") {
    await_starts(folder / "worker0", 1);
    ::sleep(2);
    ::raise(SIGKILL);
  }
  const std::size_t colon = what.find(':');
  if (colon != std::string::npos) {
    await_starts(folder / what.substr(0, colon), std::stoul(what.substr(colon + 1)));
  }
  return 0;
}

int be_child(const std::vector<std::string>& words) {
  const fs::path starts = words.at(1);
  const std::size_t before = content_of(starts).size();
  append_to(starts, 's');
  return act(words.at(std::min(2 + before, words.size() - 1)), starts.parent_path());
}

/// A run of these children.
struct Crew {
  explicit Crew(const std::vector<std::string>& ventilator, const std::vector<std::string>& sink) {
    supervisor.start(child("ventilator", folder.path() / "ventilator", ventilator));
    supervisor.start(child("sink", folder.path() / "sink", sink));
  }
  void add_worker(const std::vector<std::string>& acts) {
    const std::string name = "worker" + std::to_string(workers++);
    supervisor.start(child("worker", folder.path() / name, acts));
  }
  std::size_t starts_of(const std::string& name) const {
    return content_of(folder.path() / name).size();
  }

  test::TempFolder folder;
  std::atomic<bool> stop = false;
  Supervisor supervisor{stop};
  int workers = 0;
};

using Clock = std::chrono::steady_clock;

}  // namespace

TEST_CASE("a run ends well when ventilator and sink have, and takes its workers along") {
  Crew crew({"worker0:1"}, {"worker1:1"});
  crew.add_worker({"waits"});
  crew.add_worker({"done"});
  const auto begin = Clock::now();
  CHECK(crew.supervisor.run() == 0);
  CHECK(Clock::now() - begin < std::chrono::seconds(9));
  for (const char* name : {"ventilator", "sink", "worker0", "worker1"}) {
    CHECK(crew.starts_of(name) == 1);
  }
}

TEST_CASE("what a signal ends is started again") {
  Crew crew({"killed", "killed", "worker0:2"}, {"killed", "ventilator:3"});
  crew.add_worker({"killed", "waits"});
  CHECK(crew.supervisor.run() == 0);
  CHECK(crew.starts_of("ventilator") == 3);
  CHECK(crew.starts_of("sink") == 2);
  CHECK(crew.starts_of("worker0") == 2);
}

TEST_CASE("workers that were done come back to a sink that is started again") {
  Crew crew({"sink:2"}, {"dies", "worker0:2"});
  crew.add_worker({"done", "waits"});
  crew.add_worker({"waits"});
  CHECK(crew.supervisor.run() == 0);
  CHECK(crew.starts_of("sink") == 2);
  CHECK(crew.starts_of("worker0") == 2);
  CHECK(crew.starts_of("worker1") == 1);
}

TEST_CASE("a worker that left before the end is started again, others that left are not") {
  Crew crew({"worker0:3"}, {"worker0:3"});
  crew.add_worker({"left", "left", "waits"});
  CHECK(crew.supervisor.run() == 0);
  CHECK(crew.starts_of("worker0") == 3);

  Crew other({"left"}, {"waits"});
  other.add_worker({"waits"});
  CHECK(other.supervisor.run() == 3);
  CHECK(other.starts_of("ventilator") == 1);
}

TEST_CASE("a run goes on as long as one worker does") {
  Crew crew({"worker1:1"}, {"worker0:1"});
  crew.add_worker({"bad"});
  crew.add_worker({"waits"});
  CHECK(crew.supervisor.run() == 0);

  Crew alone({"waits"}, {"waits"});
  alone.add_worker({"bad"});
  CHECK(alone.supervisor.run() == 1);
  CHECK(alone.starts_of("worker0") == 1);
}

TEST_CASE("a sink that fails ends the run with its code") {
  Crew crew({"waits"}, {"bad"});
  crew.add_worker({"waits"});
  CHECK(crew.supervisor.run() == 1);
  CHECK(crew.starts_of("sink") == 1);
}

TEST_CASE("nobody needs a ventilator once the sink is done") {
  Crew failing({"worker0:1", "done"}, {"done"});
  failing.add_worker({"waits"});
  CHECK(failing.supervisor.run() == 0);

  Crew waiting({"waits"}, {"done"});
  waiting.add_worker({"waits"});
  const auto begin = Clock::now();
  CHECK(waiting.supervisor.run() == 0);
  CHECK(Clock::now() - begin < std::chrono::seconds(20));
}

TEST_CASE("what a signal ends again and again is given up") {
  Crew crew({"waits"}, {"killed"});
  crew.add_worker({"waits"});
  CHECK(crew.supervisor.run() == 1);
  CHECK(crew.starts_of("sink") == 21);
}

TEST_CASE("a run that is stopped can be taken up again") {
  Crew crew({"waits"}, {"waits"});
  crew.add_worker({"waits"});
  std::thread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    crew.stop = true;
  });
  CHECK(crew.supervisor.run() == 3);
  stopper.join();
}

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const bool is_child =
      words.size() > 2 && (words[0] == "ventilator" || words[0] == "sink" || words[0] == "worker");
  return is_child ? be_child(words) : doctest::Context(argc, argv).run();
}
