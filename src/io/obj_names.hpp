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

/// The names that one kind of statement ("usemtl", "g") gives to the faces that follow, as far as
/// faces do. A text may be read in pieces, each by an ObjNames of its own: what comes first in a
/// piece has the last name of what is before it.
class ObjNames {
 public:
  /// So many are kept.
  static constexpr std::size_t k_most = 100'000;

  /// At the start of a whole text: its first faces have no name, which is the name "".
  void begin_text() { set(""); }
  void set(std::string_view name);
  void face() {
    if (!is_used_) use();
  }
  /// What follows in the text.
  void add(const ObjNames& next);

  /// In the order of their first use.
  const std::vector<std::string>& names() const { return names_; }
  bool has_too_many() const { return has_too_many_; }
  /// Where the name stands among these.
  std::optional<Label> label_of(std::string_view name) const;

 private:
  void use();
  void keep(const std::string& name);

  std::vector<std::string> names_;
  std::map<std::string, Label, std::less<>> labels_;
  std::optional<std::string> current_;  // none where a piece begins
  bool is_used_ = false;                // the current one, by a face
  bool is_used_before_ = false;         // what is current before the piece
  bool has_too_many_ = false;
};

}  // namespace meshfarm
