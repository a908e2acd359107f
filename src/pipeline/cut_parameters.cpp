// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Parameters and summaries of the jobs of a cut, version 4 (in version 3 bundles did not list their
// parts, version 2 had one join, version 1 described each cell completely):
// parameters: version u8 | cutting (io/manifest.hpp) | block u32 | round u32 | box 6 x f64 |
// bundles (bundle_list.hpp)
// join parameters: version u8 | group u32 | bundles | parts u32 x (file | section)
// survey: box 6 x f64 | not finite u64
// partition: counts again u8 | parts u32
// join summary: index section | triangles u64 | degenerate u64 | coincident u64 | duplicate u64
#include <utility>

#include <meshfarm/pipeline/cut_job.hpp>
#include <meshfarm/staging/file_ref.hpp>
#include <meshfarm/util/bytes.hpp>

#include "pipeline/bundle_list.hpp"

namespace meshfarm {
namespace {

constexpr std::uint8_t k_cut_job_version = 4;

void expect_cut_version(ByteReader& in) {
  if (in.get<std::uint8_t>() != k_cut_job_version) in.fail("made by another version of meshfarm");
}

void put_box(ByteWriter& out, const Box& box) {
  out.put(box.lo);
  out.put(box.hi);
}

Box get_box(ByteReader& in) {
  Box box;
  box.lo = in.get<Vec3>();
  box.hi = in.get<Vec3>();
  return box;
}

}  // namespace

std::string encode_parameters(const CutJobParameters& parameters) {
  ByteWriter out;
  out.put(k_cut_job_version);
  put_cutting(out, parameters.cutting);
  out.put(parameters.block);
  out.put(parameters.round);
  put_box(out, parameters.box);
  put_bundles(out, parameters.bundles);
  return out.take();
}

CutJobParameters decode_cut_parameters(std::string_view bytes) {
  ByteReader in(bytes, "parameters of a job of the cut");
  expect_cut_version(in);
  CutJobParameters parameters;
  parameters.cutting = get_cutting(in);
  parameters.block = in.get<std::uint32_t>();
  if (parameters.block >= k_most_cut_blocks) in.fail("no such block");
  parameters.round = in.get<std::uint32_t>();
  parameters.box = get_box(in);
  parameters.bundles = get_bundles(in);
  in.expect_end();
  return parameters;
}

std::string encode_summary(const BlockSurvey& survey) {
  ByteWriter out;
  put_box(out, survey.box);
  out.put(survey.not_finite);
  return out.take();
}

BlockSurvey decode_survey(std::string_view summary, std::string_view what) {
  ByteReader in(summary, what);
  BlockSurvey survey;
  survey.box = get_box(in);
  survey.not_finite = in.get<std::uint64_t>();
  in.expect_end();
  return survey;
}

std::string encode_summary(const PartitionSummary& summary) {
  ByteWriter out;
  out.put(static_cast<std::uint8_t>(summary.counts_again ? 1 : 0));
  out.put(summary.parts);
  return out.take();
}

PartitionSummary decode_partition_summary(std::string_view summary, std::string_view what) {
  ByteReader in(summary, what);
  const auto again = in.get<std::uint8_t>();
  if (again > 1) in.fail("impossible partition");
  PartitionSummary made{again == 1, in.get<std::uint32_t>()};
  in.expect_end();
  return made;
}

std::string encode_parameters(const JoinParameters& parameters) {
  ByteWriter out;
  out.put(k_cut_job_version);
  out.put(parameters.group);
  put_bundles(out, parameters.bundles);
  out.put(static_cast<std::uint32_t>(parameters.numbers.size()));
  for (const PartNumbers& each : parameters.numbers) {
    put_file(out, each.file);
    out.put(each.section);
  }
  return out.take();
}

JoinParameters decode_join_parameters(std::string_view bytes) {
  ByteReader in(bytes, "parameters of a join");
  expect_cut_version(in);
  JoinParameters parameters;
  parameters.group = in.get<std::uint32_t>();
  parameters.bundles = get_bundles(in);
  const auto parts = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < parts; ++i) {
    FileRef file = get_file(in);
    parameters.numbers.push_back({std::move(file), in.get<FileSection>()});
  }
  in.expect_end();
  return parameters;
}

std::string encode_summary(const JoinSummary& summary) {
  ByteWriter out;
  out.put(summary.index);
  out.put(summary.triangles);
  out.put(summary.degenerate);
  out.put(summary.coincident);
  out.put(summary.duplicate);
  return out.take();
}

JoinSummary decode_join_summary(std::string_view summary, std::string_view what) {
  ByteReader in(summary, what);
  JoinSummary made;
  made.index = in.get<FileSection>();
  made.triangles = in.get<std::uint64_t>();
  made.degenerate = in.get<std::uint64_t>();
  made.coincident = in.get<std::uint64_t>();
  made.duplicate = in.get<std::uint64_t>();
  in.expect_end();
  return made;
}

}  // namespace meshfarm
