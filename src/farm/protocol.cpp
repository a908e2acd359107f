// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <array>
#include <concepts>
#include <tuple>
#include <type_traits>
#include <utility>

#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr std::array<char, 4> k_magic = {'M', 'F', 'M', 'S'};

template <class M, class T>
concept Is = std::same_as<std::remove_const_t<M>, T>;

// The fields of each struct, used for both directions.
template <Is<JobKey> M>
auto fields(M& m) {
  return std::tie(m.value);
}
template <Is<WorkerId> M>
auto fields(M& m) {
  return std::tie(m.value);
}
template <Is<FileRef> M>
auto fields(M& m) {
  return std::tie(m.name, m.size, m.hash);
}
template <Is<FileSection> M>
auto fields(M& m) {
  return std::tie(m.offset, m.size, m.hash);
}
template <Is<InputSection> M>
auto fields(M& m) {
  return std::tie(m.input, m.section);
}
template <Is<JobFailure> M>
auto fields(M& m) {
  return std::tie(m.reason, m.kind);
}
template <Is<Capacity> M>
auto fields(M& m) {
  return std::tie(m.speed, m.memory, m.threads, m.memory_pool);
}
template <Is<JobTimes> M>
auto fields(M& m) {
  return std::tie(m.read_ms, m.wait_ms, m.compute_ms, m.write_ms, m.cpu_us);
}
template <Is<Hello> M>
auto fields(M& m) {
  return std::tie(m.role, m.run, m.incarnation, m.pid, m.host, m.results, m.capacity, m.algorithm);
}
template <Is<Welcome> M>
auto fields(M& m) {
  return std::tie(m.worker, m.epoch, m.run, m.lane, m.sink, m.heartbeat_ms, m.memory);
}
template <Is<Refused> M>
auto fields(M& m) {
  return std::tie(m.why, m.reason);
}
template <Is<Heartbeat> M>
auto fields(M& m) {
  return std::tie(m.epoch, m.worker, m.held, m.received, m.progress, m.still, m.still_ms,
                  m.in_storage, m.rss_bytes, m.no_room);
}
template <Is<Alive> M>
auto fields(M& m) {
  return std::tie(m.epoch, m.sink, m.memory);
}
template <Is<Credit> M>
auto fields(M& m) {
  return std::tie(m.epoch, m.worker, m.up_to);
}
template <Is<Release> M>
auto fields(M& m) {
  return std::tie(m.epoch, m.worker);
}
template <Is<Assignment> M>
auto fields(M& m) {
  return std::tie(m.run, m.epoch, m.lane_seq, m.attempt, m.job);
}
template <Is<Result> M>
auto fields(M& m) {
  return std::tie(m.run, m.epoch, m.worker, m.incarnation, m.attempt, m.key, m.outcome, m.times);
}
template <Is<Accept> M>
auto fields(M& m) {
  return std::tie(m.epoch, m.worker, m.key, m.output, m.times, m.unverified);
}
template <Is<Reject> M>
auto fields(M& m) {
  return std::tie(m.epoch, m.worker, m.attempt, m.key, m.failure, m.file);
}
template <Is<Ready> M>
auto fields(M& m) {
  return std::tie(m.epoch, m.accepted, m.unverified);
}
template <Is<Done> M>
auto fields(M& m) {
  return std::tie(m.key, m.attempt);
}
template <Is<SinkAt> M>
auto fields(M& m) {
  return std::tie(m.results);
}
template <Is<JobFailed> M>
auto fields(M& m) {
  return std::tie(m.key, m.reason, m.resumable);
}
template <Is<Complete> M>
auto fields(M& m) {
  return std::tie(m.epoch);
}
template <Is<Failed> M>
auto fields(M& m) {
  return std::tie(m.epoch, m.reason, m.resumable);
}
template <Is<Stop> M>
auto fields(M& m) {
  return std::tie(m.why);
}
template <Is<TryRead> M>
auto fields(M& m) {
  return std::tie(m.key, m.attempt, m.file);
}
template <Is<TriedRead> M>
auto fields(M& m) {
  return std::tie(m.epoch, m.worker, m.key, m.attempt, m.whole);
}

void check(std::size_t size, std::size_t limit, std::string_view what) {
  if (size <= limit) return;
  throw DataError("a message's " + std::string(what) + " has " + std::to_string(size) +
                  " bytes or elements, the protocol allows " + std::to_string(limit));
}

class Encoder {
 public:
  template <std::integral T>
  void field(T value) {
    out_.put(value);
  }
  void field(bool value) { out_.put(static_cast<std::uint8_t>(value ? 1 : 0)); }
  template <class T>
  requires std::is_enum_v<T>
  void field(T value) { out_.put(static_cast<std::underlying_type_t<T>>(value)); }
  void field(const std::string& text) { bytes(text, k_max_text_bytes, "text"); }
  template <class T>
  void field(const std::vector<T>& list) {
    check(list.size(), k_max_list, "list");
    out_.put(static_cast<std::uint32_t>(list.size()));
    for (const T& element : list) field(element);
  }
  void field(const JobOutput& output) {
    field(output.file);
    bytes(output.summary, k_max_summary_bytes, "summary");
  }
  void field(const Job& job) {
    field(job.kind);
    field(job.inputs);
    field(job.sections);
    bytes(job.parameters, k_max_parameters_bytes, "parameters");
    field(job.cost);
    field(job.memory);
    field(job.algorithm);
  }
  void field(const std::variant<JobOutput, JobFailure>& outcome) {
    field(static_cast<std::uint8_t>(outcome.index()));
    std::visit([this](const auto& which) { this->field(which); }, outcome);
  }
  template <class T>
  requires requires(const T& t) { fields(t); }
  void field(const T& group) {
    std::apply([this](const auto&... each) { (this->field(each), ...); }, fields(group));
  }
  std::string take() { return out_.take(); }

