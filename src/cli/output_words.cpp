// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/output_words.hpp"

#include <algorithm>

#include <meshfarm/io/channel_choice.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm {

void OutputWords::add(po::options_description& options) {
  options.add_options()("plain", po::bool_switch(&plain),
                        "write .glb without quantisation and compression, for programs that cannot "
                        "read EXT_meshopt_compression");
}

void OutputWords::check_given(const GivenOptions& given, const std::string& output) const {
  if (!given.contains("plain") || !is_output_format(output) || has_packing(output)) return;
  log_warning("--plain changes nothing: " + output + " is not .glb");
}

std::vector<std::string> OutputWords::words() const {
  return plain ? std::vector<std::string>{"--plain"} : std::vector<std::string>{};
}

void check_output_fits(const std::string& output, const Manifest& manifest, const RunOptions& run) {
  const std::uint64_t triangles =
      std::min(target_triangles(manifest, run), manifest.input_triangles);
  const std::vector<Channel> chosen =
      channels_at(manifest.channels.channels, chosen_columns(manifest, run));
  check_fits(output, {.vertices = triangles / 2,
                      .triangles = triangles,
                      .positions = manifest.positions,
                      .comment = {},
                      .channels = kept_channels(output, chosen)});
}

}  // namespace meshfarm
