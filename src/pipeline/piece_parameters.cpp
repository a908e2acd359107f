// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Parameters and summaries of the jobs of a farmed finish, version 9, little endian:
//   weigh      = cost unit f64 | first step i32 | last share f64 | kept share f64 |
//                is weighed u8 | samples measured u64 | fitting u64 | lines
//   split      = version u8 | piece u32 | rung u32 | step i32 | is composed u8 | ref | weigh
//   seam       = version u8 | strips u32 x (parts u32 | ref) | group u32 | groups u32 |
//                all parts u32 | boundary (io/boundary_ref.hpp) | samples a triangle f64 | weigh |
//                bounded u8 | if it is: greatest error f64 | certified error f64 |
//                strips x (mesh section | gap section) | builds u8 | if it does: bundles
//   reduce     = version u8 | rung u32 | triangles u64 | points u64 | vertices u64 | lines
//   measure    = version u8 | first part u32 | end part u32 | triangles u64 | share u32 |
//                shares u32 | box | 4 refs | seams u32 x (ref | ref) | points u32 x ref |
//                input step u64 | with sides u8 | builds u8 | if it does: bundles
//                (bundle_list.hpp), else of each part a file
//   write      = version u8 | pieces u64
//   ref        = file | section;  box = 6 x f64
//   divided    = 6 sections | gap triangles u64 | strip triangles u64 | shared u64 | box |
//                rungs u32 x u64 | dropped degenerate u64 | duplicate u64 | turned u64 |
//                before u64 | first step i32 | counts u32 x u64
//   finished   = 2 sections | by area u64 | area f64 | vertices u64 | triangles u64
//   error      = area f64 | rms f64 | mean f64 | max f64 | samples u64
//   measured   = lists u32 x (points u32 x f64) | distances u32 x f64 | areas u32 x f64,
//                the file of a measure job
//
// In version 1 parts were always kept, and a piece was measured by one job. In version 2 the
// surroundings of the seams were one piece. In version 3 triangles of gaps had no columns, and no
// components were left out. In version 4 there was one boundary file. In version 5 there was no
// bound on the error, and measure jobs looked up the parts in the manifest. In version 6 a reduce
// job read its input whole. In version 7 sides were implied by an input step of 1. In version 8 no
// vertices were fitted.
#include <cmath>

#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/staging/file_ref.hpp>
#include <meshfarm/util/byte_lists.hpp>
#include <meshfarm/util/bytes.hpp>

#include "pipeline/bundle_list.hpp"

