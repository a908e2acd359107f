// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <memory>
#include <optional>
#include <utility>

#include <meshfarm/io/result_file.hpp>
#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/pipeline/sweep_job.hpp>
#include <meshfarm/staging/staged_reader.hpp>
#include <meshfarm/stream/sweep.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

// Version 3: level i32 | greatest cost f64 | ratio f64 | window u64 | samples u64 |
// greatest error f64 | lines (run_options.hpp).
constexpr std::uint8_t k_sweep_version = 3;
constexpr std::uint64_t k_most_sweep_samples = 100'000'000;
constexpr std::uint64_t k_max_window = std::uint64_t{1} << 30;

/// Sweeps from the stream to the result without holding either.
class SweepToFile {
 public:
  SweepToFile(const Job& job, const JobContext& context)
      : job_(job),
        context_(context),
        parameters_(decode_sweep_parameters(job.parameters)),
        file_(context.create(ResultName{key_of(job).value, context.attempt, context.incarnation})) {
  }

  JobOutput run() {
    input().size <= job_.memory ? sweep_in_memory() : sweep_bit_by_bit();
    result_->end_rung(parameters_.level, swept_.free_triangles, swept_.error);
    result_->finish(VertexView(swept_.boundary), {&swept_.samples, 1});
    const ResultSummary summary{result_->rungs(),
                                swept_.dropped_degenerate,
                                swept_.dropped_duplicate,
                                false,
                                swept_.turned,
                                {},
                                LadderEnd::floor,
                                result_->tail(),
                                result_->beside()};
    swept_ = {};
    return {file_->commit(), encode_summary(summary)};
  }

 private:
  const FileRef& input() const { return job_.inputs[0]; }

  void sweep_from(Fill fill) {
    StreamReader reader(std::move(fill), input().name);
    SweepOptions options;
    options.max_cost = parameters_.max_cost;
    options.ratio = parameters_.ratio;
    options.window_triangles = parameters_.window_triangles;
    options.samples = parameters_.samples;
    options.lines = parameters_.lines;
    options.measure = parameters_.max_error > 0;
    options.progress = context_.progress;
    const StreamInfo& info = reader.info();
    result_.emplace(
        ResultWriter::Vertices{
            info.positions, info.appearances && parameters_.lines.appearance_scale.length > 0,
            info.boundary_vertices, info.columns.and_in(parameters_.lines.columns)},
        [this](std::string_view bytes) { file_->write(bytes); });
    swept_ =
        sweep(reader, options, [this](const VertexView& vertices, auto triangles, auto columns) {
          result_->add(vertices, triangles, columns);
        });
  }

  /// Invalid contents with a correct checksum stay invalid, whoever reads them.
  void sweep_in_memory() {
    const std::string stream = context_.read(input());
    try {
      sweep_from(fill_from(stream, input().name));
    } catch (const DataError& error) {
      throw BadInputError(error.what());
    }
  }

  void sweep_bit_by_bit() {
    StagedReader stream(context_.stage, input());
    sweep_from([&](std::span<char> buffer) { stream.fill(buffer); });
    stream.expect_end();
  }

  const Job& job_;
  const JobContext& context_;
  SweepParameters parameters_;
  std::unique_ptr<JobFile> file_;
  std::optional<ResultWriter> result_;
  SweptStream swept_;
};

}  // namespace

std::string encode_parameters(const SweepParameters& parameters) {
  ByteWriter out;
  out.put(k_sweep_version);
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
  if (in.get<std::uint8_t>() != k_sweep_version) in.fail("made by another version of meshfarm");
  SweepParameters parameters;
  parameters.level = in.get<std::int32_t>();
  parameters.max_cost = in.get<double>();
  parameters.ratio = in.get<double>();
  if (!(parameters.ratio >= 0 && parameters.ratio <= 1)) in.fail("impossible ratio");
  parameters.window_triangles = in.get<std::uint64_t>();
  if (parameters.window_triangles > k_max_window) in.fail("too large a window");
  parameters.samples = in.get<std::uint64_t>();
  if (parameters.samples > k_most_sweep_samples) in.fail("too many samples");
  parameters.max_error = in.get<double>();
  parameters.lines = get_lines(in);
  in.expect_end();
  return parameters;
}

JobOutput sweep_stream(const Job& job, const JobContext& context) {
  if (job.inputs.size() != 1) throw DataError("a sweep job takes one stream");
  return SweepToFile(job, context).run();
}

}  // namespace meshfarm
