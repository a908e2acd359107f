// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <cmath>

#include <meshfarm/io/result_file.hpp>
#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/pipeline/sweep_job.hpp>
#include <meshfarm/staging/staged_reader.hpp>
#include <meshfarm/stream/sweep.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

// Version 1: level i32 | greatest cost f64 | ratio f64 | window u64 | samples u64 |
// greatest error f64 | lines (run_options.hpp).
constexpr std::uint8_t k_version = 1;
constexpr std::uint64_t k_max_samples = 100'000'000;
constexpr std::uint64_t k_max_window = std::uint64_t{1} << 30;

SweptStream sweep_from(StreamReader::Fill fill, const Job& job, const JobContext& context) {
  const SweepParameters parameters = decode_sweep_parameters(job.parameters);
  StreamReader reader(std::move(fill), job.inputs[0].name);
  SweepOptions options;
  options.max_cost = parameters.max_cost;
  options.ratio = parameters.ratio;
  options.window_triangles = parameters.window_triangles;
  options.samples = parameters.samples;
  options.lines = parameters.lines;
  options.measure = parameters.max_error > 0;
  options.progress = context.progress;
  return sweep(reader, options);
}

/// What is whole by its checksum and makes no sense never will, whoever reads it.
SweptStream sweep_in_memory(const Job& job, const JobContext& context) {
  const std::string file = context.read(job.inputs[0]);
  try {
    return sweep_from(fill_from(file, job.inputs[0].name), job, context);
  } catch (const DataError& error) {
    throw BadInputError(error.what());
  }
}

SweptStream sweep_bit_by_bit(const Job& job, const JobContext& context) {
  StagedReader file(context.stage, job.inputs[0]);
  SweptStream swept = sweep_from([&](std::span<char> buffer) { file.fill(buffer); }, job, context);
  file.expect_end();
  return swept;
}

}  // namespace

std::string encode_parameters(const SweepParameters& parameters) {
  ByteWriter out;
  out.put(k_version);
  out.put(parameters.level);
  out.put(parameters.max_cost);
  out.put(parameters.ratio);
  out.put(parameters.window_triangles);
  out.put(parameters.samples);
  out.put(parameters.max_error);
  put(out, parameters.lines);
  return out.take();
}

SweepParameters decode_sweep_parameters(std::string_view bytes) {
  ByteReader in(bytes, "parameters of a sweep job");
  if (in.get<std::uint8_t>() != k_version) in.fail("made by another version of meshfarm");
  SweepParameters parameters;
  parameters.level = in.get<std::int32_t>();
  parameters.max_cost = in.get<double>();
  parameters.ratio = in.get<double>();
  if (!(parameters.ratio >= 0 && parameters.ratio <= 1)) in.fail("impossible ratio");
  parameters.window_triangles = in.get<std::uint64_t>();
  if (parameters.window_triangles > k_max_window) in.fail("too large a window");
  parameters.samples = in.get<std::uint64_t>();
  if (parameters.samples > k_max_samples) in.fail("too many samples");
  parameters.max_error = in.get<double>();
  parameters.lines = get_lines(in);
  in.expect_end();
  return parameters;
}

JobOutput sweep_stream(const Job& job, const JobContext& context) {
  if (job.inputs.size() != 1) throw DataError("a sweep job takes one stream");
  SweptStream swept = job.inputs[0].size <= job.memory ? sweep_in_memory(job, context)
                                                       : sweep_bit_by_bit(job, context);
  const SweepParameters parameters = decode_sweep_parameters(job.parameters);
  ResultEncoder result(swept.positions, swept.boundary_vertices);
  result.add(parameters.level, swept.mesh, swept.free_triangles, swept.error);
  result.set_samples(std::move(swept.samples));
  const ResultSummary summary{result.rungs(), swept.dropped_degenerate, swept.dropped_duplicate};
  swept.mesh = {};
  const ResultName name{key_of(job).value, context.attempt, context.incarnation};
  const std::string file = result.finish();
  return {context.publish(name, file), encode_summary(summary)};
}

}  // namespace meshfarm
