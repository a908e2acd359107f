// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/measure_words.hpp"

#include <filesystem>

#include <meshfarm/util/errors.hpp>

#include "cli/options.hpp"

namespace meshfarm {

void MeasureWords::add(po::options_description& options) {
  options.add_options()("memory", po::value(&memory_)->default_value(memory_)->value_name("BYTES"),
                        "memory to work with, as 512M or 2G; what does not fit goes to scratch "
                        "files")("scratch", po::value(&scratch_)->value_name("FOLDER"),
                                 "where these lie (default: $TMPDIR, or /tmp)")(
      "threads", po::value(&divide.threads)->value_name("N"), "threads (default: cores)");
}

void MeasureWords::check() {
  divide.memory_bytes = parse_size(memory_, "--memory");
  if (divide.memory_bytes == 0) throw UsageError("--memory must be above 0");
  divide.folder = scratch_.empty() ? std::filesystem::temp_directory_path().string() : scratch_;
}

}  // namespace meshfarm
