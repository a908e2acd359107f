// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {

/// Names a job by its content: a checksum of kind, inputs, parameters and algorithm version. The
/// same work has the same key in every run, so a restarted or repeated run finds accepted results
/// again.
struct JobKey {
  std::uint64_t value = 0;
  friend auto operator<=>(const JobKey&, const JobKey&) = default;
};

/// Bytes that several jobs read: a block of the input, a part. A host that has read them need not
/// fetch them again.
struct Extent {
  std::uint64_t name = 0;  // 0: none
  std::uint64_t bytes = 0;
};
/// From what it is (`what`) and its number.
Extent extent_named(std::string_view what, std::uint64_t number, std::uint64_t bytes);

/// A part of one of a job's inputs.
struct InputSection {
  std::uint32_t input = 0;
  FileSection section;

  friend bool operator==(const InputSection&, const InputSection&) = default;
};

/// A unit of work. `kind` and `parameters` are opaque to the farm.
struct Job {
  std::string kind;             // "simplify"
  std::vector<FileRef> inputs;  // in the stage
  std::string parameters;       // bytes decoded by the job's function
  std::uint64_t cost = 0;       // estimated work, in triangles
  std::uint64_t memory = 0;     // estimated bytes, inputs included; 0: fits everywhere
  /// Version of the code that does the job: another version may make other bytes from the same
  /// inputs.
  std::uint32_t algorithm = 0;
  /// Done by the sink, not by a worker: for jobs that need many accepted results in one place.
  bool by_sink = false;
  /// Only workers read the output, and they check everything they read, so the sink does not read
  /// it unless damage is found. Not part of the job's key.
  bool left_to_readers = false;
  /// Estimated work of the longest chain of jobs that can only follow this one, in triangles: jobs
  /// that long chains depend on start first. Not part of the job's key.
  std::uint64_t after = 0;
  /// The sections of the inputs that are read, in an order defined by the kind; empty: every input
  /// as a whole. Not part of the job's key.
  std::vector<InputSection> sections = {};
  /// Approximate number of bytes read that are not inputs: sections of files, or of the mesh
  /// itself. Not part of the job's key.
  std::uint64_t reads = 0;
  /// The part of everything it reads that other jobs read, too. Not part of the job's key.
  Extent extent = {};
};

JobKey key_of(const Job& job);
/// The number of bytes read from the inputs.
std::uint64_t input_bytes(const Job& job);

/// What a job produced: one staged file, and a few bytes about it that travel in the message.
struct JobOutput {
  FileRef file;
  std::string summary;  // <= 16 KiB, opaque to the farm
};

/// An output that is written as it is computed. Nobody ever sees it without commit().
class JobFile {
 public:
  virtual ~JobFile() = default;
  virtual void write(std::string_view bytes) = 0;
  /// Call when everything is computed and written: the worker may then start computing the next
  /// job.
  virtual FileRef commit() = 0;
};

/// A job's access to the stage.
class JobStorage {
 public:
  virtual ~JobStorage() = default;
  virtual std::string read(const FileRef& file) = 0;
  virtual std::string read(const FileRef& file, const FileSection& section) = 0;
  virtual std::unique_ptr<JobFile> create(const StagedName& name, std::string_view unique) = 0;
  virtual FileRef publish(const StagedName& name, std::string_view bytes,
                          std::string_view unique) = 0;
};

/// Passed to a job's function along with the job.
struct JobContext {
  const Stage& stage;
  std::uint32_t attempt = 1;
  std::uint64_t incarnation = 0;  // of the worker: result names contain it
  /// Counts work done, in triangles; returns false when the job should be given up.
  std::function<bool(std::uint64_t done)> progress;
  JobStorage* storage = nullptr;  // null: directly to the stage

  /// Reads an input, like Stage::read; a worker may have read it ahead.
  std::string read(const FileRef& file) const;
  /// Reads one of Job::sections. Throws DataError if the index is out of range.
  std::string read_section(const Job& job, std::size_t section) const;
  /// Publishes the output, like Stage::publish. Call when everything is computed: the worker may
  /// then start computing the next job.
  FileRef publish(const StagedName& name, std::string_view bytes) const;
  /// The output of a job that cannot hold it in memory.
  std::unique_ptr<JobFile> create(const StagedName& name) const;
};

/// Thrown by a job's function when no worker can ever do the job's input: the job is given up at
/// once. Any other exception fails only this attempt.
class BadInputError : public DataError {
 public:
  using DataError::DataError;
};

/// Does a job: reads its inputs, publishes its output under a ResultName of the job's key, the
/// attempt and the incarnation. Doing it twice is harmless. Throws Error on failure.
using JobFunction = std::function<JobOutput(const Job&, const JobContext&)>;

struct AcceptedJob {
  JobKey key;
  JobOutput output;
};

}  // namespace meshfarm
