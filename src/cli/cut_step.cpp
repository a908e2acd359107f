// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/cut_step.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <meshfarm/divide/block_cut.hpp>
#include <meshfarm/divide/cut.hpp>
#include <meshfarm/io/channel_choice.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/io/near_vertices.hpp>
#include <meshfarm/pipeline/cut_job.hpp>
#include <meshfarm/staging/claim.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>
#include <meshfarm/util/text.hpp>

#include "cli/cut_record.hpp"
#include "cli/texture_words.hpp"

namespace meshfarm {

namespace {

/// The cut in the stage, if it is the wanted one.
Manifest taken_up(const Stage& stage, const CutStep& step) {
  const std::string root = stage.root().string();
  const auto staged = read_record(stage);
  const auto differs = [&](bool farmed) {
    return difference(*staged, record_of(step.input, step.words, farmed));
  };
  std::string what = "a cut of an older version";
  if (staged) what = differs(step.words.where == "farm");
  if (staged && !what.empty() && step.words.where == "auto" && differs(true).empty()) what.clear();
  if (!what.empty()) {
    throw DataError(root + ": holds a finished cut of " + what + "; 'meshfarm replay " + root +
                    "' uses it, or remove it to cut again");
  }
  log_info(root + " already holds this cut; it is used again");
  return decode_manifest(stage.read(ManifestName{}), stage.path(ManifestName{}).string());
}

std::unique_ptr<MeshSource> open_input(const CutStep& step) {
  // Readers of compressed and ascii files have scratch files of their own, which go to TMPDIR.
  if (!step.words.scratch.empty()) ::setenv("TMPDIR", step.words.scratch.c_str(), 1);
  auto opened = open_mesh(
      step.input,
      {.threads = step.words.cut.threads,
       .channels = step.words.attributes != "none",
       .labels = step.words.attributes != "none",
       .textures = step.words.attributes == "none" ? Textures::drop : parse_uv(step.words.uv)});
  tell_textures(step.input, opened->info());
  return with_channels(std::move(opened), step.words.channels);
}

/// Why the farm cannot cut this; empty if it can.
std::string why_not_by_farm(const MeshFileInfo& info, const std::optional<Cutting>& cutting) {
  if (!cutting) return "it is no plain binary PLY file of triangles; use --cut here";
  if (info.labels || info.uvs || !info.channels.empty()) {
    return "it has colours, labels or other attributes; --attributes none leaves them out, --cut "
           "here keeps them";
  }
  return {};
}

/// What the farm should cut; nothing if this process cuts.
std::optional<Cutting> cutting_for(const CutStep& step, const MeshSource& source) {
  const CutWords& words = step.words;
  const bool is_asked = words.where == "farm";
  const bool may = words.where == "auto" && step.farm_pays && step.farm_pays(source.info().faces) &&
                   words.cut.scheme == Scheme::cut && words.cut.weld == Weld::exact &&
                   words.memory.empty() && source.info().near_merges.distance == 0;
  if (!is_asked && !may) return std::nullopt;
  std::optional<Cutting> cutting =
      plan_cutting(step.input, {words.cut.parts, words.blocks, words.where == "farm"});
  const std::string why = why_not_by_farm(source.info(), cutting);
  if (why.empty()) return cutting;
  if (is_asked) throw UsageError(step.input + ": cannot be cut by the farm: " + why);
  return std::nullopt;
}

/// "1.2e-07"
std::string text_of(double length) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.begin(), text.end(), length, std::chars_format::general, 2);
  return {text.begin(), end.ptr};
}

/// The distance up to which vertices are merged; 0: only at the same position.
double merge_distance(const CutStep& step, MeshSource& source, const Box& box) {
  constexpr double k_most_of_diagonal = 0.01;
  constexpr double k_most_of_error = 0.05;
  const Length& asked = step.words.weld_distance;
  if (asked.value > 0) {
    if (asked.in(box) > k_most_of_diagonal * box.diagonal()) {
      throw UsageError("--weld " + step.words.weld + ": more than 1% of the diagonal");
    }
    return asked.in(box);
  }
  const double found = find_near_misses(source, box);
  const double most = step.error.value > 0 ? k_most_of_error * step.error.in(box) : HUGE_VAL;
  if (found <= most) return found;
  log_warning(step.input + ": corners that belong together are up to " + text_of(found) +
              " apart, and are not merged, as --error is so small; --weld LENGTH merges them");
  return 0;
}

