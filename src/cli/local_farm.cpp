// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/local_farm.hpp"

#include <algorithm>
#include <thread>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/staging/stage.hpp>

#include "cli/supervisor.hpp"

namespace meshfarm {
namespace {

std::vector<std::string> joined(std::vector<std::string> words,
                                const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

std::uint32_t default_workers() {
  return std::max(1U, std::thread::hardware_concurrency());
}

int run_local_farm(const LocalFarm& farm, const std::atomic<bool>& stop) {
  // Looked at here once, so that a missing or damaged stage is one line and not one a process.
  const Stage stage = Stage::open(farm.stage);
  decode_manifest(stage.read(ManifestName{}), stage.path(ManifestName{}).string());
  std::vector<std::string> quiet = {"--supervised"};
  if (farm.talk.quiet) quiet.emplace_back("--quiet");

  Supervisor supervisor(stop);
  const std::vector<std::string> common =
      joined(joined({farm.stage}, joined(farm.target.words(), farm.network.words())), quiet);
  supervisor.start(joined({"ventilator"}, common));
  std::vector<std::string> sink = joined(joined({"sink"}, common), {"--output", farm.output});
  if (farm.talk.json) sink.emplace_back("--json");
  supervisor.start(sink);
  for (std::uint32_t i = 0; i < farm.workers; ++i) {
    supervisor.start(joined({"worker", farm.stage}, joined(farm.network.security.words(), quiet)));
  }
  return supervisor.run();
}

}  // namespace meshfarm
