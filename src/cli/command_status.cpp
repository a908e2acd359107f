// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <iostream>
#include <thread>

#include <unistd.h>

#include <meshfarm/pipeline/run_trace.hpp>
#include <meshfarm/report/status.hpp>
#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/util/errors.hpp>

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "cli/signals.hpp"

namespace meshfarm {
namespace {

class StatusCommand : public Command {
 public:
  std::string_view name() const override { return "status"; }
  std::string_view synopsis() const override { return "STAGE [--watch]"; }
  std::string_view summary() const override {
    return "how far a stage's run is, and what each worker does";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("stage", po::value(&stage_)->required(), "")(
        "watch", po::bool_switch(&watch_), "again every second, until the run is over")(
        "json", po::bool_switch(&json_), "as JSON (with --watch: one object after another)");
    positional.add("stage", 1);
  }
  int run() override {
    const std::atomic<bool>& stop = stop_on_signals();
    const Stage stage = Stage::open(stage_);
    for (;;) {
      const StageStatus status = look(stage);
      const bool screen = watch_ && !json_ && ::isatty(STDOUT_FILENO) == 1;
      if (screen) std::cout << "\x1b[H\x1b[2J";
      std::cout << render(status, json_ ? Format::json : Format::text) << std::flush;
      if (!watch_ || is_over(status)) return 0;
      for (int i = 0; i < 10 && !stop; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
      }
      if (stop) return 0;
    }
  }

 private:
  StageStatus look(const Stage& stage) const {
    StageStatus status;
    status.stage = stage_;
    status.manifest =
        decode_manifest(stage.read(ManifestName{}), stage.path(ManifestName{}).string());
    if (!stage.traces().empty()) {
      status.trace = read_newest_trace(stage);
      if (status.trace->end) status.times = read_run_times(stage, status.trace->head.run);
    }
    status.now_unix_s = server_unix_s(stage.path(TraceName{1}).parent_path());
    status.no_room = is_silent(status) && is_full(stage);
    return status;
  }

  /// On a full disk the ventilator cannot even write that it waits for room.
  static bool is_full(const Stage& stage) {
    constexpr std::uint64_t k_little = 64 << 10;
    try {
      probe_room(stage.root() / "log", k_little);
    } catch (const IoError& error) {
      return is_no_space(error);
    }
    return false;
  }

  std::string stage_;
  bool watch_ = false;
  bool json_ = false;
};

}  // namespace

std::unique_ptr<Command> make_status_command() {
  return std::make_unique<StatusCommand>();
}

}  // namespace meshfarm
