// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Components to leave out may span pieces. For these a piece only records which of its boundary
// vertices they connect, and their boxes, so only one piece is in memory at a time.
//
// Parameters, version 3 (version 1 had one boundary file, version 2 whole files), and summary,
// little endian:
//   components = version u8 | pieces u32 x (parts u32 | rung u32 | file | section | section) |
//                all parts u32 | boundary | diagonal f64
//   small      = pieces u32 x section | components u64 | triangles u64
#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <meshfarm/geometry/components.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/piece_jobs.hpp>
#include <meshfarm/staging/file_ref.hpp>
#include <meshfarm/stitch/stitcher.hpp>
#include <meshfarm/util/byte_lists.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

#include "pipeline/piece_sections.hpp"

namespace meshfarm {
namespace {

constexpr std::uint8_t k_components_version = 3;

struct ComponentSize {
  Box box;
  std::uint64_t triangles = 0;

  void add(const Mesh& mesh, const Triangle& t) {
    for (const std::uint32_t v : t) box.add(mesh.positions[v]);
    ++triangles;
  }
  void add(const ComponentSize& more) {
    if (more.triangles == 0) return;
    box.add(more.box.lo);
    box.add(more.box.hi);
    triangles += more.triangles;
  }
  bool is_below(double diagonal) const { return triangles > 0 && box.diagonal() < diagonal; }
};

/// Takes the pieces one after the other, and keeps only what concerns their boundary vertices.
class ComponentFinder {
 public:
  explicit ComponentFinder(const ComponentsParameters& parameters)
      : parameters_(parameters), stitcher_(parameters.all_parts) {}

  void add(ResultMesh piece, std::uint32_t parts) {
    const Mesh& mesh = piece.mesh;
    const std::vector<std::uint32_t> lowest =
        lowest_connected(mesh.positions.size(), mesh.triangles);
    std::vector<ComponentSize> sizes(lowest.size());
    for (const Triangle& t : mesh.triangles) sizes[lowest[t[0]]].add(mesh, t);
    std::vector<std::uint32_t>& dropped = dropped_.emplace_back();
    first_.push_back(open_.size());
    std::vector<std::uint32_t> open(lowest.size(), k_closed);
    for (std::uint32_t v = 0; v < piece.boundary_vertices; ++v) {
      const auto number = static_cast<std::uint32_t>(open_.size());
      std::uint32_t& first = open[lowest[v]];
      open_.push_back({lowest[v], first == k_closed ? sizes[lowest[v]] : ComponentSize{}});
      if (first == k_closed) first = number;
      links_.push_back({first, number, number});
    }
    for (std::uint32_t v = 0; v < sizes.size(); ++v) {
      if (open[v] == k_closed && drops(sizes[v])) dropped.push_back(v);
    }
    piece.mesh.positions.resize(piece.boundary_vertices);
    piece.mesh.triangles.clear();
    piece.mesh.appearances.clear();
    piece.mesh.columns.clear();
    stitcher_.add(piece, parts);
  }

  /// For each piece the components to drop, by their lowest vertices.
  std::vector<std::vector<std::uint32_t>> finish(std::span<const BoundaryTriangle> boundary) {
    const StitchedMesh stitched = stitcher_.finish(boundary);
    const Mesh& seams = stitched.mesh;
    links_.insert(links_.end(), seams.triangles.begin(), seams.triangles.end());
    const std::vector<std::uint32_t> lowest = lowest_connected(open_.size(), links_);
    std::vector<ComponentSize> sizes(open_.size());
    for (std::size_t i = 0; i < open_.size(); ++i) sizes[lowest[i]].add(open_[i].size);
    for (const Triangle& t : seams.triangles) sizes[lowest[t[0]]].add(seams, t);
    std::vector<std::uint8_t> is_dropped(sizes.size(), 0);
    for (std::size_t i = 0; i < sizes.size(); ++i) is_dropped[i] = drops(sizes[i]) ? 1 : 0;
    for (std::size_t piece = 0; piece < dropped_.size(); ++piece) {
      const std::size_t end = piece + 1 < first_.size() ? first_[piece + 1] : open_.size();
      std::vector<std::uint32_t>& dropped = dropped_[piece];
      for (std::size_t i = first_[piece]; i < end; ++i) {
        if (is_dropped[lowest[i]] != 0) dropped.push_back(open_[i].lowest);
      }
      std::sort(dropped.begin(), dropped.end());
      dropped.erase(std::unique(dropped.begin(), dropped.end()), dropped.end());
    }
    return std::move(dropped_);
  }

