// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/staging/stage.hpp>

#include "cli/command.hpp"
#include "cli/options.hpp"

namespace meshfarm {

/// Shared by the three farm processes. Under a supervisor, the supervisor reports a stop.
class FarmCommand : public Command {
 public:
  int run() final;

 protected:
  enum class StageIs { required, optional };
  void add_stage(po::options_description& options, po::positional_options_description& positional,
                 StageIs stage_is = StageIs::required);
  /// The work of the process: to serve the stage.
  virtual void work(const std::atomic<bool>& stop);
  virtual void serve(const Stage& stage, const std::atomic<bool>& stop) = 0;
  /// The command's options for authentication and mounts.
  virtual const SecurityWords& security() const = 0;
  /// Whether another process also reports jobs that failed for good.
  virtual bool sink_reports_failures() const { return false; }
  /// Whether a parent running this program started this process and reports for it.
  bool supervised() const { return supervised_; }
  static Manifest read_manifest(const Stage& stage);

  std::string stage_;
  TalkOptions talk_;

 private:
  bool supervised_ = false;
};

}  // namespace meshfarm
