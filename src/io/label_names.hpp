// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <string_view>

namespace meshfarm {

/// Makes names unique.
class FreeNames {
 public:
  void take(std::string_view name) { taken_.emplace(name); }
  /// The name if it is free, else with a number appended: "stone_2". It is taken from then on.
  std::string next(const std::string& wanted) {
    if (taken_.insert(wanted).second) return wanted;
    std::size_t& number = numbers_.try_emplace(wanted, 1).first->second;
    while (true) {
      std::string name = wanted + "_" + std::to_string(++number);
      if (taken_.insert(name).second) return name;
    }
  }

 private:
  std::set<std::string, std::less<>> taken_;
  std::map<std::string, std::size_t> numbers_;  // the last suffix given to each name
};

}  // namespace meshfarm
