// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/pipeline/assemble.hpp>
#include <meshfarm/pipeline/bake_job.hpp>
#include <meshfarm/pipeline/cut_job.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/pipeline/run_graph.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/stopwatch.hpp>

#include "pipeline/bake_stage.hpp"
#include "pipeline/channel_values.hpp"
#include "pipeline/finish_result.hpp"
#include "pipeline/pieces_error.hpp"
#include "pipeline/pieces_output.hpp"
#include "pipeline/result_textures.hpp"
#include "pipeline/texture_bake.hpp"

namespace meshfarm {

namespace {

/// How far the file's format may move a vertex: 0 unless it rounds doubles.
double rounding_of_file(const std::filesystem::path& path, PositionType positions, const Box& box) {
  if (positions == PositionType::float32 || keeps_doubles(path) || box.empty()) return 0;
  double greatest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    greatest = std::max({greatest, std::abs(box.lo[axis]), std::abs(box.hi[axis])});
  }
  // glTF positions are relative to another origin within the mesh: up to twice as far.
  return 2 * std::sqrt(3.0) * 0x1p-24 * greatest;
}

/// Quantised positions would be off by more than what is proven.
AssembleOptions for_run(AssembleOptions options, const RunOptions& run) {
  if (run.certify) options.output.packing = Packing::plain;
  return options;
}

}  // namespace

class Assembler::Impl {
 public:
  Impl(const Stage& stage, const Manifest& manifest, const RunOptions& run, AssembleOptions options)
      : stage_(stage), staged_(manifest), run_(run), options_(for_run(std::move(options), run)) {}

  JobOutput do_job(const Job& job, const JobContext& context,
                   std::span<const AcceptedJob> accepted) {
    if (job.kind == k_join_kind) return join_boundary_of_parts(job, context);
    if (job.kind == k_write_kind) return write_before_end(job, context, accepted);
    if (job.kind != k_finish_kind) throw DataError("a sink does no " + job.kind + " jobs");
    finish(take(accepted));
    tell("new texture", 0, 0);
    const BakeInput input{finished_->summary.error.greater().max, options_.threads};
    return publish_bake_scene(stage_, manifest_, finished_->mesh, *layout_, input, job, context);
  }

  RunSummary complete(std::span<const AcceptedJob> accepted) {
    const ChosenRungs& chosen = take(accepted);
    if (state_.finished) return complete_in_pieces(*state_.finished);
    // If another sink did the jobs, this one does not have the finished mesh.
    if (!finished_) finish(chosen);
    Stopwatch watch;
    RunSummary summary = std::move(finished_->summary);
    write(finished_->mesh, layout_ ? &state_.baked : nullptr, summary);
    finished_.reset();
    summary.write_seconds = watch.lap();
    return summary;
  }

 private:
  void tell(std::string_view phase, double done, std::uint64_t triangles) const {
    check_stop();
    if (options_.progress) options_.progress(phase, done, triangles);
  }

  void check_stop() const {
    if (options_.stop != nullptr && *options_.stop) {
      throw IncompleteError(
          "interrupted before the result was written; all parts are simplified, "
          "'meshfarm replay' or 'meshfarm run' on the stage goes on from there");
    }
  }

  const ChosenRungs& take(std::span<const AcceptedJob> accepted) {
    state_ = state_of_run(staged_, run_, accepted);
    if (!state_.chosen) throw Error("a mesh is asked for before all of its parts are accepted");
    return *state_.chosen;
  }

  void finish(const ChosenRungs& chosen) {
    const FinishResultOptions options{
        options_.threads,
        [this](std::string_view phase, double done, std::uint64_t triangles) {
          tell(phase, done, triangles);
        },
        [this] { check_stop(); }};
    finished_ = finish_result(stage_, manifest_, run_, chosen, options);
    finished_->summary.output = options_.output.string();
    // The farm was asked to finish, or should have by default but could not.
    if (run_.finish_place == FinishPlace::farm ||
        (why_finish_here(manifest_, run_).empty() && state_.why_finish_here != k_sink_holds_it)) {
      finished_->summary.why_finished_here = state_.why_finish_here;
    }
    if (run_.certify) finished_->summary.certified_error += rounding_of_output();
    if (!bakes_texture(manifest_, run_)) return;
    Stopwatch watch;
    tell("charts", 0, 0);
    layout_ =
        lay_out_texture(stage_, manifest_, run_.texture_size, options_.threads, finished_->mesh);
    finished_->summary.finish_seconds += watch.lap();
  }

  double rounding_of_output() const {
    return rounding_of_file(options_.output, manifest_.positions, manifest_.box);
  }

  JobOutput write_before_end(const Job& job, const JobContext& context,
                             std::span<const AcceptedJob> accepted) {
    take(accepted);
    if (!state_.finished) throw Error("a mesh is to be written before all of it is finished");
    written_ = write(*state_.finished);
    return publish_counts(*state_.finished, job, context);
  }

  std::unique_ptr<MeshSink> write(const FinishedPieces& result) const {
    return write_pieces(stage_, manifest_, result, options_.output, [this] { check_stop(); });
  }

  /// A result too large to be finished here is written as it is read, except for attributes, which
  /// are fitted to the whole. If another sink wrote it, this one writes it again.
  RunSummary complete_in_pieces(const FinishedPieces& result) {
    Stopwatch watch;
    RunSummary summary = summary_of_pieces(result);
    tell("measure", 0, 0);
    summary.error = error_of_pieces(stage_, manifest_, result, options_.threads, summary.pieces);
    summary.measure_seconds = watch.lap();
    tell("write", 0, 0);
    if (has_attributes(manifest_)) {
      Mesh mesh = mesh_of_pieces(stage_, result, [this] { check_stop(); });
      write(mesh, nullptr, summary);
    } else {
      const auto written = written_ ? std::exchange(written_, nullptr) : write(result);
      written->commit();
    }
    summary.write_seconds = watch.lap();
    return summary;
  }