 private:
  void bytes(const std::string& text, std::size_t limit, std::string_view what) {
    check(text.size(), limit, what);
    out_.put_string(text);
  }
  ByteWriter out_;
};

class Decoder {
 public:
  explicit Decoder(ByteReader& in) : in_(in) {}
  template <std::integral T>
  void field(T& value) {
    value = in_.get<T>();
  }
  void field(bool& value) {
    const auto raw = in_.get<std::uint8_t>();
    if (raw > 1) in_.fail("neither yes nor no");
    value = raw == 1;
  }
  void field(Role& value) { choice(value, Role::sink); }
  void field(Refusal& value) { choice(value, Refusal::other_build); }
  void field(StopReason& value) { choice(value, StopReason::hung); }
  void field(FailureKind& value) { choice(value, FailureKind::damaged_input); }
  void field(std::string& text) { bytes(text, k_max_text_bytes); }
  template <class T>
  void field(std::vector<T>& list) {
    const auto count = in_.get<std::uint32_t>();
    // Every element has at least eight bytes, so a forged count cannot cause a large allocation.
    if (count > k_max_list || count > in_.remaining() / 8) in_.fail("a list too long");
    list.resize(count);
    for (T& element : list) field(element);
  }
  void field(JobOutput& output) {
    field(output.file);
    bytes(output.summary, k_max_summary_bytes);
  }
  void field(Job& job) {
    field(job.kind);
    field(job.inputs);
    field(job.sections);
    for (const InputSection& each : job.sections) {
      if (each.input >= job.inputs.size()) in_.fail("a section of no input");
    }
    bytes(job.parameters, k_max_parameters_bytes);
    field(job.cost);
    field(job.memory);
    field(job.algorithm);
  }
  void field(std::variant<JobOutput, JobFailure>& outcome) {
    const auto index = in_.get<std::uint8_t>();
    if (index > 1) in_.fail("an outcome that is neither output nor failure");
    if (index == 0) field(outcome.emplace<JobOutput>());
    if (index == 1) field(outcome.emplace<JobFailure>());
  }
  template <class T>
  requires requires(T& t) { fields(t); }
  void field(T& group) {
    std::apply([this](auto&... each) { (this->field(each), ...); }, fields(group));
  }

 private:
  void bytes(std::string& text, std::size_t limit) {
    text = in_.get_string();
    if (text.size() > limit) in_.fail("a text too long");
  }
  template <class T>
  void choice(T& value, T last) {
    const auto raw = in_.get<std::underlying_type_t<T>>();
    if (raw < 1 || raw > static_cast<std::underlying_type_t<T>>(last)) in_.fail("no such choice");
    value = static_cast<T>(raw);
  }
  ByteReader& in_;
};

template <std::size_t... Index>
bool decode_as(std::size_t wanted, Decoder& decoder, Message& message,
               std::index_sequence<Index...>) {
  return ((Index == wanted && (decoder.field(message.emplace<Index>()), true)) || ...);
}

std::string encode_as(std::uint16_t version, const Message& message) {
  Encoder encoder;
  for (const char c : k_magic) encoder.field(c);
  encoder.field(version);
  encoder.field(static_cast<std::uint16_t>(message.index() + 1));
  std::visit([&](const auto& body) { encoder.field(body); }, message);
  std::string frame = encoder.take();
  check(frame.size(), k_max_frame_bytes, "frame");
  return frame;
}

}  // namespace

std::string encode(const Message& message) {
  return encode_as(k_protocol_version, message);
}

std::optional<std::uint16_t> other_version_of(std::string_view frame) {
  constexpr std::size_t k_head_bytes = 8;
  if (frame.size() < k_head_bytes || frame.size() > k_max_frame_bytes) return std::nullopt;
  ByteReader in(frame, "message");
  if (in.get<std::array<char, 4>>() != k_magic) return std::nullopt;
  const auto version = in.get<std::uint16_t>();
  return version == k_protocol_version ? std::nullopt : std::optional(version);
}

std::string encode_refusal(std::uint16_t version, std::string_view reason) {
  return encode_as(version, Refused{Refusal::other_run, clipped(reason)});
}

Message decode(std::string_view frame) {
  ByteReader in(frame, "message");
  if (frame.size() > k_max_frame_bytes) in.fail("too long");
  if (in.get<std::array<char, 4>>() != k_magic) in.fail("not a message of ours");
  if (in.get<std::uint16_t>() != k_protocol_version) in.fail("another version of the protocol");
  const std::size_t type = in.get<std::uint16_t>();
  Decoder decoder(in);
  Message message;
  constexpr auto k_all = std::make_index_sequence<std::variant_size_v<Message>>{};
  if (type == 0 || !decode_as(type - 1, decoder, message, k_all)) in.fail("of an unknown type");
  in.expect_end();
  return message;
}

std::string clipped(std::string_view text) {
  return std::string(text.substr(0, k_max_text_bytes));
}

}  // namespace meshfarm
