// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// All messages between ventilator (V), workers (W) and sink (S). Version 6.
//
//   frame   = "MFMS" | version u16 | type u16 | body      one message a frame, one frame a message
//   body    = the fields of the struct in the order of their declaration, little endian
//   text    = length u32 | bytes       list = count u32 | elements       yes/no, choice = u8
//
// Channels: control is V's ROUTER with a DEALER in every W and S; a lane is V's PUSH to one W's
// PULL; results is every W's PUSH to S's PULL. A frame that does not decode, comes from nobody
// known or from another run or an older epoch is dropped and counted.
//
//   joining    W,S -> V  Hello (repeated until answered)     V -> W,S  Welcome | Refused
//   alive      W,S -> V  Heartbeat                           V -> W,S  Alive
//   flow       W -> V    Credit, Release                     V -> W    Assignment (on the lane)
//   results    W -> S    Result (repeated until Done)        S -> V    Accept | Reject
//              V -> W    Done: the result may be forgotten
//              V -> W    TryRead, of a result that S cannot read        W -> V  TriedRead
//   sink       S -> V    an Accept for all it has, Ready     V -> W    SinkAt
//              S says Hello anew, and all that again, when it takes back what it had accepted
//   the end    V -> W,S  Stop       V -> S  JobFailed        S -> V    Complete | Failed
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <meshfarm/farm/job.hpp>

