// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/pipeline/simplify_job.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/bounded_part.hpp"
#include "pipeline/bundle_list.hpp"
#include "pipeline/rung_input.hpp"

namespace meshfarm {
namespace {

// Version 12: allocation u8 | start u64 | even share u64 | end u64 | foreseen u64 | samples u64 |
// cost unit f64 | greatest error f64 | certified error f64 | lines (run_options.hpp) | source u8 |
// for a rung: its place u32, level i32 | for a part to build: part u32 | ratio f64 | headroom f64 |
// end f64 | all triangles u64 | all samples u64 | bundles (bundle_list.hpp). Version 4 had no
// appearances and labels, version 5 nothing to build, version 6 no certified error, version 7 no
// end, version 8 no rung, version 9 no foreseen triangles; version 10 began at first rungs only;
// version 11 did not always foresee; version 12 had half as many levels.
constexpr std::uint8_t k_climb_version = 13;
constexpr std::uint64_t k_most_climb_samples = 100'000'000;
constexpr std::int32_t k_top_level = 104;
constexpr double k_least_free_share = 0.25;
/// A rung with more than this share of the one before is kept only if it is the last.
constexpr double k_most_of_rung = 0.98;

/// Above this many times the even share of the target, every second level is enough: no part of
/// average density is needed there.
constexpr std::uint64_t k_shares_of_fine = 5;

/// A ladder ends where this many collapses per triangle are expected to be refused: some multiple
/// of what is fair, as the prediction is made from further away than in the sink.
constexpr double k_most_refused = 4;

enum class PartSource : std::uint8_t { file, bundles, rung };

/// Climbs the levels and keeps a snapshot at each level where the mesh has become smaller.
class LadderBuilder {
 public:
  LadderBuilder(Part part, std::vector<std::uint32_t> opened, std::vector<SurfaceSamples> samples,
                const SimplifyParameters& parameters, const JobContext& context,
                std::string_view beside)
      : samples_(std::move(samples)),
        parameters_(parameters),
        context_(context),
        input_triangles_(part.mesh.triangles.size()),
        vertices_(vertices_of(part)),
        simplifier_(std::move(part.mesh), {.locked_vertices = part.boundary_vertices,
                                           .positions = part.positions,
                                           .opened = std::move(opened),
                                           .lines = parameters.lines,
                                           .was_simplified = parameters.from.has_value(),
                                           .in_order = begins_in_order()}),
        result_(
            vertices_, [this](std::string_view bytes) { file_ += bytes; }, beside) {}

  void build() {
    if (parameters_.allocation == Allocation::uniform) {
      reduce({.triangles = parameters_.start_triangles});
      snapshot(0);
    } else {
      climb(start());
    }
  }

  /// The whole file. Call this last.
  std::string take_file() {
    result_.finish(VertexView(simplifier_.mesh()).part(0, vertices_.boundary), samples_);
    return std::move(file_);
  }
  /// The summary of the whole file.
  ResultSummary summary() const {
    ResultSummary summary = result_.summary_of(simplifier_);
    summary.held_by_topology = simplifier_.is_hampered_by_topology();
    summary.end = end_;
    return summary;
  }

 private:
  /// Makes the first rung and returns the level that the mesh has reached then.
  std::int32_t start() {
    if (!begins_at_later_rung() && parameters_.start_triangles < simplifier_.triangles()) {
      SimplifyGoal goal{.triangles = parameters_.start_triangles,
                        .last_triangles = parameters_.share_triangles,
                        .in_passes = may_give_up_topology()};
      reduce(goal);
      const std::int32_t level = reached();
      snapshot(level - 1);  // collapses at this cost are only partly done
      if (!goal.in_passes || simplifier_.triangles() <= goal.triangles) return level;
      goal.in_passes = false;
      reduce(goal);
      return std::max(level, reached());
    }
    const std::int32_t first = parameters_.from ? parameters_.from->level : k_input_level;
    snapshot(first);
    if (first != k_input_level) return first + 1;
    // A first step by count finds the level to begin at; little can be collapsed below it. It is
    // as far from the end as the levels are: if it came to strict order, they would stay in it.
    reduce({.triangles = simplifier_.triangles() - simplifier_.triangles() / 10,
            .last_triangles = std::max<std::uint64_t>(1, floor())});
    return reached();
  }

