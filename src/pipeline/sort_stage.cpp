// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/sort_stage.hpp"

#include <string>
#include <utility>

#include <meshfarm/divide/slab.hpp>
#include <meshfarm/pipeline/sort_job.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/run_stages.hpp"

namespace meshfarm {
namespace {

/// Measured: sorting a triangle takes a quarter of the time of simplifying it if the input is in no
/// order (a tenth if it is), reading it for a sample a fifteenth.
constexpr std::uint64_t k_sort_share = 4;
constexpr std::uint64_t k_sample_share = 15;

std::uint64_t memory_of_sort(const PartEntry& slab, std::uint64_t bytes_per_triangle) {
  constexpr std::uint64_t k_process = std::uint64_t{16} << 20;
  return k_process + slab.file.size + bytes_per_triangle * slab.triangles;
}

/// The stream as read, its mesh (24 bytes per triangle, twice that as it grows), the sample.
std::uint64_t memory_of_sample(const PartEntry& stream) {
  constexpr std::uint64_t k_process = std::uint64_t{16} << 20;
  return k_process + stream.file.size + 60 * stream.triangles;
}

PartEntry entry_of(const FileRef& file, const SortSummary& summary) {
  return {file, summary.vertices, summary.triangles, summary.boundary_vertices};
}

SortSummary summary_of(const JobOutput& output) {
  return decode_sort_summary(output.summary, "summary of " + output.file.name);
}

bool is_longer_than_a_window(const Manifest& manifest, std::size_t stream) {
  return manifest.parts[stream].triangles > manifest.window_triangles;
}

void estimate_sample(Manifest& manifest, std::uint32_t stream) {
  manifest.samples[stream].file.name = to_string(PartName{stream});
  manifest.samples[stream].triangles = sample_size(manifest.parts[stream].triangles);
}

}  // namespace

JobNeeds SortStage::ask(JobGraph& graph) {
  takes_samples_ = true;
  manifest_.samples.resize(manifest_.parts.size());
  for (std::uint32_t s = 0; s < manifest_.parts.size(); ++s) {
    const JobName name = job_name(RunStage::sort, s);
    graph.add(name, sort_job(s));
    graph.then({just(name)}, [this, s](JobGraph& so_far) { take_stream(s, so_far); });
  }
  return {jobs_of(RunStage::sort, 0, manifest_.parts.size())};
}

JobNeeds SortStage::sample_of(std::uint32_t stream) const {
  if (!takes_samples_ || !is_longer_than_a_window(manifest_, stream)) return {};
  return {just(job_name(RunStage::sample, stream))};
}

Job SortStage::sort_job(std::uint32_t slab) const {
  const PartEntry& entry = manifest_.parts[slab];
  const std::uint64_t bytes_per_triangle = slab_bytes_per_triangle(
      !AppearanceColumns(manifest_.channels.channels).empty(), manifest_.columns());
  return {std::string(k_sort_kind),
          {entry.file},
          encode_parameters(SortParameters{*manifest_.sorting, 0}),
          1 + entry.triangles / k_sort_share,
          memory_of_sort(entry, bytes_per_triangle)};
}

Job SortStage::sample_job(std::uint32_t stream) const {
  const PartEntry& entry = manifest_.parts[stream];
  return {std::string(k_sample_kind),
          {entry.file},
          encode_parameters(SortParameters{*manifest_.sorting, stream}),
          1 + entry.triangles / k_sample_share,
          memory_of_sample(entry)};
}

void SortStage::take_stream(std::uint32_t slab, JobGraph& graph) {
  PartEntry& part = manifest_.parts[slab];
  const JobOutput& output = graph.output(job_name(RunStage::sort, slab));
  const SortSummary summary = summary_of(output);
  if (summary.boundary_vertices != part.boundary_vertices) {
    throw DataError(output.file.name + ": is not sorted from " + part.file.name);
  }
  part = entry_of(output.file, summary);
  manifest_.coincident_vertices += summary.coincident_vertices;
  manifest_.dropped_degenerate += summary.dropped_degenerate;
  manifest_.coincident_corners += summary.coincident_corners;
  if (!is_longer_than_a_window(manifest_, slab)) return;
  estimate_sample(manifest_, slab);
  const JobName sample = job_name(RunStage::sample, slab);
  graph.add(sample, sample_job(slab));
  graph.then({just(sample)}, [this, slab, sample](JobGraph& so_far) {
    const JobOutput& taken = so_far.output(sample);
    manifest_.samples[slab] = entry_of(taken.file, summary_of(taken));
  });
}

Manifest as_if_sorted(Manifest manifest) {
  manifest.sorting.reset();
  manifest.samples.resize(manifest.parts.size());
  for (std::uint32_t s = 0; s < manifest.parts.size(); ++s) {
    if (is_longer_than_a_window(manifest, s)) estimate_sample(manifest, s);
  }
  return manifest;
}

}  // namespace meshfarm
