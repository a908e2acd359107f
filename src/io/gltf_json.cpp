// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "gltf_json.hpp"

#include <cmath>

#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

using Parsed = nlohmann::json;

constexpr double k_most_whole = 9007199254740992.0;  // 2^53: sums of a few fit into 64 bits

}  // namespace

Parsed parse_gltf_json(std::string_view text, std::uint64_t start, const std::string& path) {
  constexpr int k_most_levels = 64;
  const auto check_depth = [&path](int depth, Parsed::parse_event_t, const Parsed&) {
    if (depth <= k_most_levels) return true;
    throw DataError(path + ": its JSON has more than " + std::to_string(k_most_levels) +
                    " levels of arrays and objects");
  };
  try {
    return Parsed::parse(text, check_depth);
  } catch (const Parsed::parse_error& error) {
    throw DataError(path + ": its JSON is malformed at byte " +
                    std::to_string(start + (error.byte > 0 ? error.byte - 1 : 0)));
  } catch (const Parsed::exception&) {
    throw DataError(path + ": its JSON has a number that is out of range");
  }
}

GltfValue GltfValue::at(std::string_view name) const {
  if (std::optional<GltfValue> found = find(name)) return *std::move(found);
  fail("has no " + std::string(name));
}

std::optional<GltfValue> GltfValue::find(std::string_view name) const {
  if (!value_->is_object()) fail("is not an object");
  const auto found = value_->find(name);
  if (found == value_->end()) return std::nullopt;
  const char* const separator = place_.ends_with(": ") ? "" : ".";
  return GltfValue(*found, place_ + separator + std::string(name));
}

std::size_t GltfValue::size() const {
  if (!value_->is_array()) fail("is not an array");
  return value_->size();
}

std::size_t GltfValue::size_of(std::string_view name) const {
  const std::optional<GltfValue> found = find(name);
  return found ? found->size() : 0;
}

GltfValue GltfValue::item(std::uint64_t index) const {
  if (index >= size()) {
    fail("has no item " + std::to_string(index) + ": there are " + std::to_string(size()));
  }
  return {(*value_)[index], place_ + "[" + std::to_string(index) + "]"};
}

double GltfValue::real() const {
  if (!value_->is_number()) fail("is not a number");
  return value_->get<double>();
}

std::uint64_t GltfValue::whole() const {
  const double number = real();
  if (!(number >= 0 && number < k_most_whole && number == std::floor(number))) {
    fail("is not a whole number from 0 to 2^53");
  }
  return static_cast<std::uint64_t>(number);
}

std::uint64_t GltfValue::whole_or(std::string_view name, std::uint64_t otherwise) const {
  const std::optional<GltfValue> found = find(name);
  return found ? found->whole() : otherwise;
}

bool GltfValue::flag(std::string_view name) const {
  const std::optional<GltfValue> found = find(name);
  if (!found) return false;
  if (!found->value_->is_boolean()) found->fail("is neither true nor false");
  return found->value_->get<bool>();
}

const std::string& GltfValue::text() const {
  if (!value_->is_string()) fail("is not a string");
  return value_->get_ref<const std::string&>();
}

std::string GltfValue::place() const {
  return place_.ends_with(": ") ? place_.substr(0, place_.size() - 2) : place_;
}

void GltfValue::fail(const std::string& why) const {
  throw DataError(place_ + (place_.ends_with(": ") ? "the document " : " ") + why);
}

}  // namespace meshfarm
