// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/local_farm.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/run_graph.hpp>
#include <meshfarm/pipeline/run_options.hpp>
#include <meshfarm/pipeline/sink_need.hpp>
#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/transport/addresses.hpp>
#include <meshfarm/util/checksum.hpp>
#include <meshfarm/util/control_groups.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>
#include <meshfarm/util/log.hpp>
#include <meshfarm/util/memory.hpp>

#include "cli/supervisor.hpp"
#include "cli/texture_words.hpp"

namespace meshfarm {
namespace {

std::vector<std::string> joined(std::vector<std::string> words,
                                const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// The processes share this machine's free memory evenly. The number of workers is such that the
/// largest job fits into a share; a single worker tries it whatever it needs.
struct Crew {
  std::uint32_t workers = 0;
  std::uint64_t memory = 0;  // of each; 0: no limit
};

Crew crew_for(const LocalFarm& farm, const Manifest& manifest) {
  const auto room = available_memory();
  if (farm.workers == 0 || !room) return {farm.workers, 0};
  const std::uint64_t memory = room->bytes;
  const std::uint64_t largest = memory_wanted(manifest, farm.target.run);
  Crew crew{farm.workers, memory / farm.workers};
  while (crew.workers > 1 && crew.memory < largest) crew.memory = memory / --crew.workers;
  if (crew.workers < farm.workers) {
    log_warning("only " + std::to_string(crew.workers) + " of " + std::to_string(farm.workers) +
                " workers are started: a part takes about " + std::to_string(largest >> 20) +
                " MiB, " + std::to_string(memory >> 20) + " MiB are free; use more --parts");
  }
  crew.memory = std::max(crew.memory, largest);
  return crew;
}

/// Options for a key file in a folder of this host, removed with this object. Used only if the
/// stage's file system cannot keep a file private (FAT, some network shares) and no process on
/// another host takes part; otherwise empty, and the keys are in the stage.
class KeysAside {
 public:
  KeysAside(const LocalFarm& farm, const Stage& stage) {
    if (!farm.network.this_host_only || !farm.network.security.key_file.empty() ||
        keeps_private(stage.root() / "control"))
      return;
    std::string folder = (temporary_folder() / "meshfarm-XXXXXX").string();
    if (::mkdtemp(folder.data()) == nullptr) throw_errno("cannot make", folder);
    folder_ = folder;
  }
  ~KeysAside() {
    std::error_code ignored;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
  }
  KeysAside(const KeysAside&) = delete;
  KeysAside& operator=(const KeysAside&) = delete;

  std::vector<std::string> words() const {
    if (folder_.empty()) return {};
    return {"--key-file", (folder_ / "run.keys").string()};
  }

 private:
  std::filesystem::path folder_;
};

/// Checks once what ventilator and sink would otherwise both report.
void check_network(const NetworkOptions& network) {
  if (!network.this_host_only) check_bind(network.bind);
  const std::filesystem::path keys = network.security.key_file;
  std::error_code ignored;
  if (std::filesystem::is_directory(keys, ignored)) throw DataError(keys.string() + ": not a file");
}

}  // namespace

std::uint32_t default_workers() {
  return processors();
}

int run_local_farm(const LocalFarm& farm, const std::atomic<bool>& stop) {
  // Opened here once, so that a missing or damaged stage gives one error, not one per process.
  const Stage stage = Stage::open(farm.stage);
  farm.network.security.check_mount(farm.stage);
  check_network(farm.network);
  const Manifest manifest =
      decode_manifest(stage.read(ManifestName{}), stage.path(ManifestName{}).string());
  check_output_fits(farm.output, manifest, farm.target.run);
  check_sink_need(manifest, farm.target.run, std::nullopt);  // the sink reports its advice
  tell_textures(manifest, farm.target.run);
  const Crew crew = crew_for(farm, manifest);
  std::vector<std::string> shared = {"--supervised"};
  if (farm.talk.quiet) shared.emplace_back("--quiet");

  const KeysAside keys(farm, stage);
  shared = joined(shared, keys.words());
  const std::vector<std::string> of_centre = joined(shared, farm.when_full.words());
  Supervisor supervisor(stop);
  const std::vector<std::string> common =
      joined(joined({farm.stage}, joined(farm.target.words(), farm.network.words())), of_centre);
  supervisor.start(joined({"ventilator"}, joined(common, farm.schedule.words())));
  std::vector<std::string> sink = joined(joined({"sink"}, common), {"--output", farm.output});
  sink = joined(sink, farm.words_of_output.words());
  if (farm.talk.json) sink.emplace_back("--json");
  supervisor.start(sink);
  std::vector<std::string> worker =
      joined({"worker", farm.stage}, joined(farm.network.security.words(), shared));
  worker = joined(worker, {"--run", to_hex(run_key(manifest, farm.target.run))});
  if (crew.memory != 0) {
    worker = joined(worker, {"--memory", std::to_string(crew.memory)});
  }
  for (std::uint32_t i = 0; i < crew.workers; ++i) supervisor.start(worker);
  return supervisor.run();
}

}  // namespace meshfarm
