// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/io/labels.hpp>

namespace meshfarm {

/// The names that one kind of statement ("usemtl", "g") gives to the faces after it; only those
/// that faces use. A text may be read in pieces, each with its own ObjNames: the first faces of a
/// piece have the last name of the text before it.
class ObjNames {
 public:
  /// The maximum number of names that are kept.
  static constexpr std::size_t k_most = 100'000;

  /// At the start of a whole text: its first faces have no name, which counts as "".
  void begin_text() { set(""); }
  void set(std::string_view name);
  void face() {
    if (!is_used_) use();
  }
  /// Appends the names of the next piece.
  void add(const ObjNames& next);

  /// In the order of their first use.
  const std::vector<std::string>& names() const { return names_; }
  bool has_too_many() const { return has_too_many_; }
  /// The index of the name among these.
  std::optional<Label> label_of(std::string_view name) const;

 private:
  void use();
  void keep(const std::string& name);

  std::vector<std::string> names_;
  std::map<std::string, Label, std::less<>> labels_;
  std::optional<std::string> current_;  // none at the start of a piece
  bool is_used_ = false;                // whether a face uses the current name
  bool is_used_before_ = false;         // whether a face uses the last name before the piece
  bool has_too_many_ = false;
};

}  // namespace meshfarm