namespace meshfarm {
namespace {

constexpr std::uint8_t k_piece_version = 9;
constexpr double k_most_piece_samples = 1000;  // per triangle

void begin_parameters(ByteWriter& out) {
  out.put(k_piece_version);
}

void expect_piece_version(ByteReader& in) {
  if (in.get<std::uint8_t>() != k_piece_version) in.fail("made by another version of meshfarm");
}

void put_weigh(ByteWriter& out, const WeighParameters& weigh) {
  out.put(weigh.cost_unit);
  out.put(weigh.first_step);
  out.put(weigh.last_share);
  out.put(weigh.kept_share);
  out.put(static_cast<std::uint8_t>(weigh.is_weighed ? 1 : 0));
  out.put(weigh.samples.measured);
  out.put(weigh.samples.fitting);
  put(out, weigh.lines);
}

WeighParameters get_weigh(ByteReader& in) {
  WeighParameters weigh;
  weigh.cost_unit = in.get<double>();
  weigh.first_step = in.get<std::int32_t>();
  weigh.last_share = in.get<double>();
  weigh.kept_share = in.get<double>();
  weigh.is_weighed = in.get<std::uint8_t>() != 0;
  weigh.samples.measured = in.get<std::uint64_t>();
  weigh.samples.fitting = in.get<std::uint64_t>();
  weigh.lines = get_lines(in);
  const auto is_share = [](double x) { return x >= 0 && x <= 1; };
  if (!(weigh.cost_unit > 0) || !is_share(weigh.last_share) || !is_share(weigh.kept_share)) {
    in.fail("impossible shares");
  }
  return weigh;
}

void put_ref(ByteWriter& out, const SectionRef& ref) {
  put_file(out, ref.file);
  out.put(ref.section);
}

SectionRef get_ref(ByteReader& in) {
  FileRef file = get_file(in);
  return {std::move(file), in.get<FileSection>()};
}

void put_if_built(ByteWriter& out, const std::optional<BundlesOfMesh>& bundles) {
  out.put(static_cast<std::uint8_t>(bundles ? 1 : 0));
  if (bundles) put_bundles(out, *bundles);
}

std::optional<BundlesOfMesh> get_if_built(ByteReader& in) {
  const auto builds = in.get<std::uint8_t>();
  if (builds > 1) in.fail("impossible parts");
  if (builds == 0) return std::nullopt;
  return get_bundles(in);
}

void put_bound(ByteWriter& out, const SeamParameters& parameters) {
  out.put(static_cast<std::uint8_t>(parameters.bound ? 1 : 0));
  if (!parameters.bound) return;
  out.put(parameters.bound->max_error);
  out.put(parameters.bound->certified_error);
  for (const SeamParameters::Strip& strip : parameters.strips) {
    out.put(strip.mesh);
    out.put(strip.gap);
  }
  put_if_built(out, parameters.bound->bundles);
}

void get_bound(ByteReader& in, SeamParameters& parameters) {
  const auto is_bounded = in.get<std::uint8_t>();
  if (is_bounded > 1) in.fail("impossible bound");
  if (is_bounded == 0) return;
  GroupBound& bound = parameters.bound.emplace();
  bound.max_error = in.get<double>();
  bound.certified_error = in.get<double>();
  if (!(bound.max_error > 0 && bound.certified_error >= 0)) in.fail("impossible bound");
  for (SeamParameters::Strip& strip : parameters.strips) {
    strip.mesh = in.get<FileSection>();
    strip.gap = in.get<FileSection>();
  }
  bound.bundles = get_if_built(in);
}

}  // namespace

std::string encode_parameters(const SplitParameters& parameters) {
  ByteWriter out;
  begin_parameters(out);
  out.put(parameters.piece);
  out.put(parameters.rung);
  out.put(parameters.step);
  out.put(static_cast<std::uint8_t>(parameters.is_composed ? 1 : 0));
  put_ref(out, parameters.small_components);
  put_weigh(out, parameters.weigh);
  return out.take();
}

SplitParameters decode_split_parameters(std::string_view bytes) {
  ByteReader in(bytes, "parameters of a split job");
  expect_piece_version(in);
  SplitParameters parameters;
  parameters.piece = in.get<std::uint32_t>();
  parameters.rung = in.get<std::uint32_t>();
  parameters.step = in.get<std::int32_t>();
  parameters.is_composed = in.get<std::uint8_t>() != 0;
  parameters.small_components = get_ref(in);
  parameters.weigh = get_weigh(in);
  in.expect_end();
  return parameters;
}

std::string encode_parameters(const SeamParameters& parameters) {
  ByteWriter out;
  begin_parameters(out);
  out.put(static_cast<std::uint32_t>(parameters.strips.size()));
  for (const SeamParameters::Strip& strip : parameters.strips) {
    out.put(strip.parts);
    put_ref(out, strip.ref);
  }
  out.put(parameters.group);
  out.put(parameters.groups);
  out.put(parameters.all_parts);
  put_boundary(out, parameters.boundary);
  out.put(parameters.samples_per_triangle);
  put_weigh(out, parameters.weigh);
  put_bound(out, parameters);
  return out.take();
}

SeamParameters decode_seam_parameters(std::string_view bytes) {
  ByteReader in(bytes, "parameters of a seam job");
  expect_piece_version(in);
  SeamParameters parameters;
  std::uint64_t parts = 0;
  const auto strips = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < strips; ++i) {
    SeamParameters::Strip strip;
    strip.parts = in.get<std::uint32_t>();
    strip.ref = get_ref(in);
    parts += strip.parts;
    if (strip.parts == 0) in.fail("a piece of no parts");
    parameters.strips.push_back(std::move(strip));
  }
  parameters.group = in.get<std::uint32_t>();
  parameters.groups = in.get<std::uint32_t>();
  parameters.all_parts = in.get<std::uint32_t>();
  if (parts != parameters.all_parts || parameters.group >= parameters.groups) {
    in.fail("impossible parts");
  }
  parameters.boundary = get_boundary(in);
  parameters.samples_per_triangle = in.get<double>();
  const double samples = parameters.samples_per_triangle;
  if (!(samples >= 0 && samples <= k_most_piece_samples)) in.fail("too many samples");
  parameters.weigh = get_weigh(in);
  get_bound(in, parameters);
  in.expect_end();
  return parameters;
}

