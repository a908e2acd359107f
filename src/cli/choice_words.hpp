// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {

template <typename Value>
struct ChoiceWord {
  std::string_view word;
  Value value;
};

/// The value of the word. Throws UsageError, listing all choices, if it is none of them.
template <typename Value>
Value chosen(std::string_view option, std::string_view word,
             std::initializer_list<ChoiceWord<Value>> choices) {
  std::string all;
  const ChoiceWord<Value>* const last = choices.end() - 1;
  for (const ChoiceWord<Value>& choice : choices) {
    if (choice.word == word) return choice.value;
    if (&choice != choices.begin()) all += &choice == last ? " or " : ", ";
    all += "'" + std::string(choice.word) + "'";
  }
  throw UsageError(std::string(option) + " is " + all + ", not '" + std::string(word) + "'");
}

}  // namespace meshfarm
