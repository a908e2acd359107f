// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/farm_command.hpp"

#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "cli/signals.hpp"

namespace meshfarm {

void FarmCommand::add_stage(po::options_description& options,
                            po::positional_options_description& positional, StageIs stage_is) {
  auto* stage = po::value(&stage_);
  if (stage_is == StageIs::required) stage->required();
  options.add_options()("stage", stage, "")("supervised", po::bool_switch(&supervised_), "");
  positional.add("stage", 1);
}

int FarmCommand::run() {
  const std::atomic<bool>& stop = stop_on_signals();
  if (talk_.quiet || supervised_) set_log(name(), LogLevel::warning);
  try {
    work(stop);
  } catch (const IoError& error) {
    if (!is_no_space(error)) throw;
    throw IncompleteError(error.what() + std::string(k_after_making_room));
  } catch (const IncompleteError&) {
    if (supervised_ && (stop || sink_reports_failures())) return 3;
    throw;
  } catch (const DataError&) {
    if (supervised_ && sink_reports_failures()) return 1;
    throw;
  }
  return 0;
}

void FarmCommand::work(const std::atomic<bool>& stop) {
  const Stage stage = Stage::open(stage_, patience_with_storage());
  if (!supervised_) security().check_mount(stage_);
  serve(stage, stop);
}

Manifest FarmCommand::read_manifest(const Stage& stage) {
  return decode_manifest(stage.read(ManifestName{}, patience_with_storage()),
                         stage.path(ManifestName{}).string());
}

}  // namespace meshfarm
