// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/io/label_pairs.hpp>

using namespace meshfarm;

namespace {

LabelMeaning named(const std::vector<std::string>& names) {
  LabelMeaning meaning{"material", {}};
  for (const std::string& name : names) meaning.materials.push_back({name});
  return meaning;
}

/// Which triangles of A have the same label as B's triangle in the same place.
std::vector<bool> same(const LabelMeaning& meaning_a, std::vector<Label> labels_a,
                       const LabelMeaning& meaning_b, std::vector<Label> labels_b) {
  MeantLabels a{meaning_a, std::move(labels_a)};
  MeantLabels b{meaning_b, std::move(labels_b)};
  pair_labels(a, b);
  REQUIRE(a.labels.size() == b.labels.size());
  std::vector<bool> equal;
  for (std::size_t i = 0; i < a.labels.size(); ++i) equal.push_back(a.labels[i] == b.labels[i]);
  return equal;
}

using Same = std::vector<bool>;

}  // namespace

TEST_CASE("labels that both have names are the same if the names are") {
  const LabelMeaning a = named({"stone", "glass", "steel"});
  const LabelMeaning b = named({"steel", "wood", "stone"});
  CHECK(same(a, {0, 1, 2, 0}, b, {2, 1, 0, 0}) == Same{true, false, true, false});
}

TEST_CASE("names are the same as a format without blanks has them") {
  CHECK(same(named({"old stone", "a#b"}), {0, 1}, named({"a_b", "old_stone"}), {1, 0}) ==
        Same{true, true});
}

TEST_CASE("labels without names are compared as numbers") {
  const LabelMeaning region{"region", {}};
  CHECK(same(region, {7, 4000000000U, 3}, LabelMeaning{"label", {}}, {7, 4000000000U, 4}) ==
        Same{true, true, false});
}

TEST_CASE("a number is the same as the material that was made of it") {
  const LabelMeaning region{"region", {}};
  CHECK(same(region, {7, 9, 3}, named({"region_3", "region_7", "region_9"}), {1, 2, 1}) ==
        Same{true, true, false});
  CHECK(same(named({"region 9"}), {0}, region, {9}) == Same{true});
}

TEST_CASE("a number is that of a material where no name tells") {
  const LabelMeaning number{"material_index", {}};
  CHECK(same(named({"stone", "glass"}), {0, 1, 1}, number, {0, 1, 0}) == Same{true, true, false});
}
