// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/input_colours.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <meshfarm/io/part_file.hpp>
#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// The squared gap between two boxes.
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

InputColours::InputColours(const Input& input, const ColumnSet& columns, std::uint64_t memory_bytes)
    : input_(input), columns_(columns), room_(memory_bytes) {
  for (const BakePart& part : input_.scene.parts) boxes_.push_back(part.box);
  for (const BakeSeam& seam : input_.scene.seams) boxes_.push_back(seam.box);
  kept_.resize(boxes_.size());
}

Mesh InputColours::read(std::size_t number) const {
  const std::vector<BakePart>& parts = input_.scene.parts;
  const bool is_part = number < parts.size();
  const std::string name = is_part ? parts[number].file.name : "what is between the parts";
  const std::string bytes =
      is_part ? input_.stage.read(parts[number].file)
              : input_.file.read(input_.scene.seams[number - parts.size()].section);
  Part part = decode_part_or_stream(bytes, name);
  const std::uint32_t boundary = is_part ? parts[number].boundary_vertices : 0;
  if (part.boundary_vertices != boundary ||
      !TriangleColumnsView(part.mesh.columns).fits(columns_, part.mesh.triangles.size())) {
    throw DataError(name + ": is not the part that it is said to be");
  }
  return std::move(part.mesh);
}

const InputColours::Piece& InputColours::piece(std::size_t number) {
  constexpr std::uint64_t k_bytes_of_places = 20;
  if (!kept_[number]) {
    auto piece = std::make_unique<Piece>();
    piece->mesh = read(number);
    const Mesh& mesh = piece->mesh;
    piece->bytes =
        mesh.positions.size() * sizeof(Vec3) +
        mesh.triangles.size() * (sizeof(Triangle) + columns_.bytes() + k_bytes_of_places);
    while (bytes_ > 0 && bytes_ + piece->bytes > room_) forget_oldest();
    piece->places.emplace(mesh, SurfacePlacesOptions{.reach = input_.scene.reach, .threads = 1});
    bytes_ += piece->bytes;
    kept_[number] = std::move(piece);
  }
  kept_[number]->used = ++uses_;
  return *kept_[number];
}

void InputColours::forget_oldest() {
  std::unique_ptr<Piece>* oldest = nullptr;
  for (std::unique_ptr<Piece>& each : kept_) {
    if (each && (oldest == nullptr || each->used < (*oldest)->used)) oldest = &each;
  }
  bytes_ -= (*oldest)->bytes;
  oldest->reset();
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
  const MaterialColours& materials = input_.materials;
  const double per_area = area > 0 ? materials.texels_of(label, uvs) / area : 0;
  const double texels = input_.scene.spacing * std::sqrt(per_area);
  return materials.at(label, blended(place, uvs[0], uvs[1], uvs[2]), texels);
}

void InputColours::find(std::span<const Vec3> points, std::span<const Vec3> normals,
                        std::span<BakedColour> colours) {
  const double squared_reach = input_.scene.reach * input_.scene.reach;
  std::vector<Best> best(points.size(), Best{HUGE_VAL, false, {}});
  std::vector<std::size_t> asked;  // the points that may be nearest to this piece
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
    const Piece& found = piece(number);
    places.resize(asked.size());
    found.places->find(asked_points, asked_normals, places);
    for (std::size_t k = 0; k < asked.size(); ++k) {
      Best& of_point = best[asked[k]];
      const SurfacePlace& place = places[k];
      const bool faces = place.squared <= squared_reach &&
                         dot(normal_of(found.mesh, place.triangle), asked_normals[k]) > 0;
      const bool is_better = faces != of_point.faces ? faces : place.squared < of_point.squared;
      if (is_better) of_point = {place.squared, faces, colour_at(found, place)};
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) colours[i] = best[i].colour;
}

}  // namespace meshfarm
