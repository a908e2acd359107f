// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// The boundary side file, kind "BNDY", version 1; the payload of a sealed file:
//   triangles u64 | triangles x (3 x (part u32 | local index u32) | label u32, if all have one)
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

struct LabelledTriangle {
  BoundaryTriangle triangle;
  Label label = 0;
};

}  // namespace

std::uint64_t drop_duplicates(std::vector<BoundaryTriangle>& triangles) {
  std::vector<Label> none;
  return drop_duplicates(triangles, none);
}

std::uint64_t drop_duplicates(std::vector<BoundaryTriangle>& triangles,
                              std::vector<Label>& labels) {
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
  index = 0;
  std::erase_if(labels, [&](Label) { return duplicate[index++]; });
  return before - triangles.size();
}

std::string encode_boundary(const std::vector<BoundaryTriangle>& triangles,
                            std::span<const Label> labels) {
  ByteWriter out;
  out.put(static_cast<std::uint64_t>(triangles.size()));
  if (labels.empty()) out.put_array(std::span<const BoundaryTriangle>(triangles));
  for (std::size_t i = 0; i < labels.size(); ++i)
    out.put(LabelledTriangle{triangles[i], labels[i]});
  return seal(k_kind, k_version, out.bytes());
}

std::vector<BoundaryTriangle> decode_boundary(std::string_view file, std::string_view what) {
  std::vector<Label> labels;
  return decode_boundary(file, what, labels);
}

std::vector<BoundaryTriangle> decode_boundary(std::string_view file, std::string_view what,
                                              std::vector<Label>& labels) {
  ByteReader in(unseal(file, k_kind, k_version, what), what);
  labels.clear();
  const auto count = in.get<std::uint64_t>();
  if (in.remaining() / sizeof(LabelledTriangle) != count || count == 0) {
    auto triangles = in.get_array<BoundaryTriangle>(count);
    in.expect_end();
    return triangles;
  }
  std::vector<BoundaryTriangle> triangles;
  for (const LabelledTriangle& each : in.get_array<LabelledTriangle>(count)) {
    triangles.push_back(each.triangle);
    labels.push_back(each.label);
  }
  in.expect_end();
  return triangles;
}

namespace {

/// Shows `count` items, some at a time.
template <typename T, typename Show>
void scan_items(const Fill& fill, std::uint64_t count, const Show& show) {
  constexpr std::uint64_t k_at_once = 4096;
  std::vector<T> some;
  for (std::uint64_t left = count; left > 0; left -= some.size()) {
    some.resize(std::min(k_at_once, left));
    fill({reinterpret_cast<char*>(some.data()), some.size() * sizeof some[0]});
    for (const T& item : some) show(item);
  }
}

}  // namespace

void scan_boundary(const Fill& fill, std::string_view what,
                   const std::function<void(const BoundaryTriangle&, std::optional<Label>)>& show) {
  std::string head(k_seal_head_bytes, '\0');
  fill(head);
  const std::uint64_t size = unseal_head(head, k_kind, k_version, what);
  std::uint64_t count = 0;
  fill({reinterpret_cast<char*>(&count), sizeof count});
  const std::uint64_t bytes = size - sizeof count;
  const auto holds = [&](std::uint64_t each) { return bytes % each == 0 && count == bytes / each; };
  if (size >= sizeof count && holds(sizeof(BoundaryTriangle))) {
    scan_items<BoundaryTriangle>(fill, count,
                                 [&](const BoundaryTriangle& t) { show(t, std::nullopt); });
  } else if (size >= sizeof count && holds(sizeof(LabelledTriangle))) {
    scan_items<LabelledTriangle>(
        fill, count, [&](const LabelledTriangle& each) { show(each.triangle, each.label); });
  } else {
    throw DataError(std::string(what) + ": another size than its count tells");
  }
  std::uint64_t sum = 0;
  fill({reinterpret_cast<char*>(&sum), sizeof sum});
}

}  // namespace meshfarm