std::string encode_parameters(const ReduceParameters& parameters) {
  ByteWriter out;
  begin_parameters(out);
  out.put(parameters.rung);
  out.put(parameters.triangles);
  out.put(parameters.points);
  out.put(parameters.vertices);
  put(out, parameters.lines);
  return out.take();
}

ReduceParameters decode_reduce_parameters(std::string_view bytes) {
  ByteReader in(bytes, "parameters of a reduce job");
  expect_piece_version(in);
  ReduceParameters parameters;
  parameters.rung = in.get<std::uint32_t>();
  parameters.triangles = in.get<std::uint64_t>();
  parameters.points = in.get<std::uint64_t>();
  parameters.vertices = in.get<std::uint64_t>();
  parameters.lines = get_lines(in);
  in.expect_end();
  return parameters;
}

std::string encode_parameters(const WriteParameters& parameters) {
  ByteWriter out;
  begin_parameters(out);
  out.put(parameters.pieces);
  return out.take();
}

std::string encode_parameters(const MeasureParameters& parameters) {
  ByteWriter out;
  begin_parameters(out);
  out.put(parameters.first_part);
  out.put(parameters.end_part);
  out.put(parameters.triangles);
  out.put(parameters.share);
  out.put(parameters.shares);
  out.put(parameters.box);
  for (const SectionRef* ref :
       {&parameters.mesh, &parameters.samples, &parameters.gap, &parameters.between}) {
    put_ref(out, *ref);
  }
  out.put(static_cast<std::uint32_t>(parameters.seams.size()));
  for (const SeamSurface& each : parameters.seams) {
    put_ref(out, each.mesh);
    put_ref(out, each.gap);
  }
  out.put(static_cast<std::uint32_t>(parameters.points.size()));
  for (const SectionRef& ref : parameters.points) put_ref(out, ref);
  out.put(parameters.input_step);
  out.put(static_cast<std::uint8_t>(parameters.with_sides ? 1 : 0));
  put_if_built(out, parameters.bundles);
  for (const FileRef& part : parameters.parts) put_file(out, part);
  return out.take();
}

MeasureParameters decode_measure_parameters(std::string_view bytes) {
  ByteReader in(bytes, "parameters of a measure job");
  expect_piece_version(in);
  MeasureParameters parameters;
  parameters.first_part = in.get<std::uint32_t>();
  parameters.end_part = in.get<std::uint32_t>();
  parameters.triangles = in.get<std::uint64_t>();
  parameters.share = in.get<std::uint32_t>();
  parameters.shares = in.get<std::uint32_t>();
  parameters.box = in.get<Box>();
  for (SectionRef* ref :
       {&parameters.mesh, &parameters.samples, &parameters.gap, &parameters.between}) {
    *ref = get_ref(in);
  }
  const auto seams = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < seams; ++i) {
    SectionRef mesh = get_ref(in);
    parameters.seams.push_back({std::move(mesh), get_ref(in)});
  }
  const auto points = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < points; ++i) parameters.points.push_back(get_ref(in));
  parameters.input_step = in.get<std::uint64_t>();
  const auto with_sides = in.get<std::uint8_t>();
  parameters.with_sides = with_sides != 0;
  if (with_sides > 1 || parameters.share >= parameters.shares || parameters.input_step == 0 ||
      parameters.first_part > parameters.end_part || points == 0) {
    in.fail("impossible parts");
  }
  parameters.bundles = get_if_built(in);
  if (parameters.bundles) {
    if (parameters.end_part > parameters.bundles->parts) in.fail("no such parts");
  } else {
    for (std::uint32_t p = parameters.first_part; p < parameters.end_part; ++p) {
      parameters.parts.push_back(get_file(in));
    }
  }
  in.expect_end();
  return parameters;
}

