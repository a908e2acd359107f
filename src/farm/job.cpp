// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/farm/job.hpp>
#include <meshfarm/staging/staged_writer.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// Writes directly to the stage.
class StagedJobFile : public JobFile {
 public:
  StagedJobFile(const Stage& stage, const StagedName& name, std::string_view unique)
      : file_(stage, name, unique) {}
  void write(std::string_view bytes) override { file_.write(bytes); }
  FileRef commit() override { return file_.commit(); }

 private:
  StagedWriter file_;
};

}  // namespace

JobKey key_of(const Job& job) {
  // Inputs count by content, not by name: a result made again under another name leads to the same
  // jobs after it. The key's recipe is version 2; its number comes first.
  ByteWriter out;
  out.reserve(64 + 16 * job.inputs.size() + job.kind.size() + job.parameters.size());
  out.put(std::uint32_t{2});
  out.put(job.algorithm);
  out.put_string(job.kind);
  out.put(static_cast<std::uint64_t>(job.inputs.size()));
  for (const FileRef& input : job.inputs) {
    out.put(input.size);
    out.put(input.hash);
  }
  out.put_string(job.parameters);
  return {checksum(out.bytes())};
}

std::uint64_t input_bytes(const Job& job) {
  std::uint64_t bytes = 0;
  for (const InputSection& each : job.sections) bytes += each.section.size;
  if (!job.sections.empty()) return bytes;
  for (const FileRef& input : job.inputs) bytes += input.size;
  return bytes;
}

Extent extent_named(std::string_view what, std::uint64_t number, std::uint64_t bytes) {
  ByteWriter out;
  out.put_string(what);
  out.put(number);
  return {checksum(out.bytes()), bytes};
}

std::string JobContext::read(const FileRef& file) const {
  return storage != nullptr ? storage->read(file) : stage.read(file);
}

std::string JobContext::read_section(const Job& job, std::size_t section) const {
  if (section >= job.sections.size()) {
    throw DataError("a " + job.kind + " job without its sections");
  }
  const InputSection& wanted = job.sections[section];
  const FileRef& file = job.inputs.at(wanted.input);
  return storage != nullptr ? storage->read(file, wanted.section)
                            : stage.read(file, wanted.section);
}

FileRef JobContext::publish(const StagedName& name, std::string_view bytes) const {
  const std::string unique = to_hex(incarnation);
  return storage != nullptr ? storage->publish(name, bytes, unique)
                            : stage.publish(name, bytes, unique);
}

std::unique_ptr<JobFile> JobContext::create(const StagedName& name) const {
  const std::string unique = to_hex(incarnation);
  if (storage != nullptr) return storage->create(name, unique);
  return std::make_unique<StagedJobFile>(stage, name, unique);
}

}  // namespace meshfarm