  RunSummary summary_of_pieces(const FinishedPieces& result) const {
    RunSummary summary;
    summary.manifest = manifest_;
    summary.output = options_.output.string();
    summary.target = asked_triangles(manifest_, run_);
    summary.max_error = run_.error.in(manifest_.box);
    if (run_.certify) summary.certified_error = summary.max_error + rounding_of_output();
    summary.finished_in_pieces = result.pieces.size();
    summary.dropped_degenerate = manifest_.coincident_corners;
    summary.dropped_duplicate = manifest_.dropped_duplicate;
    for (const ChosenRung& each : state_.chosen->rungs) {
      summary.dropped_degenerate += each.dropped_degenerate;
      summary.dropped_duplicate += each.dropped_duplicate;
      summary.turned += each.turned;
    }
    for (const PieceOfResult& each : result.pieces) {
      summary.dropped_degenerate += each.divided.dropped_degenerate;
      summary.dropped_duplicate += each.divided.dropped_duplicate;
      summary.turned += each.divided.turned;
      summary.stitched += each.divided.weight.before + each.divided.gap_triangles;
    }
    summary.topology_simplified = result.simplifies_topology;
    summary.dropped_components = result.dropped_components;
    summary.triangles = result.triangles();
    summary.vertices = result.vertices();
    if (summary.max_error > 0) return summary;
    if (summary.triangles > summary.target) {
      summary.why_not_exact = "keeping the charts of its textures needs about that many";
    }
    if (summary.triangles < summary.target) {
      summary.why_not_exact = summary.triangles + 1 < summary.target
                                  ? "pieces of a few triangles go as a whole"
                                  : "where no open border is left, triangles go in pairs";
    }
    return summary;
  }

  void write(Mesh& result, const BakedTexture* baked, RunSummary& summary) {
    const ChannelFitting fitting{chosen_columns(manifest_, run_), run_.normals, options_.threads};
    const std::vector<Channel> chosen = channels_at(manifest_.channels.channels, fitting.columns);
    const std::vector<Channel> kept = kept_channels(options_.output, chosen);
    for (const Channel& channel : manifest_.channels.channels) {
      if (std::find(chosen.begin(), chosen.end(), channel) != chosen.end()) continue;
      summary.channels_not_wanted.push_back(channel.name);
    }
    std::optional<LabelMeaning> labels = chosen_labels(manifest_, run_);
    if (labels && keeps_labels(options_.output)) {
      summary.labels = {labels->name, {}};
      if (keeps_materials(options_.output)) summary.labels = labels;
    }
    summary.labels_too_fine = are_labels_too_fine(manifest_, run_);
    const bool becomes_picture = chosen_textures(manifest_, run_) == TextureMode::bake;
    if (manifest_.labels && !labels && !summary.labels_too_fine && !becomes_picture) {
      summary.channels_not_wanted.push_back(manifest_.labels->name);
    }
    const PictureFiles pictures = make_textures(result, labels, baked, summary);
    if (kept.empty()) {
      return write_mesh(options_.output, result, manifest_.positions, {}, {}, labels, pictures);
    }
    const ChannelValues fitted = fit_channels(stage_, manifest_, result, fitting, [&](double done) {
      tell("colours and other channels", done, 0);
    });
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      if (std::find(kept.begin(), kept.end(), chosen[i]) == kept.end()) continue;
      summary.channels.push_back({chosen[i].name, fitted.rms[i]});
    }
    write_mesh(options_.output, result, manifest_.positions, chosen, fitted.values, labels,
               pictures);
  }

  PictureFiles make_textures(Mesh& result, std::optional<LabelMeaning>& labels,
                             const BakedTexture* baked, RunSummary& summary) {
    std::optional<MadeTexture> made;
    if (baked != nullptr) {
      tell("texture", 0, 0);
      made =
          MadeTexture{*layout_, [this, baked] {
                        return baked_picture(stage_, manifest_, *layout_, *baked, options_.threads);
                      }};
    }
    ResultTextures textures =
        textures_of_result(stage_, manifest_, run_, options_.output, made, result);
    summary.textures = textures.made;
    if (textures.labels) labels = std::move(textures.labels);
    return std::move(textures.pictures);
  }

  const Stage& stage_;
  const Manifest& staged_;
  RunState state_;
  const Manifest& manifest_ = state_.manifest;  // with sorted slabs
  const RunOptions& run_;
  AssembleOptions options_;
  std::optional<FinishedResult> finished_;
  std::optional<TextureLayout> layout_;  // of a new texture
  std::unique_ptr<MeshSink> written_;    // a result finished in pieces; not committed yet
};

Assembler::Assembler(const Stage& stage, const Manifest& manifest, const RunOptions& run,
                     AssembleOptions options)
    : impl_(std::make_unique<Impl>(stage, manifest, run, std::move(options))) {}
Assembler::~Assembler() = default;

JobOutput Assembler::do_job(const Job& job, const JobContext& context,
                            std::span<const AcceptedJob> accepted) {
  return impl_->do_job(job, context, accepted);
}

RunSummary Assembler::complete(std::span<const AcceptedJob> accepted) {
  return impl_->complete(accepted);
}

}  // namespace meshfarm
