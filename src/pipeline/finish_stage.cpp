// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/finish_stage.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <meshfarm/farm/protocol.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>

#include "pipeline/error_meter.hpp"
#include "pipeline/part_jobs.hpp"
#include "pipeline/pieces_output.hpp"
#include "pipeline/quotas.hpp"
#include "pipeline/run_stages.hpp"
#include "pipeline/rung_input.hpp"

namespace meshfarm {
namespace {

/// A piece is weighed down to this fraction of the average share that pieces keep, as it may keep
/// less than others.
constexpr double k_last_of_share = 0.8;
/// Nearly every piece keeps less than this multiple of that share.
constexpr double k_kept_of_share = 1.3;
/// How often quotas are corrected.
constexpr std::size_t k_most_rounds = 4;
/// How often pieces are divided. The second time is k_steps_before_end steps before the threshold.
constexpr std::size_t k_most_turns = 2;
/// If nothing was collapsed before, the target may be this many times farther away.
constexpr double k_from_the_start = 8;
/// Samples of streams predict counts within a few per cent. Going back k_steps_back steps gives
/// about k_from_a_step_before times as many triangles.
constexpr std::int32_t k_steps_back = 2;
constexpr double k_from_a_step_before = 1.3;
constexpr std::int32_t k_steps_before_end = 2;
constexpr std::int32_t k_steps_for_turn = 2;

/// Measured: splitting a piece takes the work of simplifying this many times its triangles.
constexpr std::uint64_t k_split_work = 2;
/// Triangles of the input per job, at least.
constexpr std::uint64_t k_measured_at_once = 200'000;
/// Reading the result that is measured, and arranging its points, costs as much as this many
/// triangles.
constexpr std::uint64_t k_before_measuring = 20'000;
/// After that, this many triangles of the result take the work of simplifying one.
constexpr std::uint64_t k_measured_result = 3;
/// Memory per staged byte of the points that vertices are fitted to: the points as staged, in
/// memory, and the pull of each.
constexpr std::uint64_t k_fitting_times = 6;

std::uint64_t steps_of(std::uint64_t count, std::uint64_t most) {
  return std::max<std::uint64_t>(1, (count + most - 1) / most);
}

/// In proportion to the triangles, but at least one.
std::uint64_t share_of_points(std::uint64_t points, std::uint64_t triangles, std::uint64_t all) {
  return 1 + points * triangles / std::max<std::uint64_t>(1, all);
}

}  // namespace

void FinishStage::begin(JobGraph& graph, const FinishGoal& goal,
                        const std::vector<ComposedParts>& parts, Done done) {
  done_ = std::move(done);
  made_.target = target_triangles(manifest_, options_);
  if (parts.size() > k_most_pieces) {
    return done_(graph, std::nullopt, "there are more pieces than a job can name");
  }
  goal_ = goal;
  weigh_.samples = sample_counts(manifest_, options_);
  weigh_.lines = lines_of(manifest_, options_);
  weigh_.lines.topology = goal.topology;
  parts_ = parts;
  if (by_error()) {
    std::uint64_t left = manifest_.boundary_triangles;
    for (const ComposedParts& each : parts) left += each.triangles;
    if (holds_well(options_, left)) return done_(graph, std::nullopt, k_sink_holds_it);
    goal_.step = -1;
    weigh_.is_weighed = false;
  }
  options_.drop_components.in(manifest_.box) > 0 ? find_components(graph) : begin_pieces(graph);
}

void FinishStage::begin_pieces(JobGraph& graph) {
  made_.simplifies_topology = weigh_.lines.topology == TopologyMode::simplify;
  step_ = goal_.step;
  weigh_.cost_unit = cost_unit(manifest_.box.diagonal());
  weigh_.first_step = goal_.step;
  weigh_.last_share = std::min(1.0, k_last_of_share * goal_.share);
  weigh_.kept_share = std::min(1.0, k_kept_of_share * goal_.share);
  quotas_.clear();
  rounds_ = 0;
  turns_ = 0;
  divide(graph);
}

void FinishStage::divide(JobGraph& graph) {
  ++turns_;
  const std::size_t base = std::exchange(split_jobs_, split_jobs_ + parts_.size());
  std::uint32_t first_part = 0;
  made_.pieces.clear();
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    PieceOfResult& piece = made_.pieces.emplace_back();
    piece.first_part = first_part;
    piece.parts = parts_[i].chosen.parts;
    first_part += piece.parts;
    graph.add(job_name(RunStage::split, base + i), split_job(parts_[i], i));
  }
  graph.then({jobs_of(RunStage::split, base, parts_.size())}, [this, base](JobGraph& so_far) {
    for (std::size_t i = 0; i < made_.pieces.size(); ++i) {
      take_divided(so_far, i, job_name(RunStage::split, base + i));
    }
    if (made_.pieces.size() > 1) return join_seams(so_far);
    by_error() ? keep_all(so_far) : weigh(so_far);
  });
}