/// Merges vertices that are near each other, if so asked or if rounding has parted them.
std::unique_ptr<MeshSource> near_merged(std::unique_ptr<MeshSource> source, const CutStep& step) {
  const CutWords& words = step.words;
  const bool is_asked = words.weld_distance.value > 0;
  if (!is_asked && (words.weld != "auto" || !may_have_near_misses(source->info()))) return source;
  const Box box = vertex_box(*source);
  const double distance = merge_distance(step, *source, box);
  if (distance == 0) return source;
  if (words.where == "farm") {
    throw UsageError(step.input +
                     ": cannot be cut by the farm: corners that belong together are up to " +
                     text_of(distance) + " apart; --cut here merges them, --weld exact does not");
  }
  ProgressPrinter printer(step.talk.progress());
  const auto show = [&](double done) {
    if (step.stop) throw IncompleteError("the cut was interrupted; run the same command again");
    printer.show({.phase = "cut: merge near vertices", .done = done, .triangles = 0});
  };
  source = with_near_merged(std::move(source), box, {distance, words.cut.threads, show});
  const NearMerges& made = source->info().near_merges;
  if (made.vertices > 0) {
    log_info(step.input + ": vertices up to " + text_of(distance) + " apart were merged, " +
             std::to_string(made.vertices) + " moved" +
             (is_asked ? "" : "; --weld exact leaves them as they are"));
  }
  return source;
}

/// Leaves the cut to the first jobs of a run.
Manifest plan_cut(const CutStep& step, const MeshFileInfo& info, const Cutting& cutting,
                  const Stage& stage) {
  Manifest manifest;
  manifest.input = step.input;
  manifest.input_format = info.format;
  manifest.skipped = info.skipped;
  manifest.partitioner = partitioner_of_blocks();
  manifest.positions = info.positions;
  manifest.input_vertices = info.vertices;
  manifest.input_triangles = info.faces;
  manifest.cutting = cutting;
  publish_record(stage, record_of(step.input, step.words, true));
  stage.publish(ManifestName{}, encode_manifest(manifest));
  return manifest;
}

/// Cuts on this host, or leaves it to the first jobs of a run.
Manifest cut(MeshSource& source, const Stage& stage, const CutStep& step) {
  if (const auto cutting = cutting_for(step, source)) {
    return plan_cut(step, source.info(), *cutting, stage);
  }
  publish_record(stage, record_of(step.input, step.words));
  ProgressPrinter printer(step.talk.progress());
  CutOptions options = step.words.cut;
  options.input_name = step.input;
  options.stop = &step.stop;
  options.progress = [&](std::string_view phase, double done) {
    printer.show({.phase = phase, .done = done, .triangles = 0});
  };
  Manifest made = cut_mesh(source, stage, options);
  if (source.small_faces() > 0) {
    log_warning(step.input + ": left out: " + std::to_string(source.small_faces()) +
                " faces of 0 to 2 corners");
  }
  return made;
}

}  // namespace

Manifest cut_to_stage(const CutStep& step) {
  // An input that cannot be read, or lacks what is requested, leaves no stage behind.
  std::unique_ptr<MeshSource> source = holds_cut(step.stage) ? nullptr : open_input(step);
  std::error_code unknown;
  const bool is_new = !std::filesystem::exists(step.stage, unknown) && !unknown;
  const Stage stage = Stage::create(step.stage);
  const Claim claim(stage.root() / ".cut.claim", step.stage + ": is being cut");
  if (stage.has_manifest()) return taken_up(stage, step);
  if (!source) source = open_input(step);
  const auto forget = [&] {
    if (is_new && !stage.has_manifest()) remove_stage(stage.root());
  };
  try {
    source = near_merged(std::move(source), step);
    return cut(*source, stage, step);
  } catch (const DataError&) {  // found on the way
    forget();
    throw;
  } catch (const UsageError&) {
    forget();
    throw;
  }
}

void tell_textures(const std::string& input, const MeshFileInfo& info) {
  if (!info.pictures.names.empty()) {
    log_info(input + ": with the textures " + joined(info.pictures.names));
  }
  if (info.textures.empty()) return;
  log_info(input + ": the vertices' colours are of the textures " + joined(info.textures));
}

}  // namespace meshfarm
