// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/local_farm.hpp"

#include <algorithm>
#include <thread>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/budget.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/log.hpp>
#include <meshfarm/util/memory.hpp>

#include "cli/supervisor.hpp"

namespace meshfarm {
namespace {

std::vector<std::string> joined(std::vector<std::string> words,
                                const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// The processes share this machine's free memory evenly. So many are started that the largest job
/// fits into a share; a single one tries it whatever it needs.
struct Crew {
  std::uint32_t workers = 0;
  std::uint64_t memory = 0;  // of each; 0: no limit
};

Crew crew_for(const LocalFarm& farm, const Manifest& manifest) {
  const std::uint64_t memory = available_memory();
  if (farm.workers == 0 || memory == 0) return {farm.workers, 0};
  std::uint64_t largest = 0;
  for (const Job& job : make_job_source(manifest, farm.target.run)({})) {
    largest = std::max(largest, job.memory);
  }
  Crew crew{farm.workers, memory / farm.workers};
  while (crew.workers > 1 && crew.memory < largest) crew.memory = memory / --crew.workers;
  if (crew.workers < farm.workers) {
    log_warning("only " + std::to_string(crew.workers) + " of " + std::to_string(farm.workers) +
                " workers are started: a part takes about " + std::to_string(largest >> 20) +
                " MiB, " + std::to_string(memory >> 20) + " are free; more --parts help");
  }
  crew.memory = std::max(crew.memory, largest);
  return crew;
}

}  // namespace

std::uint32_t default_workers() {
  return std::max(1U, std::thread::hardware_concurrency());
}

int run_local_farm(const LocalFarm& farm, const std::atomic<bool>& stop) {
  // Looked at here once, so that a missing or damaged stage is one line and not one a process.
  const Stage stage = Stage::open(farm.stage);
  farm.network.security.check_mount(farm.stage);
  const Manifest manifest =
      decode_manifest(stage.read(ManifestName{}), stage.path(ManifestName{}).string());
  const Crew crew = crew_for(farm, manifest);
  std::vector<std::string> quiet = {"--supervised"};
  if (farm.talk.quiet) quiet.emplace_back("--quiet");

  Supervisor supervisor(stop);
  const std::vector<std::string> common =
      joined(joined({farm.stage}, joined(farm.target.words(), farm.network.words())), quiet);
  supervisor.start(joined({"ventilator"}, joined(common, farm.schedule.words())));
  std::vector<std::string> sink = joined(joined({"sink"}, common), {"--output", farm.output});
  if (farm.talk.json) sink.emplace_back("--json");
  supervisor.start(sink);
  std::vector<std::string> worker =
      joined({"worker", farm.stage}, joined(farm.network.security.words(), quiet));
  if (crew.memory != 0) {
    worker = joined(worker, {"--memory", std::to_string(crew.memory)});
  }
  for (std::uint32_t i = 0; i < crew.workers; ++i) supervisor.start(worker);
  return supervisor.run();
}

}  // namespace meshfarm