void FinishStage::take_divided(const JobGraph& graph, std::size_t piece, const JobName& name) {
  const JobOutput& output = graph.output(name);
  made_.pieces[piece].divided_file = output.file;
  made_.pieces[piece].divided =
      decode_divided_piece(output.summary, "summary of " + output.file.name);
}

void FinishStage::weigh(JobGraph& graph) {
  std::uint64_t gaps = 0;
  std::uint64_t all = 0;
  weights_.clear();
  for (const PieceOfResult& each : made_.pieces) {
    weights_.push_back(each.divided.weight);
    all += each.divided.weight.before;
    gaps += each.divided.gap_triangles;
  }
  if (all + gaps < made_.target && step_ >= 0 && turns_ <= k_most_turns) {
    step_back();
    return divide(graph);
  }
  if (gaps > made_.target || all + gaps < made_.target) {
    return done_(graph, std::nullopt, "the pieces have no common threshold for the count");
  }
  // If the seams are a large part of the surface, the ladders describe only a small part of it: far
  // from the target, what the pieces share would be denser than the rest.
  const std::int32_t step = step_below(weights_, made_.target - gaps) - k_steps_before_end;
  const std::size_t most_turns = step_ < 0 ? k_most_turns + 1 : k_most_turns;
  if (made_.pieces.size() > 1 && turns_ < most_turns && step >= step_ + k_steps_for_turn) {
    step_ = step;
    weigh_.first_step = step;
    return divide(graph);
  }
  reduce(graph, share_out_triangles(weights_, made_.target - gaps));
}

/// The pieces started too far along: the ladders also count what was left out, or count only
/// samples. If a small step back is not enough, nothing is simplified before the pieces are
/// divided.
void FinishStage::step_back() {
  const bool is_unknown = made_.dropped_components.components > 0 || turns_ > 1;
  const double times = is_unknown ? k_from_the_start : k_from_a_step_before;
  step_ = is_unknown ? -1 : std::max(-1, step_ - k_steps_back);
  weigh_.first_step = step_;
  weigh_.last_share /= times;
  weigh_.kept_share /= times;
}

/// A bound has already decided how much is left.
void FinishStage::keep_all(JobGraph& graph) {
  reduce(graph, std::vector<std::uint64_t>(made_.pieces.size(), k_keep_all));
}

/// Reduces the pieces whose quota has changed.
void FinishStage::reduce(JobGraph& graph, const std::vector<std::uint64_t>& quotas) {
  const std::size_t pieces = made_.pieces.size();
  ++rounds_;
  const std::size_t base = std::exchange(reduce_jobs_, reduce_jobs_ + pieces);
  std::vector<std::size_t> asked;
  JobNeeds needs;
  for (std::size_t i = 0; i < pieces; ++i) {
    if (i < quotas_.size() && quotas_[i] == quotas[i]) continue;
    const JobName name = job_name(RunStage::reduce, base + i);
    graph.add(name, reduce_job(i, quotas[i]));
    asked.push_back(i);
    needs.push_back(just(name));
  }
  quotas_ = quotas;
  graph.then(needs, [this, asked, base](JobGraph& so_far) {
    for (const std::size_t i : asked) {
      const JobOutput& output = so_far.output(job_name(RunStage::reduce, base + i));
      made_.pieces[i].finished_file = output.file;
      made_.pieces[i].finished =
          decode_finished_piece(output.summary, "summary of " + output.file.name);
    }
    look_at_count(so_far);
  });
}

void FinishStage::look_at_count(JobGraph& graph) {
  if (by_error() || made_.triangles() <= made_.target) return measure(graph);
  std::vector<std::uint64_t> made;
  for (const PieceOfResult& each : made_.pieces) made.push_back(each.finished.triangles);
  const std::vector<std::uint64_t> quotas = rounds_ < k_most_rounds
                                                ? share_out_again(weights_, quotas_, made)
                                                : std::vector<std::uint64_t>();
  if (!quotas.empty()) return reduce(graph, quotas);
  if (goal_.may_simplify && weigh_.lines.topology == TopologyMode::keep) {
    weigh_.lines.topology = TopologyMode::simplify;
    return begin_pieces(graph);
  }
  done_(graph, std::nullopt, "the pieces by themselves cannot be brought to the count");
}

