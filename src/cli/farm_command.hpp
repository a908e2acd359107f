// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/staging/stage.hpp>

#include "cli/command.hpp"
#include "cli/options.hpp"

namespace meshfarm {

/// What the three farm processes share. Under a supervisor, a stop is the supervisor's to report.
class FarmCommand : public Command {
 public:
  int run() final;

 protected:
  enum class StageIs { required, optional };
  void add_stage(po::options_description& options, po::positional_options_description& positional,
                 StageIs stage_is = StageIs::required);
  /// What the process is there for: to serve the stage.
  virtual void work(const std::atomic<bool>& stop);
  virtual void serve(const Stage& stage, const std::atomic<bool>& stop) = 0;
  /// What the command was told about authentication and mounts.
  virtual const SecurityWords& security() const = 0;
  /// Whether jobs that failed for good are another process's to report, too.
  virtual bool sink_reports_failures() const { return false; }
  /// Whether a parent of this program's own started this process and speaks for it.
  bool supervised() const { return supervised_; }
  static Manifest read_manifest(const Stage& stage);

  std::string stage_;
  TalkOptions talk_;

 private:
  bool supervised_ = false;
};

}  // namespace meshfarm
