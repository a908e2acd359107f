// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <unordered_map>
#include <vector>

#include <meshfarm/io/labels.hpp>

namespace meshfarm {

/// The materials that a format writes for labels: those of their meaning or, for labels that are
/// only numbers, one per number, "region 7", in the order of their first use. Up to k_most_numbers
/// numbers have their own; all others share one.
class LabelMaterials {
 public:
  static constexpr std::size_t k_most_numbers = 65'535;

  explicit LabelMaterials(const LabelMeaning& meaning);
  /// The index of a label's material, which then counts as used.
  std::size_t place_of(Label label) {
    if (last_place_ == k_none || label != last_) find(label);
    return last_place_;
  }
  const std::vector<Material>& all() const { return materials_; }
  bool is_used(std::size_t place) const { return is_used_[place]; }
  /// Warns if labels share a material.
  void warn_of_shared(const std::filesystem::path& path) const;

 private:
  void find(Label label);
  std::size_t place_of_number(Label label);

  static constexpr std::size_t k_none = SIZE_MAX;
  std::string name_;
  bool are_numbers_;
  std::vector<Material> materials_;
  std::vector<bool> is_used_;
  std::unordered_map<Label, std::size_t> numbers_;
  Label last_ = 0;
  std::size_t last_place_ = k_none;
};

}  // namespace meshfarm
