// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <string>

#include <meshfarm/io/label_pairs.hpp>

namespace meshfarm {
namespace {

using PairNumbers = std::map<std::string, Label>;

/// A name as every format can write it.
std::string key_of(std::string name) {
  for (char& c : name) {
    if (static_cast<unsigned char>(c) <= ' ' || c == '#' || c == '\\') c = '_';
  }
  return name;
}

std::string name_of(const LabelMeaning& meaning, Label label) {
  if (meaning.materials.empty()) return meaning.name + ' ' + std::to_string(label);
  return label < meaning.materials.size() ? meaning.materials[label].name : std::string{};
}

/// The key of each label that triangles have.
std::map<Label, std::string> keys_of(const MeantLabels& mesh) {
  std::vector<Label> used = mesh.labels;
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::map<Label, std::string> keys;
  for (const Label label : used) keys.emplace(label, key_of(name_of(mesh.meaning, label)));
  return keys;
}

bool have_one_in_common(const std::map<Label, std::string>& a,
                        const std::map<Label, std::string>& b) {
  PairNumbers names;
  for (const auto& [label, key] : a) names.emplace(key, label);
  return std::any_of(b.begin(), b.end(),
                     [&](const auto& each) { return names.count(each.second) != 0; });
}

void renumber(MeantLabels& mesh, const std::map<Label, std::string>& keys, PairNumbers& numbers) {
  std::map<Label, Label> shared;
  for (const auto& [label, key] : keys) {
    const auto next = static_cast<Label>(numbers.size());
    shared.emplace(label, numbers.emplace(key, next).first->second);
  }
  for (Label& label : mesh.labels) label = shared.at(label);
}

}  // namespace

void pair_labels(MeantLabels& a, MeantLabels& b) {
  const bool a_has_names = !a.meaning.materials.empty();
  const bool b_has_names = !b.meaning.materials.empty();
  if (!a_has_names && !b_has_names) return;
  const std::map<Label, std::string> of_a = keys_of(a);
  const std::map<Label, std::string> of_b = keys_of(b);
  if (a_has_names != b_has_names && !have_one_in_common(of_a, of_b)) return;
  PairNumbers numbers;
  renumber(a, of_a, numbers);
  renumber(b, of_b, numbers);
}

}  // namespace meshfarm
