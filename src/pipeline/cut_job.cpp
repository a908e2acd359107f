// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <memory>
#include <utility>

#include <sys/stat.h>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/pipeline/cut_job.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/bundle_list.hpp"

namespace meshfarm {
namespace {

struct FileFacts {
  std::uint64_t bytes = 0;
  std::int64_t changed_ns = 0;
};

FileFacts facts_of(const std::filesystem::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) throw_errno("cannot look at", path);
  return {static_cast<std::uint64_t>(status.st_size),
          std::int64_t{status.st_mtim.tv_sec} * 1'000'000'000 + status.st_mtim.tv_nsec};
}

/// Opens the input, unchanged since the cut was planned. A host that can't see it says so, as
/// another host may see it.
std::unique_ptr<MeshBlocks> open_input(const Cutting& cutting) {
  FileFacts facts;
  std::unique_ptr<MeshBlocks> mesh;
  try {
    facts = facts_of(cutting.path);
    if (facts.bytes == cutting.bytes) mesh = open_blocks(cutting.path);
  } catch (const IoError& error) {
    throw UnreadIoError(error);
  }
  if (mesh == nullptr || facts.changed_ns != cutting.changed_ns) {
    throw UnreadDataError(cutting.path +
                          ": was changed since the cut was begun, or is another file on this host");
  }
  return mesh;
}

ResultName cut_result_name(const Job& job, const JobContext& context) {
  return {key_of(job).value, context.attempt, context.incarnation};
}

void expect_to_be_wanted(const Job& job, const JobContext& context) {
  if (!context.progress(job.cost)) throw IncompleteError("the job was given up");
}

JobOutput publish_bytes(const Job& job, const JobContext& context, std::string_view bytes,
                        std::string summary) {
  expect_to_be_wanted(job, context);
  return {context.publish(cut_result_name(job, context), bytes), std::move(summary)};
}

/// Publishes a file of sections that `make` writes.
template <class Make>
JobOutput write_sections(const Job& job, const JobContext& context, const Make& make) {
  const auto file = context.create(cut_result_name(job, context));
  std::string summary = encode_summary(make([&](std::string_view bytes) { file->write(bytes); }));
  expect_to_be_wanted(job, context);
  return {file->commit(), std::move(summary)};
}

BlockRange vertices_of(const CutJobParameters& parameters, const MeshBlocks& mesh) {
  return block_of(mesh.vertices(), parameters.cutting.vertex_blocks, parameters.block);
}

/// The cells to count in this round: the first input, except in the first round.
std::string cells_of(const CutJobParameters& parameters, const Job& job,
                     const JobContext& context) {
  if (parameters.round == 0) return begin_cells(parameters.box, parameters.cutting.parts);
  return context.read(job.inputs.at(0));
}

}  // namespace

bool is_left_to_readers(std::string_view kind) {
  return kind == k_count_kind || kind == k_partition_kind || kind == k_vertices_kind ||
         kind == k_triangles_kind;
}

JobOutput survey_vertices_of_block(const Job& job, const JobContext& context) {
  const CutJobParameters parameters = decode_cut_parameters(job.parameters);
  const auto mesh = open_input(parameters.cutting);
  std::string summary = encode_summary(survey_block(*mesh, vertices_of(parameters, *mesh)));
  return publish_bytes(job, context, std::string(summary), summary);
}

JobOutput count_vertices_of_block(const Job& job, const JobContext& context) {
  const CutJobParameters parameters = decode_cut_parameters(job.parameters);
  const auto mesh = open_input(parameters.cutting);
  const std::string counted =
      count_block(cells_of(parameters, job, context), *mesh, vertices_of(parameters, *mesh));
  return publish_bytes(job, context, counted, {});
}

JobOutput partition_cells_of_blocks(const Job& job, const JobContext& context) {
  const CutJobParameters parameters = decode_cut_parameters(job.parameters);
  const std::size_t first = parameters.round == 0 ? 0 : 1;
  const Partition made = partition_blocks(
      cells_of(parameters, job, context), job.inputs.size() - first,
      [&](std::size_t block) { return context.read(job.inputs[first + block]); }, 1);
  return publish_bytes(job, context, made.bytes,
                       encode_summary(PartitionSummary{made.counts_again, made.parts}));
}

JobOutput scatter_vertices_of_block(const Job& job, const JobContext& context) {
  const CutJobParameters parameters = decode_cut_parameters(job.parameters);
  const auto mesh = open_input(parameters.cutting);
  const std::string partition = context.read(job.inputs.at(0));
  return write_sections(job, context, [&](const WriteBytes& write) {
    return scatter_vertices(partition, *mesh, vertices_of(parameters, *mesh), write);
  });
}

JobOutput scatter_triangles_of_block(const Job& job, const JobContext& context) {
  const CutJobParameters parameters = decode_cut_parameters(job.parameters);
  const auto mesh = open_input(parameters.cutting);
  const BlockRange triangles =
      block_of(mesh->triangles(), parameters.cutting.triangle_blocks, parameters.block);
  return write_sections(job, context, [&](const WriteBytes& write) {
    return scatter_triangles(context.stage, parameters.bundles.vertices, parameters.bundles.parts,
                             *mesh, triangles, write);
  });
}

JobOutput join_boundary_of_parts(const Job& job, const JobContext& context) {
  const JoinParameters parameters = decode_join_parameters(job.parameters);
  const JoinedBoundary made =
      join_boundary(context.stage, parameters.bundles, parameters.group, [&](std::uint32_t part) {
        const PartNumbers& numbers = parameters.numbers.at(part);
        return SectionedFile(context.stage, numbers.file).read(numbers.section);
      });
  const JoinSummary summary{made.encoded.index, made.triangles, made.degenerate, made.coincident,
                            made.duplicate};
  return publish_bytes(job, context, made.encoded.file, encode_summary(summary));
}

constexpr std::uint64_t k_usual_workers = 24;  // they end together with equally many parts each

std::uint64_t as_many_of_each(std::uint64_t wanted) {
  return (wanted + k_usual_workers - 1) / k_usual_workers * k_usual_workers;
}

/// Two dozen workers end at about the same time if each has four parts or more. Smaller parts, or
/// more of them, slow down everything: the partition is a single job, and small parts consist
/// mostly of seams.
std::uint32_t parts_for_cluster(std::uint64_t triangles) {
  constexpr std::uint64_t k_part = 300'000;
  constexpr std::uint64_t k_least = 72;
  constexpr std::uint64_t k_most = 240;
  const std::uint64_t wanted = std::clamp<std::uint64_t>(triangles / k_part, 1, k_most);
  return static_cast<std::uint32_t>(wanted < k_least ? wanted : as_many_of_each(wanted));
}

std::optional<Cutting> plan_cutting(const std::filesystem::path& input,
                                    const CutPlanOptions& options) {
  const auto mesh = open_blocks(input);
  if (mesh == nullptr) return std::nullopt;
  const auto blocks = [&](std::uint64_t records) {
    // Enough for all workers of a cluster, but few enough that each is worth its messages and
    // files.
    constexpr std::uint64_t k_records = 300'000;
    std::uint64_t wanted = records / k_records;
    if (wanted > k_usual_workers) wanted = as_many_of_each(wanted);
    if (options.blocks != 0) wanted = options.blocks;
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(wanted, 1, k_most_cut_blocks / 2));
  };
  const FileFacts facts = facts_of(input);
  Cutting cutting;
  cutting.path = std::filesystem::canonical(input).string();
  cutting.bytes = facts.bytes;
  cutting.changed_ns = facts.changed_ns;
  cutting.parts = options.parts;
  if (cutting.parts == 0) {
    const std::uint64_t triangles = std::max(mesh->triangles(), mesh->vertices());
    cutting.parts = default_parts(Scheme::cut, triangles);
    if (options.for_cluster) cutting.parts = std::max(cutting.parts, parts_for_cluster(triangles));
  }
  cutting.vertex_blocks = blocks(mesh->vertices());
  cutting.triangle_blocks = blocks(mesh->triangles());
  return cutting;
}

}  // namespace meshfarm
