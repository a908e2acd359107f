// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A simplified part, kind "RSLT", version 1; the payload of a sealed file:
//   position type u8 | boundary vertices u32 | rungs u32 |
//   rungs x (level i32 | vertices u64 | triangles u64 | free triangles u64 | error f64) |
//   rungs x (positions | triangles)            as in a part, finest rung first
//   area of the part f64 | samples u64 | samples, 3 numbers each, of the part's surface
// The summary that travels with the message:
//   dropped degenerate u64 | dropped duplicate u64 | rungs u32 | rungs as above
#include <cmath>

#include <meshfarm/io/result_file.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

#include "io/part_mesh.hpp"

namespace meshfarm {
namespace {

constexpr FileKind k_kind = {'R', 'S', 'L', 'T'};
constexpr std::uint32_t k_version = 1;
constexpr std::uint32_t k_max_rungs = 256;

void put_rungs(ByteWriter& out, const std::vector<Rung>& rungs) {
  out.put(static_cast<std::uint32_t>(rungs.size()));
  for (const Rung& rung : rungs) {
    out.put(rung.level);
    out.put(rung.vertices);
    out.put(rung.triangles);
    out.put(rung.free_triangles);
    out.put(rung.error);
  }
}

std::vector<Rung> get_rungs(ByteReader& in) {
  const auto count = in.get<std::uint32_t>();
  if (count == 0 || count > k_max_rungs) in.fail("impossible number of rungs");
  std::vector<Rung> rungs;
  for (std::uint32_t i = 0; i < count; ++i) {
    Rung rung;
    rung.level = in.get<std::int32_t>();
    rung.vertices = in.get<std::uint64_t>();
    rung.triangles = in.get<std::uint64_t>();
    rung.free_triangles = in.get<std::uint64_t>();
    rung.error = in.get<double>();
    if (!std::isfinite(rung.error) || rung.error < 0) in.fail("impossible error");
    if (rung.free_triangles > rung.triangles) in.fail("more free triangles than triangles");
    if (i > 0 && (rung.level <= rungs.back().level || rung.triangles > rungs.back().triangles)) {
      in.fail("rungs out of order");
    }
    rungs.push_back(rung);
  }
  return rungs;
}

std::uint64_t mesh_bytes(const Rung& rung, PositionType positions) {
  return rung.vertices * 3 * static_cast<std::uint64_t>(positions) +
         rung.triangles * sizeof(Triangle);
}

}  // namespace

std::string encode_summary(const ResultSummary& summary) {
  ByteWriter out;
  out.put(summary.dropped_degenerate);
  out.put(summary.dropped_duplicate);
  put_rungs(out, summary.rungs);
  return out.take();
}

ResultSummary decode_summary(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  ResultSummary summary;
  summary.dropped_degenerate = in.get<std::uint64_t>();
  summary.dropped_duplicate = in.get<std::uint64_t>();
  summary.rungs = get_rungs(in);
  in.expect_end();
  return summary;
}

void ResultEncoder::add(std::int32_t level, const Mesh& mesh, std::uint64_t free_triangles,
                        double error) {
  rungs_.push_back({level, mesh.positions.size(), mesh.triangles.size(), free_triangles, error});
  ByteWriter out;
  put_mesh(out, mesh, positions_);
  meshes_ += out.bytes();
}

std::string ResultEncoder::finish() const {
  ByteWriter out;
  out.put(positions_);
  out.put(boundary_vertices_);
  put_rungs(out, rungs_);
  out.put_array(std::span<const char>(meshes_));
  out.put(samples_.area);
  out.put(static_cast<std::uint64_t>(samples_.points.size()));
  put_positions(out, samples_.points, positions_);
  return seal(k_kind, k_version, out.bytes());
}

ResultMesh decode_result(std::string_view file, std::size_t rung, std::string_view what) {
  ByteReader in(unseal(file, k_kind, k_version, what), what);
  const PositionType positions = get_position_type(in);
  ResultMesh result;
  result.boundary_vertices = in.get<std::uint32_t>();
  const std::vector<Rung> rungs = get_rungs(in);
  if (rung >= rungs.size()) in.fail("no such rung");
  for (std::size_t i = 0; i < rungs.size(); ++i) {
    const Rung& r = rungs[i];
    if (r.vertices > in.remaining() || r.triangles > in.remaining()) in.fail("cut short");
    if (result.boundary_vertices > r.vertices) in.fail("more boundary vertices than vertices");
    if (i == rung) {
      result.mesh = get_mesh(in, r.vertices, r.triangles, positions);
    } else {
      in.take(mesh_bytes(r, positions));
    }
  }
  result.samples.area = in.get<double>();
  if (!std::isfinite(result.samples.area) || result.samples.area < 0) in.fail("impossible area");
  const auto samples = in.get<std::uint64_t>();
  result.samples.points = get_positions(in, samples, positions);
  in.expect_end();
  return result;
}

}  // namespace meshfarm