/// The number of jobs per piece depends on the size of its input.
void FinishStage::measure(JobGraph& graph) {
  std::vector<Job> jobs;
  std::vector<std::size_t> end;  // of a piece's jobs
  for (std::size_t i = 0; i < made_.pieces.size(); ++i) {
    const std::vector<PartRange> ranges = ranges_of(made_.pieces[i]);
    for (std::uint32_t share = 0; share < ranges.size(); ++share) {
      jobs.push_back(measure_job(i, ranges, share));
      if (jobs.back().parameters.size() > k_max_parameters_bytes) {
        return done_(graph, std::nullopt, "there are more pieces than a job can name");
      }
    }
    end.push_back(jobs.size());
  }
  done_(graph, made_, {});
  JobNeeds needs = {jobs_of(RunStage::measure, 0, end.back())};
  for (std::size_t j = 0; j < jobs.size(); ++j) {
    graph.add(job_name(RunStage::measure, j), std::move(jobs[j]));
  }
  // Attributes are fitted to the whole result, so it is written later.
  if (!has_attributes(manifest_)) {
    needs.push_back(just(job_name(RunStage::write, 0)));
    graph.add(job_name(RunStage::write, 0), write_job(made_));
  }
  graph.then(needs, [this, end](JobGraph& so_far) {
    for (std::size_t i = 0, j = 0; i < made_.pieces.size(); ++i) {
      for (; j < end[i]; ++j) take_measured(so_far, made_.pieces[i], j);
    }
    done_(so_far, std::move(made_), {});
  });
}

void FinishStage::take_measured(const JobGraph& graph, PieceOfResult& piece, std::size_t job) {
  const JobOutput& output = graph.output(job_name(RunStage::measure, job));
  piece.error_files.push_back(output.file);
  add_share(decode_piece_error(output.summary, "summary of " + output.file.name), piece.error);
}

/// Ranges of neighbouring parts of the input. Unless the piece is a single part, the first range is
/// empty: it stands for what lies between the parts of a piece, or between the pieces.
std::vector<PartRange> FinishStage::ranges_of(const PieceOfResult& piece) const {
  std::vector<PartRange> ranges;
  if (piece.parts != 1) ranges.push_back({piece.first_part, piece.first_part});
  std::uint64_t triangles = k_measured_at_once;
  for (std::uint32_t p = piece.first_part; p < piece.first_part + piece.parts; ++p) {
    if (triangles >= k_measured_at_once) {
      ranges.push_back({p, p});
      triangles = 0;
    }
    triangles += manifest_.parts[p].triangles;
    ranges.back().end = p + 1;
  }
  return ranges;
}

Job FinishStage::split_job(const ComposedParts& parts, std::size_t number) const {
  Job job;
  job.kind = k_split_kind;
  const std::uint64_t bytes = add_rung_input(parts.chosen, parts.chosen.parts > 1, job);
  job.parameters = encode_parameters(SplitParameters{
      static_cast<std::uint32_t>(number), parts.chosen.rung, step_, parts.chosen.parts > 1,
      small_components_.empty() ? SectionRef{} : small_components_[number], weigh_});
  job.cost = k_split_work * parts.triangles;
  job.memory = k_piece_process_bytes + bytes + k_piece_triangle_bytes * parts.triangles +
               memory_of_channels(weigh_.lines, parts.triangles);
  return job;
}

/// Starts from the rung that is nearest above the quota.
Job FinishStage::reduce_job(std::size_t piece, std::uint64_t quota) const {
  const PieceOfResult& from = made_.pieces[piece];
  const ErrorPoints points = by_error() ? k_points_for_bound : ErrorPoints{};
  ReduceParameters parameters;
  const std::vector<std::uint64_t>& rungs = from.divided.rungs;
  while (parameters.rung + 1 < rungs.size() && rungs[parameters.rung + 1] >= quota) {
    ++parameters.rung;
  }
  parameters.triangles = quota;
  std::uint64_t share = quota;
  std::uint64_t all = made_.target;
  if (quota == k_keep_all) {
    share = rungs.front();
    all = 0;
    for (const PieceOfResult& each : made_.pieces) all += each.divided.rungs.front();
  }
  parameters.points = share_of_points(points.by_area, share, all);
  parameters.vertices = share_of_points(points.vertices, share, all);
  parameters.lines = weigh_.lines;
  Job job;
  job.kind = k_reduce_kind;
  job.inputs = {from.divided_file};
  job.sections = {{0, from.divided.mesh}};
  job.parameters = encode_parameters(parameters);
  job.cost = rungs[parameters.rung];
  job.memory = k_piece_process_bytes + from.divided.mesh.size + k_piece_triangle_bytes * job.cost +
               memory_of_channels(weigh_.lines, job.cost);
  // A group has no points of its own.
  if (weigh_.samples.fitting > 0 && from.parts > 0) {
    job.sections.push_back({0, from.divided.fitting});
    job.memory += k_fitting_times * from.divided.fitting.size;
  }
  return job;
}

