// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/measure_words.hpp"

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

#include "cli/options.hpp"

namespace meshfarm {
namespace {

/// In the format of --memory; rounded up, so that it is enough.
std::string size_text(std::uint64_t bytes) {
  const bool is_large = bytes >= std::uint64_t{10} << 20;
  const unsigned shift = is_large ? 20 : 10;
  const std::uint64_t units = (bytes + (std::uint64_t{1} << shift) - 1) >> shift;
  return std::to_string(units) + (is_large ? "M" : "K");
}

}  // namespace

void MeasureWords::add(po::options_description& options) {
  options.add_options()("memory", po::value(&memory_)->default_value(memory_)->value_name("BYTES"),
                        "memory to work with, as 512M or 2G; what does not fit goes to scratch "
                        "files")("scratch", po::value(&scratch_)->value_name("FOLDER"),
                                 "folder for scratch files (default: $TMPDIR, or /tmp)")(
      "threads", po::value(&divide.threads)->value_name("N"), "threads (0, the default: cores)");
}

void MeasureWords::check() {
  divide.memory_bytes = parse_size(memory_, "--memory");
  if (divide.memory_bytes == 0) throw UsageError("--memory must be above 0");
  divide.folder = scratch_.empty() ? temporary_folder().string() : scratch_;
}

std::uint64_t memory_to_hold(std::uint64_t vertices, std::uint64_t triangles) {
  // Peak while building, including the allocator's overhead: measured.
  constexpr std::uint64_t k_hierarchy_bytes = 72;
  return sizeof(Vec3) * vertices + (sizeof(Triangle) + k_hierarchy_bytes) * triangles;
}

std::string why_too_little(std::uint64_t needed, std::uint64_t memory) {
  return "that takes --memory " + size_text(needed) + ", and there is " + size_text(memory);
}

}  // namespace meshfarm
