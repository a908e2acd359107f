// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// How a mesh is divided, in any scheme: by scans of the input, each in order and through bounded
// buffers:
//   vertices    bounding box, and what a scheme needs to know of their order
//   vertices    counts -> shares of about equal size; repeated once or a few times if vertices
//               are not spread like those of a surface
//   vertices    vertex map: share and place in it; positions to the share's bucket
//   triangles   to the share's bucket, or, if corners are in two or three shares, to the boundary
// Then each share is finished independently from its buckets, on all cores, and the boundary region
// by region.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include <meshfarm/divide/cut.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/regions.hpp>
#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/util/bucket_file.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

#include "divide/boundary_numbers.hpp"
#include "divide/cut_scheme.hpp"
#include "divide/seam_numbers.hpp"
#include "divide/share_budget.hpp"
#include "divide/share_out.hpp"

namespace meshfarm {
namespace {

class Cutter {
 public:
  Cutter(MeshSource& source, const Stage& stage, const CutOptions& options)
      : source_(source),
        stage_(stage),
        options_(options),
        scheme_(options.scheme == Scheme::stream ? make_stream_scheme(source, stage, options)
                                                 : make_part_scheme(source, stage, options)) {}

  Manifest run() {
    const auto start = std::chrono::steady_clock::now();
    describe_input();
    survey();
    distribute();
    stage_shares();
    stage_boundary();
    stage_rest();
    manifest_.cut_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    stage_.publish(ManifestName{}, encode_manifest(manifest_));
    return std::move(manifest_);
  }

 private:
  void describe_input() {
    const MeshFileInfo& info = source_.info();
    manifest_.scheme = options_.scheme;
    manifest_.input = options_.input_name;
    manifest_.input_format = info.format;
    if (info.compression != "none") manifest_.input_format += ", " + info.compression;
    manifest_.skipped = info.skipped;
    manifest_.near_merges = info.near_merges;
  }

  void tell(std::string_view phase, std::uint64_t done, std::uint64_t all) const {
    const CutScheme::Words words = scheme_->words();
    if (options_.stop != nullptr && *options_.stop) {
      throw IncompleteError(std::string(words.work) +
                            " was interrupted; run the same command again");
    }
    if (!options_.progress) return;
    options_.progress(std::string(words.phases) + ": " + std::string(phase),
                      all == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(all));
  }

  void survey() {
    const VertexSurvey found = survey_vertices(source_, scheme_->probe(), tell_);
    manifest_.positions = found.positions;
    manifest_.box = found.box;
    manifest_.input_vertices = found.vertices;
  }

  void distribute() {
    std::unique_ptr<ShareMap> map = scheme_->choose_map(manifest_);
    const std::uint32_t shares = settle(*map, source_, manifest_.input_vertices, tell_);
    manifest_.parts.resize(shares);
    SharedMesh shared = share_out(source_, std::move(map), share_options(shares), tell_);
    shares_ = std::move(shared.shares);
    manifest_.input_triangles = shared.triangles;
    manifest_.coincident_vertices = shares_->merged();
    manifest_.dropped_not_finite = shares_->dropped();
    manifest_.dropped_degenerate = shares_->points_left_out();
    manifest_.coincident_corners = shares_->points_left_out();
  }

  MeshShares::Options share_options(std::uint32_t shares) {
    MeshShares::Options options{.shares = shares,
                                .vertices = manifest_.input_vertices,
                                .positions = manifest_.positions,
                                .appearances = has_appearances(source_),
                                .columns = source_.info().columns(),
                                .triangles = std::max<std::uint64_t>(source_.info().faces, 1)};
    const std::uint64_t all = MeshShares::memory_for(options);
    options.memory_bytes = scheme_->memory_for_shares(all);
    folder_ = scratch_folder(options_.scratch, stage_.root(), all - options.memory_bytes);
    options.folder = folder_;
    return options;
  }