  /// If the rung is finer than requested, the passes had come to their end there.
  bool begins_in_order() const {
    return begins_at_later_rung() ||
           (parameters_.from && input_triangles_ > parameters_.start_triangles);
  }
  bool begins_at_later_rung() const { return parameters_.from && parameters_.from->place > 0; }
  bool may_give_up_topology() const {
    return parameters_.lines.topology == TopologyMode::keep_while_fair;
  }
  /// No rung has fewer triangles.
  std::uint64_t floor() const { return parameters_.share_triangles / k_shares_per_floor; }
  std::int32_t reached() const { return level_of(simplifier_.pass_cost(), parameters_.cost_unit); }

  void climb(std::int32_t level) {
    for (; level <= k_top_level && may_go_on(); level = next_level(level)) {
      reduce({.triangles = floor(), .max_cost = level_cost(level, parameters_.cost_unit)});
      if (simplifier_.is_held_by_topology()) return;
      if (is_enough()) end_ = LadderEnd::enough;
      if (is_refused_too_much()) end_ = LadderEnd::refusals;
      const bool is_last = end_ != LadderEnd::floor || !may_go_on() || level == k_top_level;
      if (is_worth_a_rung(is_last)) {
        snapshot(level);
      } else {
        result_.set_refused(simplifier_.refused_by_topology());
      }
      if (is_last) return;
    }
  }
  std::int32_t next_level(std::int32_t level) const {
    const bool is_far =
        simplifier_.free_triangles() > k_shares_of_fine * parameters_.share_triangles;
    return is_far ? (level / 2 + 1) * 2 : level + 1;
  }
  bool may_go_on() const {
    return simplifier_.triangles() > floor() && simplifier_.free_triangles() > 0;
  }

  /// Surfaces with large flat parts have nearly as many triangles at many levels as at the first.
  bool is_worth_a_rung(bool is_last) const {
    const auto left = static_cast<double>(simplifier_.triangles());
    const auto before = static_cast<double>(result_.rungs().back().triangles);
    return left < (is_last ? 1 : k_most_of_rung) * before;
  }

  bool is_refused_too_much() const {
    if (!may_give_up_topology() || parameters_.foreseen_triangles == 0) return false;
    const auto wanted = static_cast<double>(parameters_.foreseen_triangles);
    const Rung rung{.free_triangles = simplifier_.free_triangles(),
                    .refused = simplifier_.refused_by_topology()};
    return static_cast<double>(rung.free_triangles) > wanted &&
           refused_by(rung, wanted) > k_most_refused * wanted;
  }

  /// Whether the next rung would have less than what is wanted: it and those after it are not made.
  /// If the topology is kept at any cost, some parts may have to make up for others.
  bool is_enough() const {
    const bool may_be_stuck = parameters_.lines.topology == TopologyMode::keep;
    return simplifier_.triangles() > floor() &&
           simplifier_.free_triangles() <= parameters_.end_triangles &&
           !(may_be_stuck && simplifier_.is_slowed_by_topology());
  }

  void reduce(const SimplifyGoal& goal) {
    bool given_up = false;
    simplifier_.reduce(goal, [&](std::uint64_t left) {
      given_up = !context_.progress(input_triangles_ - std::min(left, input_triangles_));
      return !given_up;
    });
    if (given_up) throw IncompleteError("the job was given up");
  }

  /// Keeps the current mesh as a rung.
  void snapshot(std::int32_t level) {
    result_.add_rung(level, simplifier_.mesh(), simplifier_.free_triangles(), 0,
                     simplifier_.refused_by_topology(), simplifier_.opened());
  }

