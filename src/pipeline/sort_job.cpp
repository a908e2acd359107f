// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <utility>

#include <meshfarm/divide/slab.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/io/slab_file.hpp>
#include <meshfarm/io/sorting.hpp>
#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/pipeline/sort_job.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

// Version 1: sorting (io/sorting.hpp) | number u32.
constexpr std::uint8_t k_sort_version = 1;

/// Reads the job's input. Invalid contents with a correct checksum stay invalid, whoever reads
/// them.
template <class Decode>
auto read_input(const Job& job, const JobContext& context, const Decode& decode) {
  if (job.inputs.size() != 1) throw DataError("a " + job.kind + " job takes one file");
  const std::string file = context.read(job.inputs[0]);
  try {
    return decode(file, job.inputs[0].name);
  } catch (const DataError& error) {
    throw BadInputError(error.what());
  }
}

JobOutput publish(const Job& job, const JobContext& context, std::string_view bytes,
                  const SortSummary& summary) {
  if (!context.progress(job.cost)) throw IncompleteError("the job was given up");
  const ResultName name{key_of(job).value, context.attempt, context.incarnation};
  return {context.publish(name, bytes), encode_summary(summary)};
}

}  // namespace

std::string encode_parameters(const SortParameters& parameters) {
  ByteWriter out;
  out.put(k_sort_version);
  put(out, parameters.sorting);
  out.put(parameters.number);
  return out.take();
}

SortParameters decode_sort_parameters(std::string_view bytes) {
  ByteReader in(bytes, "parameters of a sort job");
  if (in.get<std::uint8_t>() != k_sort_version) in.fail("made by another version of meshfarm");
  SortParameters parameters;
  parameters.sorting = get_sorting(in);
  parameters.number = in.get<std::uint32_t>();
  in.expect_end();
  return parameters;
}

std::string encode_summary(const SortSummary& summary) {
  ByteWriter out;
  out.put(summary.vertices);
  out.put(summary.triangles);
  out.put(summary.boundary_vertices);
  out.put(summary.coincident_vertices);
  out.put(summary.dropped_degenerate);
  out.put(summary.coincident_corners);
  return out.take();
}

SortSummary decode_sort_summary(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  SortSummary summary;
  summary.vertices = in.get<std::uint64_t>();
  summary.triangles = in.get<std::uint64_t>();
  summary.boundary_vertices = in.get<std::uint32_t>();
  if (summary.boundary_vertices > summary.vertices) {
    in.fail("more boundary vertices than vertices");
  }
  summary.coincident_vertices = in.get<std::uint64_t>();
  summary.dropped_degenerate = in.get<std::uint64_t>();
  summary.coincident_corners = in.get<std::uint64_t>();
  in.expect_end();
  return summary;
}

JobOutput sort_to_stream(const Job& job, const JobContext& context) {
  const Sorting sorting = decode_sort_parameters(job.parameters).sorting;
  SortedSlab slab = sort_slab(read_input(job, context, decode_slab), sorting);
  const SortSummary summary{slab.stream.mesh.positions.size(),
                            slab.stream.mesh.triangles.size(),
                            slab.boundary_vertices,
                            slab.coincident_vertices,
                            slab.dropped_degenerate,
                            slab.coincident_corners};
  const std::string bytes = encode_stream(slab.stream);
  slab = {};
  return publish(job, context, bytes, summary);
}

JobOutput sample_stream(const Job& job, const JobContext& context) {
  const SortParameters parameters = decode_sort_parameters(job.parameters);
  const StreamMesh stream =
      read_input(job, context, [](const std::string& file, const std::string& name) {
        StreamReader reader(fill_from(file, name), name);
        return read_stream_mesh(reader);
      });
  const Part part = sample_slab(stream, parameters.sorting.order, parameters.number);
  return publish(
      job, context, encode_part(part),
      {part.mesh.positions.size(), part.mesh.triangles.size(), part.boundary_vertices, 0, 0, 0});
}

}  // namespace meshfarm
