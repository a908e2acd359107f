// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <doctest/doctest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/util/file.hpp>

#include "farm_fixture.hpp"
#include "transport/run_keys.hpp"
#include "transport/sockets.hpp"

namespace meshfarm::test {
namespace {

constexpr std::chrono::milliseconds k_stranger_soon{10'000};

Endpoint wait_for_endpoint(const Stage& stage) {
  EndpointList list;
  const auto end = std::chrono::steady_clock::now() + k_stranger_soon;
  while (list.look(stage).empty() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  REQUIRE_FALSE(list.look(stage).empty());
  return list.look(stage).back();
}

/// The next message of type M, skipping others; nothing if none arrives in time.
template <class M>
std::optional<M> wait_for_message(zmq::socket_t& socket, std::chrono::milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  for (;;) {
    while (auto received = receive(socket)) {
      if (!received->message) continue;
      if (auto* found = std::get_if<M>(&*received->message)) return std::move(*found);
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    if (left.count() <= 0) return std::nullopt;
    std::vector<zmq::pollitem_t> items = {{socket.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, left);
  }
}

/// A worker operated by hand.
struct FakeWorker {
  FakeWorker(const Stage& stage, const Endpoint& endpoint)
      : keys(keys_to_connect(stage, endpoint, {})),
        control(make_control_client(context, keys, random_id())),
        lane(make_lane_client(context, keys)) {
    control.connect(endpoint.address);
    send(control, Hello{Role::worker, 0, incarnation, 1, "fake", {}});
    welcome = *wait_for_message<Welcome>(control, k_stranger_soon);
    lane.connect(welcome.lane);
  }
  void credit(std::uint64_t up_to) { send(control, Credit{welcome.epoch, welcome.worker, up_to}); }

  zmq::context_t context{1};
  std::uint64_t incarnation = random_id();
  Keys keys;
  zmq::socket_t control;
  zmq::socket_t lane;
  Welcome welcome;
};

/// Connects to tcp://127.0.0.1:port, sends bytes that are not ZMTP, and hangs up.
void send_raw(const std::string& address, const std::string& bytes) {
  const auto port = static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
  const Fd fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  REQUIRE(::connect(fd.get(), reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0);
  // The other side may hang up at any byte: a partial send is fine.
  [[maybe_unused]] const auto sent = ::send(fd.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

std::vector<std::string> raw_garbage() {
  std::vector<std::string> garbage = {"", "GET / HTTP/1.1\r\n\r\n", std::string(100'000, '\0')};
  std::string greeting = "\xff" + std::string(8, '\0') + "\x7f\x03" + '\0' + "NULL";
  greeting.resize(64, '\0');
  garbage.push_back(greeting);
  garbage.push_back(greeting + "\x06\x7f" + std::string(8, '\xff'));  // a command of 2^63 bytes
  garbage.push_back(greeting + std::string("\x04\x06\x05READY\x7f", 9));
  std::mt19937 random(1);
  for (int i = 0; i < 50; ++i) {
    std::string bytes(random() % 300, '\0');
    for (char& c : bytes) c = static_cast<char>(random());
    garbage.push_back(bytes);
  }
  return garbage;
}

std::vector<std::string> framed_garbage(std::uint32_t epoch) {
  std::vector<std::string> frames = {"", "x", "MFMS", std::string(5000, 'M')};
  const JobKey key = key_of(make_job("job 1"));
  const JobKey unknown{1};
  const auto result = [&](std::uint64_t run, std::uint32_t at, JobKey of, const std::string& name) {
    JobOutput forged;
    forged.file = {name, 1, 2};
    forged.summary = "forged";
    return encode(Result{run, at, {1}, 5, 1, of, forged});
  };
  const std::string good = to_string(ResultName{key.value, 1, 5});
  for (const std::string& name :
       {std::string("../../etc/passwd"), std::string("manifest"), std::string("/etc/passwd"),
        to_string(ResultName{key.value, 2, 5}), to_string(ResultName{unknown.value, 1, 5})}) {
    frames.push_back(result(7, epoch, key, name));
  }
  frames.push_back(result(8, epoch, key, good));                                // wrong run
  frames.push_back(result(7, epoch - 1, key, good));                            // old epoch
  frames.push_back(result(7, epoch, unknown, to_string(ResultName{1, 1, 5})));  // not wanted
  Accept accept;  // but not from the sink
  accept.epoch = epoch;
  accept.key = key;
  accept.output.file.name = good;
  frames.push_back(encode(accept));
  frames.push_back(encode(Reject{epoch, {1}, 1, key, {"forged", FailureKind::for_good}}));
  frames.push_back(encode(Heartbeat{epoch, {1}, 0, 0, 0}));
  frames.push_back(encode(Credit{epoch, {1}, 1'000'000}));
  frames.push_back(encode(Release{epoch, {1}}));
  frames.push_back(encode(Ready{epoch, 0}));
  frames.push_back(encode(Complete{epoch}));
  frames.push_back(encode(Failed{epoch, "forged"}));
  frames.push_back(encode(Hello{Role::sink, 8, 1, 1, "h", "tcp://127.0.0.1:1"}));  // wrong run
  frames.push_back(encode(Stop{StopReason::run_over}));
  std::string cut = encode(Done{key, 1});
  frames.push_back(cut.substr(0, cut.size() - 1));
  return frames;
}

void send_framed(zmq::socket_t& socket, const std::vector<std::string>& frames) {
  for (const std::string& frame : frames)
    socket.send(zmq::buffer(frame), zmq::send_flags::dontwait);
  for (const std::string& frame : frames) {  // the same frames as one message
    socket.send(zmq::buffer(frame), zmq::send_flags::dontwait | zmq::send_flags::sndmore);
  }
  socket.send(zmq::buffer(std::string("end")), zmq::send_flags::dontwait);
}

JobOutput do_slow_job(const Job& job, const JobContext& context) {
  std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return do_trivial_job(job, context);
}

TEST_CASE("what nobody should send is dropped, whoever sends it, and the run goes on") {
  Farm farm;
  const JobSource source = one_stage(100);
  std::vector<std::string> summaries;
  Part ventilator(farm.ventilator(source));
  Part sink(farm.sink(source, summaries));
  const Endpoint endpoint = wait_for_endpoint(farm.stage);
  FakeWorker spy(farm.stage, endpoint);  // gives no credit; learns where the sink is
  std::string results = spy.welcome.sink;
  if (results.empty()) results = wait_for_message<SinkAt>(spy.control, k_stranger_soon)->results;
  Part worker(farm.worker(do_slow_job));
  for (const std::string& address : {endpoint.address, spy.welcome.lane, results}) {
    for (const std::string& bytes : raw_garbage()) send_raw(address, bytes);
  }
  zmq::socket_t dealer = make_control_client(spy.context, spy.keys, random_id());
  dealer.connect(endpoint.address);
  send_framed(dealer, framed_garbage(endpoint.epoch));
  zmq::socket_t push = make_results_client(spy.context, spy.keys);
  push.connect(results);
  send_framed(push, framed_garbage(endpoint.epoch));
  zmq::socket_t wrong_type(spy.context, zmq::socket_type::sub);
  wrong_type.set(zmq::sockopt::linger, 0);
  wrong_type.connect(results);
  sink.join();
  ventilator.join();
  worker.join();
  REQUIRE(summaries.size() == 100);
  for (std::size_t i = 0; i < 100; ++i) CHECK(summaries[i] == reversed("job " + std::to_string(i)));
}

TEST_CASE("a process of an older protocol is refused in words that it understands") {
  Farm farm;
  Part ventilator(farm.ventilator(one_stage(1)));
  const Endpoint endpoint = wait_for_endpoint(farm.stage);
  zmq::context_t context;
  zmq::socket_t control =
      make_control_client(context, keys_to_connect(farm.stage, endpoint, {}), random_id());
  control.connect(endpoint.address);
  std::string hello = encode(Hello{Role::worker, 0, 5, 1, "old", {}});
  hello[4] = 2;  // its version
  control.send(zmq::buffer(hello), zmq::send_flags::none);
  zmq::message_t frame;
  control.set(zmq::sockopt::rcvtimeo, 10'000);
  REQUIRE(control.recv(frame));
  std::string refusal = frame.to_string();
  CHECK(refusal[4] == 2);
  refusal[4] = static_cast<char>(k_protocol_version);
  const std::string reason = std::get<Refused>(decode(refusal)).reason;
  CHECK(reason.find("protocol version 2") != std::string::npos);
  CHECK(reason.find(std::to_string(k_protocol_version)) != std::string::npos);
  ventilator.stop();
  CHECK_THROWS_AS(ventilator.join(), IncompleteError);
}

TEST_CASE("a worker gets no more than its credit, and if it falls silent others do its jobs") {
  Farm farm;
  const JobSource source = one_stage(20);
  std::vector<std::string> summaries;
  FarmProgress last;
  Part ventilator(farm.ventilator(source, [&](const FarmProgress& p) { last = p; }));
  Part sink(farm.sink(source, summaries));
  auto fake = std::make_unique<FakeWorker>(farm.stage, wait_for_endpoint(farm.stage));
  fake->credit(2);
  const auto first = wait_for_message<Assignment>(fake->lane, k_stranger_soon);
  const auto second = wait_for_message<Assignment>(fake->lane, k_stranger_soon);
  REQUIRE(first);
  REQUIRE(second);
  CHECK(first->lane_seq == 1);
  CHECK(second->lane_seq == 2);
  CHECK(first->job.cost == 19);  // the largest first
  CHECK_FALSE(wait_for_message<Assignment>(fake->lane, std::chrono::milliseconds(100)));
  fake.reset();
  Part worker(farm.worker());
  sink.join();
  ventilator.join();
  worker.join();
  CHECK(summaries.size() == 20);
  CHECK(last.retries == 2);
}

TEST_CASE("fifty thousand jobs go through one lane, each once and in order") {
  Farm farm;
  // Longer than any wait: the peers operated by hand send no heartbeats.
  farm.heartbeat = std::chrono::milliseconds(20'000);
  const JobSource source = one_stage(50'000);
  Part ventilator(farm.ventilator(source));
  const Endpoint endpoint = wait_for_endpoint(farm.stage);
  // A sink without a disk: it accepts every result that it hears of.
  zmq::context_t context(1);
  zmq::socket_t sink =
      make_control_client(context, keys_to_connect(farm.stage, endpoint, {}), random_id());
  sink.connect(endpoint.address);
  send(sink, Hello{Role::sink, farm.run, random_id(), 1, "fake", "tcp://127.0.0.1:1"});
  REQUIRE(wait_for_message<Welcome>(sink, k_stranger_soon));
  send(sink, Ready{endpoint.epoch, 0});
  FakeWorker worker(farm.stage, endpoint);
  constexpr std::uint64_t k_window = 64;
  worker.credit(k_window);
  Accept accept;
  accept.epoch = endpoint.epoch;
  accept.worker = worker.welcome.worker;
  const auto start = std::chrono::steady_clock::now();
  for (std::uint64_t i = 1; i <= 50'000; ++i) {
    const auto job = wait_for_message<Assignment>(worker.lane, k_stranger_soon);
    REQUIRE(job);
    REQUIRE(job->lane_seq == i);
    worker.credit(i + k_window);
    accept.key = key_of(job->job);
    send(sink, accept);
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  send(sink, Complete{endpoint.epoch});
  ventilator.join();
  const double rate = 50'000 / took.count();
  MESSAGE(rate, " jobs/s through one lane");
}

}  // namespace
}  // namespace meshfarm::test
