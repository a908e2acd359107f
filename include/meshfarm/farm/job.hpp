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

/// Names a job by its content: checksum of kind, inputs, parameters and version of the algorithm.
/// The same work has the same key in every run, so an accepted result is found again by a restarted
/// or a repeated run.
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
/// By what it is and its number.
Extent extent_named(std::string_view what, std::uint64_t number, std::uint64_t bytes);

/// A part of one of a job's inputs.
struct InputSection {
  std::uint32_t input = 0;
  FileSection section;

  friend bool operator==(const InputSection&, const InputSection&) = default;
};

/// A unit of work. To the farm `kind` and `parameters` are opaque.
struct Job {
  std::string kind;             // "simplify"
  std::vector<FileRef> inputs;  // in the stage
  std::string parameters;       // bytes that the job's function decodes
  std::uint64_t cost = 0;       // estimated work, in triangles
  std::uint64_t memory = 0;     // estimated need in bytes, inputs included; 0: fits everywhere
  /// Of what does the job: another version may make other bytes of the same inputs.
  std::uint32_t algorithm = 0;
  /// The sink does it, not a worker: what needs much that was accepted before in one place.
  bool by_sink = false;
  /// What it makes is for workers alone, who check all that they read of it: the sink does not read
  /// it while nothing is found damaged. No part of what the job is.
  bool left_to_readers = false;
  /// Estimated work of the longest chain of jobs that can only follow this one, in triangles: what
  /// leads to much is begun first. No part of what the job is.
  std::uint64_t after = 0;
  /// What is read of the inputs, in an order that the kind tells; none: each as a whole. No part of
  /// what the job is.
  std::vector<InputSection> sections = {};
  /// About so many bytes are read that are no inputs: sections of files, or of the mesh itself. No
  /// part of what the job is.
  std::uint64_t reads = 0;
  /// What of all that it reads others read, too. No part of what the job is.
  Extent extent = {};
};

JobKey key_of(const Job& job);
/// What is read of the inputs.
std::uint64_t input_bytes(const Job& job);

/// What a job made: one staged file, and a few bytes about it that travel with the message.
struct JobOutput {
  FileRef file;
  std::string summary;  // <= 16 KiB, opaque to the farm
};

/// An output that is written as it is computed. Without commit() nobody ever sees it.
class JobFile {
 public:
  virtual ~JobFile() = default;
  virtual void write(std::string_view bytes) = 0;
  /// To be called when all is computed and written: from here on the worker may begin to compute
  /// the next job.
  virtual FileRef commit() = 0;
};

/// How a job reaches the stage.
class JobStorage {
 public:
  virtual ~JobStorage() = default;
  virtual std::string read(const FileRef& file) = 0;
  virtual std::string read(const FileRef& file, const FileSection& section) = 0;
  virtual std::unique_ptr<JobFile> create(const StagedName& name, std::string_view unique) = 0;
  virtual FileRef publish(const StagedName& name, std::string_view bytes,
                          std::string_view unique) = 0;
};

/// What a job's function is given beside the job.
struct JobContext {
  const Stage& stage;
  std::uint32_t attempt = 1;
  std::uint64_t incarnation = 0;  // of the worker: result names carry it
  /// Counts work done, in triangles; returns false when the job is to be given up.
  std::function<bool(std::uint64_t done)> progress;
  JobStorage* storage = nullptr;  // none: straight to the stage

  /// An input, as Stage::read; a worker may have read it ahead.
  std::string read(const FileRef& file) const;
  /// One of Job::sections. Throws DataError if there are not so many.
  std::string read_section(const Job& job, std::size_t section) const;
  /// The output, as Stage::publish. To be called when all is computed: from here on the worker may
  /// begin to compute the next job.
  FileRef publish(const StagedName& name, std::string_view bytes) const;
  /// The output, for a job that cannot hold it.
  std::unique_ptr<JobFile> create(const StagedName& name) const;
};

/// Thrown by a job's function when the job's input can never be done, whoever tries: the job is
/// given up at once. Any other exception fails this attempt only.
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