  const DroppedComponents& sum() const { return sum_; }

 private:
  static constexpr std::uint32_t k_closed = UINT32_MAX;

  /// A boundary vertex, and its component in the piece.
  struct OpenVertex {
    std::uint32_t lowest = 0;
    ComponentSize size;  // stored at the component's first vertex
  };

  bool drops(const ComponentSize& size) {
    if (!size.is_below(parameters_.diagonal)) return false;
    ++sum_.components;
    sum_.triangles += size.triangles;
    return true;
  }

  const ComponentsParameters& parameters_;
  Stitcher stitcher_;
  std::vector<OpenVertex> open_;
  std::vector<std::size_t> first_;  // the first open vertex of each piece
  std::vector<Triangle> links_;     // between open vertices
  std::vector<std::vector<std::uint32_t>> dropped_;
  DroppedComponents sum_;
};

}  // namespace

std::string encode_parameters(const ComponentsParameters& parameters) {
  ByteWriter out;
  out.put(k_components_version);
  out.put(static_cast<std::uint32_t>(parameters.pieces.size()));
  for (const ComponentsParameters::Piece& piece : parameters.pieces) {
    out.put(piece.parts);
    out.put(piece.rung);
    put_file(out, piece.file);
    out.put(piece.mesh);
    out.put(piece.tail);
  }
  out.put(parameters.all_parts);
  put_boundary(out, parameters.boundary);
  out.put(parameters.diagonal);
  return out.take();
}

ComponentsParameters decode_components_parameters(std::string_view bytes) {
  ByteReader in(bytes, "parameters of a components job");
  if (in.get<std::uint8_t>() != k_components_version)
    in.fail("made by another version of meshfarm");
  ComponentsParameters parameters;
  std::uint64_t parts = 0;
  const auto pieces = in.get<std::uint32_t>();
  for (std::uint32_t i = 0; i < pieces; ++i) {
    ComponentsParameters::Piece piece;
    piece.parts = in.get<std::uint32_t>();
    piece.rung = in.get<std::uint32_t>();
    piece.file = get_file(in);
    piece.mesh = in.get<FileSection>();
    piece.tail = in.get<FileSection>();
    parts += piece.parts;
    if (piece.parts == 0) in.fail("a piece of no parts");
    parameters.pieces.push_back(std::move(piece));
  }
  parameters.all_parts = in.get<std::uint32_t>();
  if (parts != parameters.all_parts) in.fail("impossible parts");
  parameters.boundary = get_boundary(in);
  parameters.diagonal = in.get<double>();
  if (!(parameters.diagonal > 0)) in.fail("impossible diagonal");
  in.expect_end();
  return parameters;
}

std::string encode_summary(const SmallComponents& components) {
  ByteWriter out;
  put_list(out, components.pieces);
  out.put(components.dropped.components);
  out.put(components.dropped.triangles);
  return out.take();
}

SmallComponents decode_small_components(std::string_view bytes, std::string_view what) {
  ByteReader in(bytes, what);
  SmallComponents components;
  components.pieces = get_list<FileSection>(in);
  components.dropped.components = in.get<std::uint64_t>();
  components.dropped.triangles = in.get<std::uint64_t>();
  in.expect_end();
  return components;
}

JobOutput find_small_components(const Job& job, const JobContext& context) {
  const ComponentsParameters parameters = decode_components_parameters(job.parameters);
  ComponentFinder finder(parameters);
  for (const ComponentsParameters::Piece& each : parameters.pieces) {
    ResultMesh piece =
        decode_rung(context.stage.read(each.file, each.mesh),
                    context.stage.read(each.file, each.tail), each.rung, each.file.name);
    const std::size_t triangles = piece.mesh.triangles.size();
    finder.add(std::move(piece), each.parts);
    if (!context.progress(triangles)) throw IncompleteError("the job was given up");
  }
  const auto dropped = finder.finish(read_boundary(context.stage, parameters.boundary));
  std::string file;
  SectionWriter sections([&](std::string_view bytes) { file += bytes; });
  SmallComponents made;
  made.dropped = finder.sum();
  for (const std::vector<std::uint32_t>& each : dropped) {
    made.pieces.push_back(sections.add(encode_list(each)));
  }
  const ResultName name{key_of(job).value, context.attempt, context.incarnation};
  return {context.publish(name, file), encode_summary(made)};
}

}  // namespace meshfarm
