// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "obj_names.hpp"

namespace meshfarm {

void ObjNames::set(std::string_view name) {
  if (current_ && *current_ == name) return;
  current_ = name;
  is_used_ = false;
}

void ObjNames::add(const ObjNames& next) {
  if (next.is_used_before_) face();
  for (const std::string& name : next.names_) keep(name);
  has_too_many_ = has_too_many_ || next.has_too_many_;
  if (!next.current_) return;
  current_ = next.current_;
  is_used_ = next.is_used_;
}

std::optional<Label> ObjNames::label_of(std::string_view name) const {
  const auto found = labels_.find(name);
  return found == labels_.end() ? std::nullopt : std::optional(found->second);
}

void ObjNames::use() {
  is_used_ = true;
  current_ ? keep(*current_) : void(is_used_before_ = true);
}

void ObjNames::keep(const std::string& name) {
  if (labels_.contains(name)) return;
  if (names_.size() == k_most) {
    has_too_many_ = true;
    return;
  }
  labels_.emplace(name, static_cast<Label>(names_.size()));
  names_.push_back(name);
}

}  // namespace meshfarm
