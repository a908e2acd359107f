// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/sort_plan.hpp"

#include <algorithm>
#include <utility>

#include <meshfarm/divide/slab.hpp>
#include <meshfarm/pipeline/sort_job.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// Measured: to sort a triangle takes a quarter of the time that simplifying it does where the
/// input is in no order (a tenth where it is), to read it for a sample a fifteenth.
constexpr std::uint64_t k_sort_share = 4;
constexpr std::uint64_t k_sample_share = 15;

std::uint64_t memory_of_sort(const PartEntry& slab, std::uint64_t bytes_per_triangle) {
  constexpr std::uint64_t k_process = std::uint64_t{16} << 20;
  return k_process + slab.file.size + bytes_per_triangle * slab.triangles;
}

/// The stream as it is read, its mesh (24 bytes a triangle, twice that as it grows), the sample.
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

}  // namespace

SortPlan::SortPlan(Manifest manifest, std::span<const AcceptedJob> accepted)
    : manifest_(std::move(manifest)), rest_(accepted) {
  if (!manifest_.sorting) return;
  if (!accepts(sort_jobs())) return;
  take_streams();
  if (!accepts(sample_jobs())) return;
  take_samples();
  manifest_.sorting.reset();
}

std::vector<Job> SortPlan::sort_jobs() const {
  std::vector<Job> jobs;
  const std::uint64_t bytes_per_triangle = slab_bytes_per_triangle(
      !AppearanceColumns(manifest_.channels.channels).empty(), manifest_.columns());
  for (const PartEntry& slab : manifest_.parts) {
    jobs.push_back({std::string(k_sort_kind),
                    {slab.file},
                    encode_parameters(SortParameters{*manifest_.sorting, 0}),
                    1 + slab.triangles / k_sort_share,
                    memory_of_sort(slab, bytes_per_triangle)});
  }
  return jobs;
}

std::vector<Job> SortPlan::sample_jobs() const {
  std::vector<Job> jobs;
  for (std::uint32_t s = 0; s < manifest_.parts.size(); ++s) {
    if (!is_longer_than_a_window(manifest_, s)) continue;
    const PartEntry& stream = manifest_.parts[s];
    jobs.push_back({std::string(k_sample_kind),
                    {stream.file},
                    encode_parameters(SortParameters{*manifest_.sorting, s}),
                    1 + stream.triangles / k_sample_share,
                    memory_of_sample(stream)});
  }
  return jobs;
}

bool SortPlan::accepts(std::vector<Job> jobs) {
  if (rest_.size() < jobs.size()) jobs_ = std::move(jobs);
  return jobs_.empty();
}

void SortPlan::take_streams() {
  for (PartEntry& part : manifest_.parts) {
    const JobOutput& output = next();
    const SortSummary summary = summary_of(output);
    if (summary.boundary_vertices != part.boundary_vertices) {
      throw DataError(output.file.name + ": is not sorted from " + part.file.name);
    }
    part = entry_of(output.file, summary);
    manifest_.coincident_vertices += summary.coincident_vertices;
    manifest_.dropped_degenerate += summary.dropped_degenerate;
    manifest_.coincident_corners += summary.coincident_corners;
  }
}

void SortPlan::take_samples() {
  manifest_.samples.resize(manifest_.parts.size());
  for (std::size_t s = 0; s < manifest_.parts.size(); ++s) {
    if (!is_longer_than_a_window(manifest_, s)) continue;
    const JobOutput& output = next();
    manifest_.samples[s] = entry_of(output.file, summary_of(output));
  }
}

const JobOutput& SortPlan::next() {
  const JobOutput& output = rest_.front().output;
  rest_ = rest_.subspan(1);
  return output;
}

Manifest as_if_sorted(Manifest manifest) {
  manifest.sorting.reset();
  manifest.samples.resize(manifest.parts.size());
  for (std::uint32_t s = 0; s < manifest.parts.size(); ++s) {
    if (!is_longer_than_a_window(manifest, s)) continue;
    manifest.samples[s].file.name = to_string(PartName{s});
    manifest.samples[s].triangles = sample_size(manifest.parts[s].triangles);
  }
  return manifest;
}

}  // namespace meshfarm
