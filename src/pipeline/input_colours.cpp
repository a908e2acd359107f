// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/input_colours.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/parallel.hpp>

namespace meshfarm {
namespace {

/// Of the gap between two boxes.
double squared_gap(const Box& a, const Box& b) {
  if (a.empty() || b.empty()) return HUGE_VAL;
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double gap = std::max({0.0, a.lo[k] - b.hi[k], b.lo[k] - a.hi[k]});
    sum += gap * gap;
  }
  return sum;
}

Vec3 normal_of(const Mesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
}

double area_of(const Mesh& mesh, std::uint32_t triangle) {
  return 0.5 * length(normal_of(mesh, triangle));
}

Box box_of(std::span<const Vec3> points) {
  Box box;
  for (const Vec3& p : points) box.add(p);
  return box;
}

}  // namespace

InputColours::InputColours(const Stage& stage, const Manifest& manifest,
                           const MaterialColours& materials, const Options& options)
    : stage_(stage),
      manifest_(manifest),
      materials_(materials),
      options_(options),
      boxes_(manifest.parts.size() + 1),
      boundary_(manifest.parts.size()),
      kept_(boxes_.size()),
      used_(boxes_.size(), 0) {
  parallel_for(manifest_.parts.size(), options_.threads, [&](std::uint64_t part) {
    Mesh mesh = read_part(part);
    const auto boundary = static_cast<std::ptrdiff_t>(manifest_.parts[part].boundary_vertices);
    boundary_[part].assign(mesh.positions.begin(), mesh.positions.begin() + boundary);
    boxes_[part] = box_of(mesh.positions);
    if (mesh.triangles.empty()) boxes_[part] = {};
    if (boxes_[part].empty()) return;
    const std::shared_ptr<Piece> piece = made(std::move(mesh));
    const std::lock_guard lock(mutex_);
    if (bytes_ + piece->bytes <= options_.memory_bytes) keep(part, piece);
  });
  // The triangles between parts are few: they stay.
  Mesh between = read_between();
  boxes_.back() = box_of(between.positions);
  if (!boxes_.back().empty()) kept_.back() = made(std::move(between));
}

Mesh InputColours::read_part(std::size_t part) const {
  const FileRef& file = manifest_.parts[part].file;
  const std::string bytes = stage_.read(file);
  Part read;
  if (is_stream(bytes)) {
    StreamReader reader(fill_from(bytes, file.name), file.name);
    read = read_stream(reader);
  } else {
    read = decode_part(bytes, file.name);
  }
  if (read.boundary_vertices != manifest_.parts[part].boundary_vertices ||
      !TriangleColumnsView(read.mesh.columns).fits({true, true}, read.mesh.triangles.size())) {
    throw DataError(file.name + ": is not the part that the manifest tells of");
  }
  return std::move(read.mesh);
}

Mesh InputColours::read_between() const {
  Mesh mesh;
  const auto triangles =
      decode_boundary(stage_.read(manifest_.boundary), manifest_.boundary.name, mesh.columns);
  for (const BoundaryTriangle& t : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const BoundaryCorner& corner : t) {
      if (corner.part >= boundary_.size() || corner.local >= boundary_[corner.part].size()) {
        throw DataError("a boundary triangle names a vertex that is not there; cut the mesh again");
      }
      mesh.positions.push_back(boundary_[corner.part][corner.local]);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

std::shared_ptr<InputColours::Piece> InputColours::made(Mesh mesh) const {
  constexpr std::uint64_t k_bytes_of_places = 20;
  auto piece = std::make_shared<Piece>();
  piece->mesh = std::move(mesh);
  const Mesh& made = piece->mesh;
  piece->places.emplace(made, SurfacePlacesOptions{.reach = options_.reach, .threads = 1});
  piece->bytes =
      made.positions.size() * sizeof(Vec3) +
      made.triangles.size() * (sizeof(Triangle) + made.columns.set().bytes() + k_bytes_of_places);
  return piece;
}

/// The mutex must be held.
void InputColours::keep(std::size_t number, const PiecePointer& piece) {
  kept_[number] = piece;
  used_[number] = ++uses_;
  bytes_ += piece->bytes;
}

InputColours::PiecePointer InputColours::piece(std::size_t number) {
  {
    const std::lock_guard lock(mutex_);
    used_[number] = ++uses_;
    if (kept_[number]) return kept_[number];
  }
  const std::shared_ptr<Piece> read = made(read_part(number));
  const std::lock_guard lock(mutex_);
  if (kept_[number]) return kept_[number];  // another thread was faster
  while (bytes_ + read->bytes > options_.memory_bytes) {
    // The one that has not been used for longest. The last is what is between parts.
    std::size_t oldest = SIZE_MAX;
    for (std::size_t i = 0; i + 1 < kept_.size(); ++i) {
      if (kept_[i] && (oldest == SIZE_MAX || used_[i] < used_[oldest])) oldest = i;
    }
    if (oldest == SIZE_MAX) break;
    bytes_ -= kept_[oldest]->bytes;
    kept_[oldest].reset();
  }
  keep(number, read);
  return read;
}

std::vector<std::size_t> InputColours::pieces_by_distance(const Box& box) const {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    if (!boxes_[i].empty()) order.emplace_back(squared_gap(boxes_[i], box), i);
  }
  std::sort(order.begin(), order.end());
  std::vector<std::size_t> pieces;
  pieces.reserve(order.size());
  for (const auto& [gap, number] : order) pieces.push_back(number);
  return pieces;
}

BakedColour InputColours::colour_at(const Piece& piece, const SurfacePlace& place) const {
  const Label label = piece.mesh.columns.labels[place.triangle];
  const CornerUvs& uvs = piece.mesh.columns.uvs[place.triangle];
  const double area = area_of(piece.mesh, place.triangle);
  const double per_area = area > 0 ? materials_.texels_of(label, uvs) / area : 0;
  const double texels = options_.spacing * std::sqrt(per_area);
  return materials_.at(label, blended(place, uvs[0], uvs[1], uvs[2]), texels);
}

void InputColours::find(std::span<const Vec3> points, std::span<const Vec3> normals,
                        std::span<BakedColour> colours) {
  const double squared_reach = options_.reach * options_.reach;
  std::vector<Best> best(points.size(), Best{HUGE_VAL, false, {}});
  std::vector<std::size_t> asked;  // the points that a piece may be nearest to
  std::vector<Vec3> asked_points;
  std::vector<Vec3> asked_normals;
  std::vector<SurfacePlace> places;
  for (const std::size_t number : pieces_by_distance(box_of(points))) {
    asked.clear();
    asked_points.clear();
    asked_normals.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double could_be =
          best[i].faces ? best[i].squared : std::max(best[i].squared, squared_reach);
      if (squared_gap(boxes_[number], box_of(points.subspan(i, 1))) > could_be) continue;
      asked.push_back(i);
      asked_points.push_back(points[i]);
      asked_normals.push_back(normals[i]);
    }
    if (asked.empty()) continue;
    const PiecePointer found = piece(number);
    places.resize(asked.size());
    found->places->find(asked_points, asked_normals, places);
    for (std::size_t k = 0; k < asked.size(); ++k) {
      Best& of_point = best[asked[k]];
      const SurfacePlace& place = places[k];
      const bool faces = place.squared <= squared_reach &&
                         dot(normal_of(found->mesh, place.triangle), asked_normals[k]) > 0;
      const bool is_better = faces != of_point.faces ? faces : place.squared < of_point.squared;
      if (is_better) of_point = {place.squared, faces, colour_at(*found, place)};
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) colours[i] = best[i].colour;
}

}  // namespace meshfarm