  void stage_shares() {
    const auto shares = static_cast<std::uint32_t>(manifest_.parts.size());
    numbers_.emplace(folder_, shares);
    uv_facts_.resize(shares);
    std::mutex mutex;
    std::uint64_t done = 0;
    const unsigned threads =
        scheme_->threads(manifest_.input_triangles, shares, shares_->buffer_bytes());
    parallel_for(shares, threads, [&](std::uint64_t i) {
      const auto number = static_cast<std::uint32_t>(i);
      StagedShare staged = scheme_->stage_share(shares_->read(number, options_.weld), number);
      const std::string numbers = encode_numbers(staged.numbers);
      const std::lock_guard lock(mutex);
      numbers_->append(number, numbers);
      take(std::move(staged), i);
      tell(scheme_->words().shares, ++done, shares);
    });
  }

  void take(StagedShare staged, std::size_t number) {
    manifest_.parts[number] = std::move(staged.entry);
    if (staged.sample) {
      manifest_.samples.resize(manifest_.parts.size());
      manifest_.samples[number] = std::move(*staged.sample);
    }
    uv_facts_[number] = staged.uv_facts;
    manifest_.coincident_vertices += staged.coincident_vertices;
    manifest_.dropped_degenerate += staged.dropped_degenerate;
    manifest_.coincident_corners += staged.coincident_corners;
    manifest_.label_corners += staged.label_corners;
  }

  void stage_boundary() {
    numbers_->finish();
    const auto parts = static_cast<std::uint32_t>(manifest_.parts.size());
    SeamNumbers numbers(parts, [this](std::uint32_t share) {
      const std::vector<char> bytes = numbers_->read<char>(share);
      return decode_numbers({bytes.data(), bytes.size()});
    });
    BoundaryWriter boundary(folder_, parts);
    const std::uint32_t regions = Regions(parts).count();
    for (std::uint32_t region = 0; region < regions; ++region) {
      SharedTriangles shared = numbers.number(shares_->region(region));
      manifest_.dropped_degenerate += shared.degenerate;
      manifest_.coincident_corners += shared.coincident;
      scheme_->order_boundary(shared);
      manifest_.dropped_duplicate += drop_duplicates(shared.triangles, shared.columns);
      boundary.add_region(shared.triangles, shared.columns);
      numbers.forget_unused();
      tell("boundary", region + 1, regions);
    }
    manifest_.boundary_triangles = boundary.triangles();
    manifest_.boundary = {boundary.publish(stage_)};
  }

  /// Everything in the input besides its surface.
  void stage_rest() {
    manifest_.labels = source_.info().labels;
    manifest_.uvs = source_.info().uvs;
    manifest_.pictures = stage_pictures(source_, stage_);
    set_uv_facts(manifest_, uv_facts_);
    manifest_.channels = stage_channels(source_, stage_, [&](std::uint64_t done) {
      tell("colours and other channels", done, manifest_.input_vertices);
    });
  }

  MeshSource& source_;
  const Stage& stage_;
  const CutOptions& options_;
  const std::unique_ptr<CutScheme> scheme_;
  const ScanProgress tell_ = [this](std::string_view phase, std::uint64_t done, std::uint64_t all) {
    tell(phase, done, all);
  };
  Manifest manifest_;
  std::filesystem::path folder_;  // for scratch files
  std::unique_ptr<MeshShares> shares_;
  std::optional<BucketFile> numbers_;  // of the parts' boundary vertices
  std::vector<UvFacts> uv_facts_;      // of the parts
};

}  // namespace

std::uint32_t default_parts(Scheme scheme, std::uint64_t triangles) {
  constexpr std::uint64_t k_part = 1'000'000;
  constexpr std::uint64_t k_stream = 1'200'000;
  constexpr std::uint64_t k_worth_dividing = 50'000;
  constexpr std::uint64_t k_few = 16;
  const bool is_cut = scheme == Scheme::cut;
  const std::uint64_t by_size =
      is_cut ? triangles / k_part : triangles / k_stream + (triangles % k_stream != 0 ? 1 : 0);
  const std::uint64_t parts = std::max(by_size, std::min(k_few, triangles / k_worth_dividing));
  return static_cast<std::uint32_t>(
      std::clamp<std::uint64_t>(parts, 1, is_cut ? 1'000'000 : k_most_slabs));
}

Manifest cut_mesh(MeshSource& source, const Stage& stage, const CutOptions& options) {
  return Cutter(source, stage, options).run();
}

}  // namespace meshfarm
