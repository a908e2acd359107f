// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/pieces_output.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <meshfarm/io/result_file.hpp>
#include <meshfarm/staging/sections.hpp>
#include <meshfarm/util/byte_lists.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/piece_sections.hpp"

namespace meshfarm {
namespace {

/// Each mesh is read for its vertices, and again for its triangles.
constexpr std::uint64_t k_times_read = 2;

std::string read_of(const Stage& stage, const FileRef& file, const FileSection& section) {
  return SectionedFile(stage, file).read(section);
}

class PiecesWriter {
 public:
  PiecesWriter(const Stage& stage, const FinishedPieces& result, MeshSink& sink)
      : stage_(stage), result_(result), sink_(sink) {
    std::uint64_t next = 0;
    for (const PieceOfResult& each : result.pieces) {
      first_vertex_.push_back(next);
      if (each.parts == 0) add_shared(each, next);
      next += each.finished.vertices;
    }
    std::sort(shared_.begin(), shared_.end());
  }

  void write(const std::function<void()>& check_stop) {
    for (std::size_t i = 0; i < result_.pieces.size(); ++i) {
      check_stop();
      vertices(i);
    }
    for (std::size_t i = 0; i < result_.pieces.size(); ++i) {
      check_stop();
      triangles(i);
    }
  }

 private:
  void vertices(std::size_t piece) { sink_.vertices(mesh_of(piece).mesh.positions); }

  /// Writes the mesh, then the gap to the surroundings or to other groups of them.
  void triangles(std::size_t i) {
    const PieceOfResult& piece = result_.pieces[i];
    const ResultMesh mesh = mesh_of(i);
    put(mesh.mesh.triangles, mesh.mesh.columns,
        [&](std::uint32_t v) { return first_vertex_[i] + v; });
    const std::uint32_t locked = mesh.boundary_vertices;
    PieceGap gap =
        decode_gap(read_of(stage_, piece.divided_file, piece.divided.gap), piece.divided_file.name);
    if (gap.triangles.size() < piece.divided.gap_triangles) {
      throw DataError(piece.divided_file.name + ": has other triangles than its summary says");
    }
    gap.triangles.resize(piece.divided.gap_triangles);
    gap.columns.resize(piece.divided.gap_triangles);
    put(gap.triangles, gap.columns, [&](std::uint32_t v) {
      return v < locked ? first_vertex_[i] + v : place_of(gap, v - locked, piece.divided_file.name);
    });
  }

  /// A vertex that groups share, and its number in the result.
  using SharedPlace = std::pair<SeamVertex, std::uint64_t>;

  void add_shared(const PieceOfResult& group, std::uint64_t first) {
    const std::string& name = group.divided_file.name;
    for (const SeamVertex& each :
         decode_list<SeamVertex>(read_of(stage_, group.divided_file, group.divided.strip), name)) {
      shared_.emplace_back(each, first++);
    }
  }

  std::uint64_t place_of(const PieceGap& gap, std::uint32_t v, const std::string& what) const {
    if (v < gap.vertices.size()) {
      const auto at =
          std::lower_bound(shared_.begin(), shared_.end(), SharedPlace(gap.vertices[v], 0));
      if (at != shared_.end() && at->first == gap.vertices[v]) return at->second;
    }
    throw DataError(what + ": a gap names a vertex that is not there");
  }

  ResultMesh mesh_of(std::size_t i) const {
    const PieceOfResult& piece = result_.pieces[i];
    ResultMesh mesh = decode_result(read_of(stage_, piece.finished_file, piece.finished.mesh), 0,
                                    piece.finished_file.name);
    if (mesh.mesh.positions.size() != piece.finished.vertices) {
      throw DataError(piece.finished_file.name + ": has other vertices than its summary says");
    }
    return mesh;
  }

  template <class Number>
  void put(const std::vector<Triangle>& triangles, const TriangleColumnsView& columns,
           const Number& number) {
    constexpr std::size_t k_put_at_once = 65'536;
    std::vector<WideTriangle> wide;
    for (std::size_t first = 0; first < triangles.size(); first += k_put_at_once) {
      const std::size_t end = std::min(triangles.size(), first + k_put_at_once);
      wide.clear();
      for (std::size_t i = first; i < end; ++i) {
        const auto& [a, b, c] = triangles[i];
        wide.push_back({number(a), number(b), number(c)});
      }
      sink_.triangles(TriangleView{wide, columns.part(first, end - first)});
    }
  }

  const Stage& stage_;
  const FinishedPieces& result_;
  MeshSink& sink_;
  std::vector<std::uint64_t> first_vertex_;
  std::vector<SharedPlace> shared_;  // ascending
};

/// Collects everything in memory.
class MeshInMemory : public MeshSink {
 public:
  void vertices(std::span<const Vec3> batch) override {
    mesh_.positions.insert(mesh_.positions.end(), batch.begin(), batch.end());
  }
  void vertices(std::span<const Vec3> batch, std::span<const float> /*values*/) override {
    vertices(batch);
  }
  void triangles(const TriangleView& batch) override {
    for (const auto& [a, b, c] : batch.corners) {
      mesh_.triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                                 static_cast<std::uint32_t>(c)});
    }
    mesh_.columns.append(batch.columns);
  }
  void triangles(std::span<const Triangle> batch, const TriangleColumnsView& columns) override {
    mesh_.triangles.insert(mesh_.triangles.end(), batch.begin(), batch.end());
    mesh_.columns.append(columns);
  }
  void commit() override {}
  void reserve(const FinishedPieces& result) {
    mesh_.positions.reserve(result.vertices());
    mesh_.triangles.reserve(result.triangles());
  }
  Mesh take() { return std::move(mesh_); }

 private:
  Mesh mesh_;
};

}  // namespace

Job write_job(const FinishedPieces& result) {
  ByteWriter pieces;
  Job job;
  for (const PieceOfResult& each : result.pieces) {
    pieces.put(each.divided_file.hash);
    pieces.put(each.finished_file.hash);
    job.reads += k_times_read * each.finished.mesh.size + each.divided.gap.size;
  }
  job.kind = k_write_kind;
  job.parameters = encode_parameters(WriteParameters{checksum(pieces.bytes())});
  job.by_sink = true;
  job.cost = result.triangles();
  return job;
}

JobOutput publish_counts(const FinishedPieces& result, const Job& job, const JobContext& context) {
  ByteWriter counts;
  counts.put(result.vertices());
  counts.put(result.triangles());
  const ResultName name{key_of(job).value, context.attempt, context.incarnation};
  return {context.publish(name, counts.bytes()), {}};
}

std::unique_ptr<MeshSink> write_pieces(const Stage& stage, const Manifest& manifest,
                                       const FinishedPieces& result, const MeshOutput& output,
                                       const std::function<void()>& check_stop) {
  auto sink = create_mesh(output, {.vertices = result.vertices(),
                                   .triangles = result.triangles(),
                                   .positions = manifest.positions,
                                   .comment = {},
                                   .packing = output.packing});
  PiecesWriter(stage, result, *sink).write(check_stop);
  return sink;
}

Mesh mesh_of_pieces(const Stage& stage, const FinishedPieces& result,
                    const std::function<void()>& check_stop) {
  if (result.vertices() > UINT32_MAX) {
    throw DataError("a result of " + std::to_string(result.vertices()) +
                    " vertices is too large for its colours or textures: ask for fewer triangles, "
                    "or leave them out with --attributes none");
  }
  MeshInMemory mesh;
  mesh.reserve(result);
  PiecesWriter(stage, result, mesh).write(check_stop);
  return mesh.take();
}

}  // namespace meshfarm
