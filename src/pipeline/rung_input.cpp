// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "pipeline/rung_input.hpp"

namespace meshfarm {

std::uint64_t add_rung_input(const ChosenRung& chosen, bool with_beside, Job& job) {
  const auto input = static_cast<std::uint32_t>(job.inputs.size());
  job.inputs.push_back(chosen.file);
  const auto& [rung, tail, beside] = chosen.place;
  job.sections.push_back({input, rung});
  job.sections.push_back({input, tail});
  if (with_beside) job.sections.push_back({input, beside});
  return rung.size + tail.size + (with_beside ? beside.size : 0);
}

ResultMesh RungInputs::next(std::uint32_t rung) {
  const std::string bytes = context_.read_section(job_, next_++);
  const std::string tail = context_.read_section(job_, next_);
  const std::string& name = job_.inputs.at(job_.sections[next_++].input).name;
  return decode_rung(bytes, tail, rung, name);
}

}  // namespace meshfarm
