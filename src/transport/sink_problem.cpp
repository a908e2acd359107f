// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "transport/sink_problem.hpp"

#include <meshfarm/util/errors.hpp>

namespace meshfarm {

SinkProblem problem_of(const std::exception_ptr& thrown) {
  if (!thrown) return {};
  try {
    std::rethrow_exception(thrown);
  } catch (const IoError& error) {
    return {error.what(), is_no_space(error)};
  } catch (const std::exception& error) {
    return {error.what(), false};
  } catch (...) {
    return {"an unknown exception", false};
  }
}

SinkProblem problem_of_journal(const std::exception_ptr& thrown) {
  return {problem_of(thrown).text + "; what the journal has is kept: run the same command again",
          true};
}

}  // namespace meshfarm
