// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>

#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/pipeline/pool.hpp>
#include <meshfarm/pipeline/run_trace.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm {
namespace {

namespace fs = std::filesystem;

/// Uses what the run's trace says; a run that has just begun has the whole mesh to do.
void look_at_trace(const Stage& stage, PoolRun& run) {
  const auto traces = stage.traces();
  if (std::find(traces.begin(), traces.end(), run.epoch) != traces.end()) {
    try {
      const Trace trace = read_newest_trace(stage, run.epoch);
      if (trace.end) return;
      if (trace.state && trace.state->jobs_known > 0) {
        run.workers = trace.state->workers.size();
        run.triangles = trace.state->triangles_known - trace.state->triangles_done;
        return;
      }
    } catch (const Error& error) {
      log_debug(error.what());  // its first line is still being written
    }
  }
  const std::string what = stage.path(ManifestName{}).string();
  run.triangles = decode_manifest(stage.read(ManifestName{}), what).triangles();
}

/// Lists the folder: on NFS a name that is looked up too early stays invisible.
bool is_cut(const fs::path& folder) {
  std::error_code error;
  return std::any_of(fs::directory_iterator(folder, error), fs::directory_iterator(),
                     [](const fs::directory_entry& entry) {
                       return entry.path().filename() == to_string(ManifestName{});
                     });
}

void add_runs(const fs::path& folder, std::vector<PoolRun>& runs) {
  const Stage stage = Stage::open(folder);
  EndpointList endpoints;
  std::map<std::uint64_t, const Endpoint*> newest;
  for (const Endpoint& each : endpoints.look(stage)) newest[each.run] = &each;
  for (const auto& [key, endpoint] : newest) {
    if (endpoint->address.empty()) continue;
    PoolRun run{folder, key, endpoint->epoch, 0, 0};
    look_at_trace(stage, run);
    if (run.triangles > 0) runs.push_back(run);
  }
}

}  // namespace

std::vector<PoolRun> runs_of_pool(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> stages;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (is_cut(entry.path())) stages.push_back(entry.path());
  }
  if (error) throw IoError("cannot list", folder, error.value());
  std::sort(stages.begin(), stages.end());
  std::vector<PoolRun> runs;
  for (const fs::path& each : stages) {
    try {
      add_runs(each, runs);
    } catch (const Error& why) {
      log_debug("left out of the pool: " + std::string(why.what()));
    }
  }
  return runs;
}

std::optional<PoolRun> neediest(std::span<const PoolRun> runs) {
  const auto share = [](const PoolRun& run) {
    return static_cast<double>(run.triangles) / static_cast<double>(run.workers + 1);
  };
  const auto found = std::max_element(
      runs.begin(), runs.end(), [&](const auto& a, const auto& b) { return share(a) < share(b); });
  return found == runs.end() ? std::nullopt : std::optional(*found);
}

}  // namespace meshfarm
