// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "divide/boundary_numbers.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

#include <meshfarm/util/byte_lists.hpp>
#include <meshfarm/util/bytes.hpp>

#include "divide/seam_vertices.hpp"
#include "divide/vertex_sort.hpp"

namespace meshfarm {

std::uint32_t BoundaryNumbers::count() const {
  return numbers.empty() ? 0 : *std::max_element(numbers.begin(), numbers.end()) + 1;
}

std::vector<std::uint32_t> boundary_places(std::vector<std::uint32_t> boundary) {
  std::sort(boundary.begin(), boundary.end());
  boundary.erase(std::unique(boundary.begin(), boundary.end()), boundary.end());
  return boundary;
}

BoundaryNumbers number_as_they_are(const MeshShare& raw) {
  BoundaryNumbers made;
  made.places = boundary_places(raw.boundary);
  made.numbers.resize(made.places.size());
  std::iota(made.numbers.begin(), made.numbers.end(), 0U);
  return made;
}

BoundaryNumbers number_boundary(const MeshShare& raw, const Sorting& sorting) {
  BoundaryNumbers made;
  made.places = boundary_places(raw.boundary);
  std::vector<Vec3> positions;
  positions.reserve(made.places.size());
  for (const std::uint32_t place : made.places) positions.push_back(raw.positions[place]);
  std::vector<std::uint32_t> sorted = sorted_vertices(positions, sorting.order, raw.type);
  if (sorted.empty()) {
    sorted.resize(positions.size());
    std::iota(sorted.begin(), sorted.end(), 0U);
  }
  const bool welds = sorting.weld == Weld::exact;
  made.numbers.resize(made.places.size());
  if (!raw.apart.empty()) made.points.resize(made.places.size());
  std::uint32_t count = 0;
  for (std::size_t begin = 0, end = 0; begin < sorted.size(); begin = end) {
    while (end < sorted.size() && positions[sorted[begin]] == positions[sorted[end]]) ++end;
    const auto sheet = [&](std::uint32_t i) { return sheet_of(made.places[i], raw.apart); };
    const std::span<std::uint32_t> point = std::span(sorted).subspan(begin, end - begin);
    if (point.size() > 1 && !raw.apart.empty()) {
      std::stable_sort(point.begin(), point.end(),
                       [&](std::uint32_t a, std::uint32_t b) { return sheet(a) < sheet(b); });
    }
    for (std::size_t i = 0; i < point.size(); ++i) {
      if (i == 0 || !welds || sheet(point[i - 1]) != sheet(point[i])) ++count;
      made.numbers[point[i]] = count - 1;
      if (!raw.apart.empty()) made.points[point[i]] = point[0];
    }
  }
  return made;
}

std::string encode_numbers(const BoundaryNumbers& numbers) {
  ByteWriter out;
  put_list(out, numbers.places);
  put_list(out, numbers.numbers);
  put_list(out, numbers.points);
  return out.take();
}

BoundaryNumbers decode_numbers(std::string_view bytes) {
  ByteReader in(bytes, "numbers of boundary vertices");
  BoundaryNumbers numbers;
  numbers.places = get_list<std::uint32_t>(in);
  numbers.numbers = get_list<std::uint32_t>(in);
  numbers.points = get_list<std::uint32_t>(in);
  in.expect_end();
  const std::size_t count = numbers.places.size();
  if (numbers.numbers.size() != count ||
      (!numbers.points.empty() && numbers.points.size() != count)) {
    in.fail("not as many as vertices");
  }
  return numbers;
}

}  // namespace meshfarm
