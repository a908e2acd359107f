// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/output_words.hpp"

namespace meshfarm {

void OutputWords::add(po::options_description& options) {
  options.add_options()("plain", po::bool_switch(&plain),
                        "write .glb without quantisation and compression, for programs that cannot "
                        "read EXT_meshopt_compression");
}

std::vector<std::string> OutputWords::words() const {
  return plain ? std::vector<std::string>{"--plain"} : std::vector<std::string>{};
}

}  // namespace meshfarm
