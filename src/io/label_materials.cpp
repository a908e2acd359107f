// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "label_materials.hpp"

#include <meshfarm/util/log.hpp>

namespace meshfarm {

LabelMaterials::LabelMaterials(const LabelMeaning& meaning)
    : name_(meaning.name),
      are_numbers_(meaning.materials.empty()),
      materials_(meaning.materials),
      is_used_(materials_.size()) {}

void LabelMaterials::find(Label label) {
  last_ = label;
  last_place_ = are_numbers_ ? place_of_number(label) : label;
  is_used_[last_place_] = true;
}

std::size_t LabelMaterials::place_of_number(Label label) {
  const auto found = numbers_.find(label);
  if (found != numbers_.end()) return found->second;
  if (numbers_.size() == k_most_numbers) {
    if (materials_.size() == k_most_numbers) {
      materials_.push_back({.name = name_ + " others"});
      is_used_.push_back(true);
    }
    return k_most_numbers;
  }
  numbers_.emplace(label, materials_.size());
  materials_.push_back({.name = name_ + " " + std::to_string(label)});
  is_used_.push_back(true);
  return materials_.size() - 1;
}

void LabelMaterials::warn_of_shared(const std::filesystem::path& path) const {
  if (!are_numbers_ || materials_.size() <= k_most_numbers) return;
  log_warning(path.string() + ": there are more than " + std::to_string(k_most_numbers) +
              " values of " + name_ + ": all others share a material");
}

}  // namespace meshfarm
