// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>

#include <meshfarm/farm/job.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/pipeline/budget.hpp>

namespace meshfarm {

/// Makes a rung an input of the job, which reads only that part of its file. Returns its size in
/// bytes.
std::uint64_t add_rung_input(const ChosenRung& chosen, bool with_beside, Job& job);

/// Reads the inputs that were added this way, in their order.
class RungInputs {
 public:
  RungInputs(const Job& job, const JobContext& context) : job_(job), context_(context) {}

  ResultMesh next(std::uint32_t rung);
  /// What is stored beside the last rung, if it was added with it.
  std::string beside() { return context_.read_section(job_, next_++); }

 private:
  const Job& job_;
  const JobContext& context_;
  std::size_t next_ = 0;  // of the job's sections
};

}  // namespace meshfarm