namespace meshfarm {

inline constexpr std::uint16_t k_protocol_version = 9;
inline constexpr std::size_t k_max_frame_bytes = 524'288;
inline constexpr std::size_t k_max_text_bytes = 1024;           // names, addresses, reasons
inline constexpr std::size_t k_max_summary_bytes = 16'384;      // JobOutput::summary
inline constexpr std::size_t k_max_parameters_bytes = 262'144;  // Job::parameters
inline constexpr std::size_t k_max_list = 4096;                 // Job::inputs, Job::sections

/// The farm's state-machine clock: time since any fixed moment, never going back.
using FarmTime = std::chrono::milliseconds;
inline double seconds(FarmTime time) {
  return std::chrono::duration<double>(time).count();
}

/// Names a worker's membership in one epoch; a worker that joins again gets a new id.
struct WorkerId {
  std::uint32_t value = 0;
  friend auto operator<=>(const WorkerId&, const WorkerId&) = default;
};

enum class Role : std::uint8_t { worker = 1, sink = 2 };
/// stranger: send Hello again. full: try again later. The others are final.
enum class Refusal : std::uint8_t {
  stranger = 1,
  full = 2,
  other_run = 3,
  replaced = 4,
  other_build = 5
};
/// run_over: everything is done (or given up). leaving: the ventilator was stopped; another may
/// come. hung: a job of this worker makes no progress; it has lost its jobs and must end its
/// process.
enum class StopReason : std::uint8_t { run_over = 1, leaving = 2, hung = 3 };

/// A worker's capacity; 0: unknown.
struct Capacity {
  std::uint64_t speed = 0;    // triangles per second and thread, by benchmark
  std::uint64_t memory = 0;   // bytes for all jobs in work together
  std::uint32_t threads = 1;  // jobs computed concurrently
  /// Workers of a host that report the same number share `memory`. 0: not shared.
  std::uint64_t memory_pool = 0;
};

struct Hello {
  Role role = Role::worker;
  std::uint64_t run = 0;  // 0: any run (workers)
  std::uint64_t incarnation = 0;
  std::uint32_t pid = 0;
  std::string host;
  std::string results;          // the sink's address
  Capacity capacity;            // a worker's
  std::uint32_t algorithm = 0;  // version; results of two versions must not mix
};
struct Welcome {
  WorkerId worker;  // 0: sent to the sink
  std::uint32_t epoch = 0;
  std::uint64_t run = 0;
  std::string lane;
  std::string sink;  // empty while there is none
  std::uint32_t heartbeat_ms = 0;
  std::uint64_t memory = 0;  // the worker's share of its reported memory; 0: no limit
};
struct Refused {
  Refusal why = Refusal::stranger;
  std::string reason;
};
struct Heartbeat {
  std::uint32_t epoch = 0;
  WorkerId worker;
  std::uint32_t held = 0;      // jobs not yet finished
  std::uint64_t received = 0;  // the last lane number seen
  std::uint64_t progress = 0;  // over all jobs in work: triangles done, bytes read and written
  JobKey still;                // the job in work without progress for the longest...
  std::uint32_t still_ms = 0;  // ...time, in milliseconds
  bool in_storage = false;     // ...while reading or writing the stage, not computing
  std::uint64_t rss_bytes = 0;
  bool no_room = false;  // sink only: no room for its writes; it waits
};
struct Alive {
  std::uint32_t epoch = 0;
  std::string sink;          // as in SinkAt, in case that was lost
  std::uint64_t memory = 0;  // as in Welcome: the share changes as others join and leave
};
/// "I can hold what the lane brings up to this number": absolute, so loss and repetition are
/// harmless.
struct Credit {
  std::uint32_t epoch = 0;
  WorkerId worker;
  std::uint64_t up_to = 0;
};
/// The worker leaves and gives back everything it holds.
struct Release {
  std::uint32_t epoch = 0;
  WorkerId worker;
};
struct Assignment {
  std::uint64_t run = 0;
  std::uint32_t epoch = 0;
  std::uint64_t lane_seq = 0;  // 1, 2, 3... on each lane
  std::uint32_t attempt = 0;
  Job job;
};
/// attempt: another attempt may succeed. for_good: none can. no_space: the stage is full. unread:
/// the sink cannot read the result, which says nothing about its worker. no_input, damaged_input:
/// the worker cannot read the job's inputs, or reads them damaged; others may succeed.
enum class FailureKind : std::uint8_t {
  attempt = 1,
  for_good = 2,
  no_space = 3,
  unread = 4,
  no_input = 5,
  damaged_input = 6
};
struct JobFailure {
  std::string reason;
  FailureKind kind = FailureKind::attempt;
};
/// Where an attempt's time went.
struct JobTimes {
  std::uint32_t read_ms = 0;
  std::uint32_t wait_ms = 0;  // read, but all compute threads were busy
  std::uint32_t compute_ms = 0;
  std::uint32_t write_ms = 0;
  std::uint64_t cpu_us = 0;  // of the compute thread: the time on an otherwise idle host
};
struct Result {
  std::uint64_t run = 0;
  std::uint32_t epoch = 0;
  WorkerId worker;
  std::uint64_t incarnation = 0;
  std::uint32_t attempt = 0;
  JobKey key;
  std::variant<JobOutput, JobFailure> outcome;
  JobTimes times;
};
struct Accept {
  std::uint32_t epoch = 0;
  WorkerId worker;  // whose Result this answers; 0: none
  JobKey key;
  JobOutput output;
  JobTimes times;  // as in the Result
  /// Accepted results whose files an earlier sink verified, but this one has not yet. The run is
  /// not over before they are verified, since a damaged one is made again.
  std::uint64_t unverified = 0;
};
struct Reject {
  std::uint32_t epoch = 0;
  WorkerId worker;
  std::uint32_t attempt = 0;
  JobKey key;
  JobFailure failure;
  FileRef file;  // the result that the sink cannot read, or reads damaged; empty name: neither
};
/// The sink has reported everything it had accepted before; repeated with each of its heartbeats.
struct Ready {
  std::uint32_t epoch = 0;
  std::uint64_t accepted = 0;    // number of jobs, so that a lost Accept is noticed
  std::uint64_t unverified = 0;  // as in Accept
};
/// Attempts at the job up to this one are settled: drop them and their results. Does not apply to
/// later attempts, which may already have come down the lane.
struct Done {
  JobKey key;
  std::uint32_t attempt = 0;
};
struct SinkAt {
  std::string results;  // empty: no sink for now
};
/// In JobFailed: no job failed, but the run cannot go on.
inline constexpr JobKey k_whole_run{0};
struct JobFailed {
  JobKey key;
  std::string reason;
  bool resumable = false;  // cost workers their lives, or room ran out: a new run may succeed
};
struct Complete {
  std::uint32_t epoch = 0;
};
struct Failed {
  std::uint32_t epoch = 0;
  std::string reason;
  bool resumable = false;
};
struct Stop {
  StopReason why = StopReason::run_over;
};
/// Asks whether the worker can read this file, which the sink cannot.
struct TryRead {
  JobKey key;
  std::uint32_t attempt = 0;
  FileRef file;
};
struct TriedRead {
  std::uint32_t epoch = 0;
  WorkerId worker;
  JobKey key;
  std::uint32_t attempt = 0;
  bool whole = false;
};

/// The order gives each type its number on the wire, from 1: append only.
using Message = std::variant<Hello, Welcome, Refused, Heartbeat, Alive, Credit, Release, Assignment,
                             Result, Accept, Reject, Ready, Done, SinkAt, JobFailed, Complete,
                             Failed, Stop, TryRead, TriedRead>;

/// Throws DataError if a field is longer than the protocol allows.
std::string encode(const Message& message);
/// The protocol version of a frame of another version; nothing if it is ours, or not of this
/// protocol at all.
std::optional<std::uint16_t> other_version_of(std::string_view frame);
/// A Refused for a peer of another version: its layout, and the Refusal used here, exist in all
/// versions.
std::string encode_refusal(std::uint16_t version, std::string_view reason);
/// Decodes the whole frame as one message. Throws DataError otherwise; no other exception can
/// escape.
Message decode(std::string_view frame);
/// Text truncated to what a message can carry.
std::string clipped(std::string_view text);

}  // namespace meshfarm