Job FinishStage::measure_job(std::size_t number, const std::vector<PartRange>& ranges,
                             std::uint32_t share) const {
  const PieceOfResult& piece = made_.pieces[number];
  const ErrorPoints points = by_error() ? k_points_for_bound : ErrorPoints{};
  MeasureParameters parameters;
  parameters.first_part = ranges[share].first;
  parameters.end_part = ranges[share].end;
  parameters.share = share;
  parameters.shares = static_cast<std::uint32_t>(ranges.size());
  for (std::uint32_t p = piece.first_part; p < piece.first_part + piece.parts; ++p) {
    parameters.triangles += manifest_.parts[p].triangles;
  }
  if (manifest_.bundles) parameters.bundles = bundles_of_parts(*manifest_.bundles, ranges[share]);
  parameters.box = piece.divided.box;
  parameters.mesh = {piece.finished_file, piece.finished.mesh};
  parameters.samples = {piece.divided_file, piece.divided.samples};
  parameters.gap = {piece.divided_file, piece.divided.gap};
  if (piece.parts != 1 && ranges[share].first == ranges[share].end) {
    parameters.between = {piece.divided_file, piece.divided.between};
  }
  std::uint64_t result = piece.finished.triangles;
  for (const std::size_t near : made_.seams_near(number)) {
    const PieceOfResult& each = made_.pieces[near];
    parameters.seams.push_back(
        {{each.finished_file, each.finished.mesh}, {each.divided_file, each.divided.gap}});
    result += each.finished.triangles;
  }
  parameters.points.push_back({piece.finished_file, piece.finished.points});
  for (const std::size_t near : made_.near(number)) {
    const PieceOfResult& each = made_.pieces[near];
    parameters.points.push_back({each.finished_file, each.finished.points});
  }
  parameters.input_step = steps_of(manifest_.input_vertices, points.input_vertices);
  parameters.with_sides = manifest_.input_vertices <= points.input_sides;
  std::uint64_t part = 0;   // memory of all that the job has
  std::uint64_t first = 0;  // bytes of the first part
  std::uint64_t read = 0;
  std::uint64_t triangles = 0;
  for (std::uint32_t p = parameters.first_part; p < parameters.end_part; ++p) {
    const PartEntry& entry = manifest_.parts[p];
    triangles += entry.triangles;
    read += manifest_.bundles ? bytes_of_bundles(entry.triangles) : entry.file.size;
    if (p == parameters.first_part) first = read;
    part += manifest_.bundles ? k_built_triangle_bytes * entry.triangles
                              : entry.file.size + 60 * entry.triangles;
    if (!manifest_.bundles) parameters.parts.push_back(entry.file);
  }
  Job job;
  job.kind = k_measure_kind;
  job.parameters = encode_parameters(parameters);
  job.reads = read;
  if (triangles > 0) job.extent = extent_of_part(parameters.first_part, first);
  // Building a part takes about as long as measuring to it.
  const std::uint64_t shown = triangles / (manifest_.bundles ? 4 : 8);
  job.cost = k_before_measuring + shown + result / k_measured_result;
  if (piece.parts == 0) job.cost += piece.divided.strip_triangles;
  job.memory = k_piece_process_bytes + part + 100 * result;
  return job;
}

/// Size of the bundles for this many triangles of the input, approximately.
std::uint64_t FinishStage::bytes_of_bundles(std::uint64_t triangles) const {
  double bytes = 0;
  for (const VertexBundleRef& each : manifest_.bundles->vertices) {
    bytes += static_cast<double>(each.file.size);
  }
  for (const TriangleBundleRef& each : manifest_.bundles->triangles) {
    bytes += static_cast<double>(each.file.size);
  }
  const auto all = static_cast<double>(std::max<std::uint64_t>(1, manifest_.triangles()));
  return static_cast<std::uint64_t>(bytes * static_cast<double>(triangles) / all);
}

}  // namespace meshfarm
