// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The boundary side file, kind "BNDY", version 1; the payload of a sealed file:
//   triangles u64 | triangles x 3 x (part u32 | local index u32)
#include <algorithm>
#include <utility>

#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/staging/sealed.hpp>
#include <meshfarm/util/bytes.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

constexpr FileKind k_kind = {'B', 'N', 'D', 'Y'};
constexpr std::uint32_t k_version = 1;

}  // namespace

std::uint64_t drop_duplicates(std::vector<BoundaryTriangle>& triangles) {
  std::vector<std::pair<BoundaryTriangle, std::size_t>> sorted;
  sorted.reserve(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    BoundaryTriangle key = triangles[i];
    std::sort(key.begin(), key.end());
    sorted.emplace_back(key, i);
  }
  std::sort(sorted.begin(), sorted.end());
  std::vector<bool> duplicate(triangles.size(), false);
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[i - 1].first) duplicate[sorted[i].second] = true;
  }
  const std::size_t before = triangles.size();
  std::size_t index = 0;
  std::erase_if(triangles, [&](const BoundaryTriangle&) { return duplicate[index++]; });
  return before - triangles.size();
}

std::string encode_boundary(const std::vector<BoundaryTriangle>& triangles) {
  ByteWriter out;
  out.put(static_cast<std::uint64_t>(triangles.size()));
  out.put_array(std::span<const BoundaryTriangle>(triangles));
  return seal(k_kind, k_version, out.bytes());
}

std::vector<BoundaryTriangle> decode_boundary(std::string_view file, std::string_view what) {
  ByteReader in(unseal(file, k_kind, k_version, what), what);
  const auto count = in.get<std::uint64_t>();
  auto triangles = in.get_array<BoundaryTriangle>(count);
  in.expect_end();
  return triangles;
}

void scan_boundary(const Fill& fill, std::string_view what,
                   const std::function<void(const BoundaryTriangle&)>& show) {
  constexpr std::uint64_t k_at_once = 4096;
  std::string head(k_seal_head_bytes, '\0');
  fill(head);
  const std::uint64_t size = unseal_head(head, k_kind, k_version, what);
  std::uint64_t left = 0;
  fill({reinterpret_cast<char*>(&left), sizeof left});
  const std::uint64_t bytes = size - sizeof left;
  constexpr std::uint64_t k_each = sizeof(BoundaryTriangle);
  if (size < sizeof left || bytes % k_each != 0 || left != bytes / k_each) {
    throw DataError(std::string(what) + ": another size than its count tells");
  }
  std::vector<BoundaryTriangle> some;
  for (; left > 0; left -= some.size()) {
    some.resize(std::min(k_at_once, left));
    fill({reinterpret_cast<char*>(some.data()), some.size() * sizeof some[0]});
    for (const BoundaryTriangle& t : some) show(t);
  }
  std::uint64_t sum = 0;
  fill({reinterpret_cast<char*>(&sum), sizeof sum});
}

}  // namespace meshfarm