  std::vector<SurfaceSamples> samples_;  // of the unchanged part
  const SimplifyParameters& parameters_;
  const JobContext& context_;
  std::uint64_t input_triangles_;
  ResultWriter::Vertices vertices_;
  Simplifier simplifier_;
  std::string file_;
  ResultWriter result_;
  LadderEnd end_ = LadderEnd::floor;
};

/// Reads a part, or a stream as one. An incomplete file may be read completely by the next attempt;
/// invalid contents with a correct checksum stay invalid.
Part read_part(const JobContext& context, const FileRef& input) {
  const std::string file = context.read(input);
  try {
    return decode_part_or_stream(file, input.name);
  } catch (const DataError& error) {
    throw BadInputError(error.what());
  }
}

PartToBuild get_part_to_build(ByteReader& in) {
  PartToBuild build;
  build.part = in.get<std::uint32_t>();
  build.rule.ratio = in.get<double>();
  build.rule.headroom = in.get<double>();
  build.rule.end = in.get<double>();
  build.rule.all_triangles = in.get<std::uint64_t>();
  build.rule.all_samples = in.get<std::uint64_t>();
  if (!(build.rule.ratio > 0 && build.rule.ratio <= 1) || !(build.rule.headroom > 0) ||
      !(build.rule.end > 0) || build.rule.all_samples > k_most_climb_samples) {
    in.fail("impossible share");
  }
  build.bundles = get_bundles(in);
  return build;
}

/// A part of the stage, a rung of it, or a part that is built here, with what is known of it.
struct PartAtHand {
  Part part;
  std::vector<std::uint32_t> opened;  // ResultMesh::opened
  std::vector<SurfaceSamples> samples;
  std::string beside;
  std::optional<BuiltFacts> facts;
};

PartAtHand part_of_rung(const Job& job, const JobContext& context, std::uint32_t place) {
  if (job.inputs.size() != 1) throw DataError("a simplify job takes one rung");
  RungInputs rungs(job, context);
  ResultMesh rung = rungs.next(place);
  PartAtHand at_hand;
  at_hand.part.mesh = std::move(rung.mesh);
  at_hand.part.boundary_vertices = rung.boundary_vertices;
  at_hand.part.positions = rung.positions;
  at_hand.opened = std::move(rung.opened);
  at_hand.samples = std::move(rung.samples);
  at_hand.beside = rungs.beside();
  return at_hand;
}

PartAtHand part_at_hand(const Job& job, const JobContext& context, SimplifyParameters& parameters) {
  if (parameters.from) return part_of_rung(job, context, parameters.from->place);
  if (!parameters.build) {
    if (job.inputs.size() != 1) throw DataError("a simplify job takes one part");
    return {read_part(context, job.inputs[0]), {}, {}, {}, {}};
  }
  PartOfBlocks built =
      build_from_blocks(context.stage, parameters.build->bundles, parameters.build->part);
  set_share(parameters, parameters.build->rule, built.shared_triangles, built.shared_boundary);
  const Mesh& mesh = built.part.mesh;
  const BuiltFacts facts{mesh.positions.size(),        mesh.triangles.size(),
                         built.part.boundary_vertices, built.shared_triangles,
                         built.shared_boundary,        built.coincident_vertices,
                         built.dropped_degenerate,     built.coincident_corners};
  return {std::move(built.part), {}, {}, std::move(built.numbers), facts};
}

}  // namespace

std::string encode_parameters(const SimplifyParameters& parameters) {
  ByteWriter out;
  out.put(k_climb_version);
  out.put(parameters.allocation);
  out.put(parameters.start_triangles);
  out.put(parameters.share_triangles);
  out.put(parameters.end_triangles);
  out.put(parameters.foreseen_triangles);
  out.put(parameters.samples);
  out.put(parameters.cost_unit);
  out.put(parameters.max_error);
  out.put(parameters.certified_error);
  put(out, parameters.lines);
  out.put(parameters.build  ? PartSource::bundles
          : parameters.from ? PartSource::rung
                            : PartSource::file);
  if (parameters.from) {
    out.put(parameters.from->place);
    out.put(parameters.from->level);
  }
  if (!parameters.build) return out.take();
  out.put(parameters.build->part);
  out.put(parameters.build->rule.ratio);
  out.put(parameters.build->rule.headroom);
  out.put(parameters.build->rule.end);
  out.put(parameters.build->rule.all_triangles);
  out.put(parameters.build->rule.all_samples);
  put_bundles(out, parameters.build->bundles);
  return out.take();
}

SimplifyParameters decode_parameters(std::string_view bytes) {
  ByteReader in(bytes, "parameters of a simplify job");
  if (in.get<std::uint8_t>() != k_climb_version) in.fail("made by another version of meshfarm");
  SimplifyParameters parameters;
  parameters.allocation = in.get<Allocation>();
  if (parameters.allocation > Allocation::uniform) in.fail("unknown allocation");
  parameters.start_triangles = in.get<std::uint64_t>();
  parameters.share_triangles = in.get<std::uint64_t>();
  parameters.end_triangles = in.get<std::uint64_t>();
  parameters.foreseen_triangles = in.get<std::uint64_t>();
  parameters.samples = in.get<std::uint64_t>();
  if (parameters.samples > k_most_climb_samples) in.fail("too many samples");
  parameters.cost_unit = in.get<double>();
  parameters.max_error = in.get<double>();
  parameters.certified_error = in.get<double>();
  parameters.lines = get_lines(in);
  const auto source = in.get<PartSource>();
  if (source > PartSource::rung) in.fail("impossible part");
  if (source == PartSource::rung) {
    RungOfLadder& from = parameters.from.emplace();
    from.place = in.get<std::uint32_t>();
    from.level = in.get<std::int32_t>();
    if (from.level < k_input_level || from.level > k_top_level) {
      in.fail("impossible level");
    }
    const bool is_ladder =
        parameters.allocation == Allocation::threshold && !(parameters.max_error > 0);
    if (from.place >= k_most_rungs || !is_ladder) in.fail("impossible rung");
  }
  if (source == PartSource::bundles) parameters.build = get_part_to_build(in);
  in.expect_end();
  return parameters;
}

double estimate_free(std::uint64_t triangles, std::uint64_t boundary_vertices) {
  const auto all = static_cast<double>(triangles);
  return std::max(k_least_free_share * all, all - 2 * static_cast<double>(boundary_vertices));
}

void set_share(SimplifyParameters& parameters, const ShareRule& rule,
               std::uint64_t shared_triangles, std::uint32_t shared_boundary) {
  const auto triangles = static_cast<double>(shared_triangles);
  const double share = rule.ratio * triangles;
  const double kept = share * provision(rule.ratio);
  const double kept_free =
      rule.ratio * provision(rule.ratio) * estimate_free(shared_triangles, shared_boundary);
  double start = share;
  double end = 0;
  if (parameters.allocation == Allocation::threshold) {
    start = rule.headroom * kept / 2 + 2.0 * shared_boundary;
    end = rule.end * kept_free;
    if (start > 0.7 * triangles) {
      start = triangles;
      end = std::min(end, kept_free);  // the rung after the unchanged part is unpredictable
    }
  }
  parameters.share_triangles = static_cast<std::uint64_t>(share);
  parameters.start_triangles = static_cast<std::uint64_t>(start);
  parameters.end_triangles = static_cast<std::uint64_t>(end);
  parameters.foreseen_triangles = static_cast<std::uint64_t>(kept_free);
  const auto all = static_cast<double>(std::max<std::uint64_t>(1, rule.all_triangles));
  parameters.samples = static_cast<std::uint64_t>(
      std::ceil(triangles / all * static_cast<double>(rule.all_samples)));
}

double level_cost(std::int32_t level, double unit) {
  return std::ldexp(unit, level);
}

std::int32_t level_of(double cost, double unit) {
  std::int32_t level = 0;
  while (level < k_top_level && level_cost(level, unit) < cost) ++level;
  return level;
}

double cost_unit(double diagonal) {
  const double squared = diagonal * diagonal;
  return std::ldexp(squared * squared, -2 * 50);
}

JobOutput simplify_part(const Job& job, const JobContext& context) {
  SimplifyParameters parameters = decode_parameters(job.parameters);
  PartAtHand at_hand = part_at_hand(job, context, parameters);
  Part& part = at_hand.part;
  if (!(parameters.lines.appearance_scale.length > 0)) part.mesh.appearances = {};
  part.mesh.columns.keep(parameters.lines.columns);
  const ResultName name{key_of(job).value, context.attempt, context.incarnation};
  if (parameters.max_error > 0) {
    BoundedPart bounded = simplify_to_bound(part, parameters, context, at_hand.beside);
    bounded.summary.built = at_hand.facts;
    return {context.publish(name, bounded.file), encode_summary(bounded.summary)};
  }
  std::vector<SurfaceSamples>& samples = at_hand.samples;
  if (!parameters.from) {
    samples.push_back(sample_surface(part.mesh, {.samples = parameters.samples, .threads = 1}));
  }
  LadderBuilder ladder(std::move(part), std::move(at_hand.opened), std::move(samples), parameters,
                       context, at_hand.beside);
  ladder.build();
  const std::string file = ladder.take_file();
  ResultSummary summary = ladder.summary();
  summary.built = at_hand.facts;
  return {context.publish(name, file), encode_summary(summary)};
}

}  // namespace meshfarm
