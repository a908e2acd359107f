// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/command.hpp"

namespace meshfarm {

std::vector<std::unique_ptr<Command>> all_commands() {
  std::vector<std::unique_ptr<Command>> commands;
  commands.push_back(make_simplify_command());
  commands.push_back(make_batch_command());
  commands.push_back(make_cut_command());
  commands.push_back(make_run_command());
  commands.push_back(make_worker_command());
  commands.push_back(make_replay_command());
  commands.push_back(make_ventilator_command());
  commands.push_back(make_sink_command());
  commands.push_back(make_info_command());
  commands.push_back(make_compare_command());
  commands.push_back(make_convert_command());
  commands.push_back(make_render_command());
  commands.push_back(make_benchmark_command());
  commands.push_back(make_generate_command());
  commands.push_back(make_status_command());
  commands.push_back(make_report_command());
  commands.push_back(make_clean_command());
  commands.push_back(make_doctor_command());
  commands.push_back(make_simulate_command());
  return commands;
}

}  // namespace meshfarm
