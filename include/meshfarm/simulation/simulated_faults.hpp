// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace meshfarm {

/// Time since the simulated start.
using SimulatedTime = std::chrono::microseconds;

/// The faults until `end`. Chances are per message, job or file; rates are per minute.
struct SimulatedFaults {
  double lose = 0;       // a message
  double duplicate = 0;  // a message: it comes twice
  double late = 0;       // a message arrives seconds late, as do later ones on its channel
  double overtake = 0;   // a result: later ones may arrive first (another connection)

  double crash_at_job = 0;   // the worker dies at a job
  double fail = 0;           // a job throws
  double hang = 0;           // a job never ends
  double read_error = 0;     // reading a part fails
  double write_error = 0;    // fsync or close fails, and there is no file
  double lost_answer = 0;    // the rename succeeds, but is reported as failed
  double damaged = 0;        // the file is short or damaged, without an error
  double decay = 0;          // an accepted file is damaged while there is no sink; per start of one
  double unseen = 0;         // a reported name stays invisible to its reader for 30 s or more
  double stale = 0;          // a reader sees an old state of a file for some seconds
  double lane_fails = 0;     // no port is free for a lane
  double journal_error = 0;  // a record: the sink's journal cannot be written, not for lack of room
  double late_endpoint = 0;  // a ventilator's address: a host does not see it for up to 20 s

  double worker_crashes = 0;  // per worker, as are the next two
  double worker_pauses = 0;   // like SIGSTOP, up to 12 s
  double host_cuts = 0;       // one direction or both, up to 12 s; TCP delivers late, or never
  double worker_leaves = 0;   // like SIGTERM: it gives back its jobs; per worker
  double other_runs = 0;      // another run of the stage, which nobody answers for, begins or ends
  double sink_crashes = 0;
  double sink_pauses = 0;
  double ventilator_crashes = 0;
  double ventilator_pauses = 0;
  double sick_mounts = 0;     // a worker's host cannot read files for up to four minutes; per host
  double sick_sink = 0;       // the sink's host
  double lost_parts = 0;      // per job: its input cannot be read by anybody for up to four minutes
  double storage_stalls = 0;  // no file operation ends for up to 20 s
  double disk_fills = 0;      // nothing can be written for up to 20 s

  std::string poison;  // the job with these parameters kills each worker that begins it
  std::string bad;     // the job with these parameters can never be done
  SimulatedTime end{std::chrono::seconds(30)};
};

}  // namespace meshfarm