std::string encode_summary(const DividedPiece& piece) {
  ByteWriter out;
  for (const FileSection& section :
       {piece.mesh, piece.gap, piece.strip, piece.samples, piece.fitting, piece.between}) {
    out.put(section);
  }
  for (const std::uint64_t count : {piece.gap_triangles, piece.strip_triangles, piece.shared}) {
    out.put(count);
  }
  out.put(piece.box);
  put_list(out, piece.rungs);
  out.put(piece.dropped_degenerate);
  out.put(piece.dropped_duplicate);
  out.put(piece.turned);
  out.put(piece.weight.before);
  out.put(piece.weight.first_step);
  put_list(out, piece.weight.counts);
  out.put(static_cast<std::uint8_t>(piece.weight.has_open_border ? 1 : 0));
  return out.take();
}

DividedPiece decode_divided_piece(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  DividedPiece piece;
  for (FileSection* section :
       {&piece.mesh, &piece.gap, &piece.strip, &piece.samples, &piece.fitting, &piece.between}) {
    *section = in.get<FileSection>();
  }
  for (std::uint64_t* count : {&piece.gap_triangles, &piece.strip_triangles, &piece.shared}) {
    *count = in.get<std::uint64_t>();
  }
  piece.box = in.get<Box>();
  piece.rungs = get_list<std::uint64_t>(in);
  piece.dropped_degenerate = in.get<std::uint64_t>();
  piece.dropped_duplicate = in.get<std::uint64_t>();
  piece.turned = in.get<std::uint64_t>();
  piece.weight.before = in.get<std::uint64_t>();
  piece.weight.first_step = in.get<std::int32_t>();
  piece.weight.counts = get_list<std::uint64_t>(in);
  piece.weight.has_open_border = in.get<std::uint8_t>() != 0;
  std::uint64_t before = piece.weight.before;
  for (const std::uint64_t count : piece.weight.counts) {
    if (count > before) in.fail("counts do not fall");
    before = count;
  }
  if (piece.rungs.empty() || piece.weight.first_step < 0) in.fail("not weighed");
  in.expect_end();
  return piece;
}

std::string encode_summary(const FinishedPiece& piece) {
  ByteWriter out;
  out.put(piece.mesh);
  out.put(piece.points);
  out.put(piece.by_area);
  out.put(piece.area);
  out.put(piece.vertices);
  out.put(piece.triangles);
  return out.take();
}

FinishedPiece decode_finished_piece(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  FinishedPiece piece;
  piece.mesh = in.get<FileSection>();
  piece.points = in.get<FileSection>();
  piece.by_area = in.get<std::uint64_t>();
  piece.area = in.get<double>();
  piece.vertices = in.get<std::uint64_t>();
  piece.triangles = in.get<std::uint64_t>();
  if (!(piece.area >= 0 && std::isfinite(piece.area))) in.fail("impossible area");
  in.expect_end();
  return piece;
}

std::string encode_summary(const PieceError& error) {
  ByteWriter out;
  out.put(error.input_area);
  out.put(error.to_output);
  out.put(error.input_samples);
  return out.take();
}

PieceError decode_piece_error(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  PieceError error;
  error.input_area = in.get<double>();
  error.to_output = in.get<Distance>();
  error.input_samples = in.get<std::uint64_t>();
  in.expect_end();
  return error;
}

std::string encode_points(const MeasuredPoints& points) {
  ByteWriter out;
  out.put(static_cast<std::uint32_t>(points.to_input.size()));
  for (const std::vector<double>& each : points.to_input) put_list(out, each);
  put_list(out, points.to_output);
  put_list(out, points.areas);
  return out.take();
}

MeasuredPoints decode_measured_points(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  MeasuredPoints points;
  const auto lists = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < lists; ++i) points.to_input.push_back(get_list<double>(in));
  points.to_output = get_list<double>(in);
  points.areas = get_list<double>(in);
  if (points.areas.size() != points.to_output.size()) in.fail("not each point has an area");
  in.expect_end();
  return points;
}

}  // namespace meshfarm
