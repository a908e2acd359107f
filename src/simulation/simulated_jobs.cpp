// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A job in a simulated worker, as in src/transport/job_slot.cpp: it waits for its turn to read,
// reads its inputs, waits for a compute thread, is computed, and its output is written and
// published.
#include <utility>

#include "simulation/made_up_run.hpp"
#include "simulation/simulated_farm.hpp"

namespace meshfarm {

void SimulatedFarm::act(std::uint32_t index, Begin& each) {
  Worker& worker = workers_[index];
  checks_.that(!worker.slots.at(each.slot), "a worker began two jobs in one slot");
  InWork& in_work = worker.slots[each.slot].emplace();
  in_work.token = ++tokens_;
  in_work.key = each.key;
  in_work.attempt = each.attempt;
  in_work.job = std::move(each.job);
  // Half of the results are large.
  const std::uint64_t made_up = (each.key.value % 2) << 20;
  in_work.work = options_.work
                     ? options_.work(in_work.job)
                     : SimulatedWork{static_cast<double>(in_work.job.cost) * 1e-3, 0, made_up};
  in_work.clock = JobClock(farm_now());
  if (in_work.work.read_bytes < k_much_input) return read(worker, each.slot);
  in_work.phase = JobPhase::waiting;
  worker.to_read.push_back(each.slot);
  read_next(worker);
}

void SimulatedFarm::read_next(Worker& worker) {
  const std::uint64_t life = worker.life;
  while (worker.alive && worker.life == life && !worker.to_read.empty() &&
         worker.reading < options_.workers[index_of(worker)].threads) {
    const std::uint32_t slot = worker.to_read.front();
    worker.to_read.pop_front();
    worker.slots[slot]->reads_much = true;
    ++worker.reading;
    read(worker, slot);
  }
}

void SimulatedFarm::read(Worker& worker, std::uint32_t slot) {
  InWork& in_work = *worker.slots[slot];
  in_work.phase = JobPhase::storage;
  const SimulatedTime delay = folder_.visibility_delay();
  const SimulatedTime readable = std::max(folder_.readable(worker.host), lost_part(in_work.key));
  in_work.looks_for_file = delay.count() > 0 || readable > queue_.now();
  const SimulatedTime gives_up = queue_.now() + SimulatedFolder::k_patience;
  if (readable > gives_up) {
    return while_in_work(worker, slot, gives_up, [this, &worker, slot] {
      fail_job(worker, slot, "cannot open its part", FailureKind::no_input);
    });
  }
  const SimulatedTime there = std::max(
      folder_.read(worker.host, in_work.work.read_bytes, in_work.work.extent) + delay, readable);
  while_in_work(worker, slot, there, [this, &worker, slot] {
    InWork& has_read = *worker.slots[slot];
    end_reading(worker, has_read);
    has_read.clock.read(farm_now());
    has_read.phase = JobPhase::waiting;
    has_read.looks_for_file = false;
    worker.to_compute.push_back(slot);
    compute_next(worker);
    read_next(worker);
  });
}

void SimulatedFarm::end_reading(Worker& worker, InWork& in_work) {
  if (std::exchange(in_work.reads_much, false)) --worker.reading;
}

/// When the job's input becomes readable: the same time for all workers.
SimulatedTime SimulatedFarm::lost_part(JobKey key) {
  if (options_.faults.lost_parts <= 0) return SimulatedTime(0);
  const auto [lost, first] = lost_parts_.try_emplace(key);
  if (first && chance(options_.faults.lost_parts)) lost->second = queue_.now() + some_minutes();
  return lost->second;
}

/// The signs of life that a real worker gets from its slots: the count of a running job grows.
void SimulatedFarm::feel_pulse(Worker& worker) {
  for (std::size_t i = 0; i < worker.slots.size(); ++i) {
    const auto& in_work = worker.slots[i];
    if (!in_work) continue;
    SlotPulse& pulse = worker.pulse.slots[i];
    pulse.phase = in_work->phase;
    const bool computes = pulse.phase == JobPhase::computing && !in_work->hangs;
    const bool moves = computes || in_work->looks_for_file;
    if (moves) ++pulse.progress;
  }
}

void SimulatedFarm::compute_next(Worker& worker) {
  const std::uint64_t life = worker.life;
  while (worker.alive && worker.life == life && !worker.to_compute.empty() &&
         worker.computing < options_.workers[index_of(worker)].threads) {
    const std::uint32_t slot = worker.to_compute.front();
    worker.to_compute.pop_front();
    begin_computing(worker, slot);
  }
}

void SimulatedFarm::begin_computing(Worker& worker, std::uint32_t slot) {
  InWork& in_work = *worker.slots[slot];
  const std::string& name = in_work.job.parameters;
  const SimulatedFaults& faults = options_.faults;
  for (const FileRef& input : in_work.job.inputs) {
    if ((faults.decay <= 0 && faults.damaged <= 0) || folder_.has_whole(input.name)) continue;
    return fail_job(worker, slot, "its input is damaged", FailureKind::damaged_input);
  }
  const bool poison = !faults.poison.empty() && name == faults.poison;
  if (poison || chance(faults.crash_at_job)) return kill_worker(index_of(worker));
  if (!faults.bad.empty() && name == faults.bad) {
    return fail_job(worker, slot, "no mesh can come of this", FailureKind::for_good);
  }
  if (chance(faults.read_error)) {
    return fail_job(worker, slot, "cannot read", FailureKind::no_input);
  }
  if (chance(faults.fail)) return fail_job(worker, slot, "no luck");
  compute(worker, slot);
}

void SimulatedFarm::compute(Worker& worker, std::uint32_t slot) {
  InWork& in_work = *worker.slots[slot];
  ++worker.computing;
  in_work.clock.computes(farm_now());
  in_work.phase = JobPhase::computing;
  in_work.begin = queue_.now();
  if (chance(options_.faults.hang)) {
    in_work.hangs = true;
    return;
  }
  const double seconds = in_work.work.compute_s / options_.workers[index_of(worker)].speed;
  const auto takes = SimulatedTime(static_cast<std::int64_t>(seconds * 1e6));
  while_in_work(worker, slot, queue_.now() + takes, [this, &worker, slot] {
    InWork& computed = *worker.slots[slot];
    end_computing(worker, computed);
    const SimulatedTime written = folder_.write(worker.host, computed.work.write_bytes);
    while_in_work(worker, slot, written, [this, &worker, slot] { write(worker, slot); });
    compute_next(worker);
  });
}

void SimulatedFarm::end_computing(Worker& worker, InWork& in_work) {
  if (!in_work.clock.computing()) return;
  --worker.computing;
  in_work.clock.computed(farm_now());
  in_work.phase = JobPhase::storage;
}

void SimulatedFarm::write(Worker& worker, std::uint32_t slot) {
  InWork& in_work = *worker.slots[slot];
  in_work.clock.written(farm_now());
  if (folder_.full()) {
    return fail_job(worker, slot, "no space left on device", FailureKind::no_space);
  }
  if (chance(options_.faults.write_error)) return fail_job(worker, slot, "fsync: I/O error");
  JobOutput output;
  output.file.name = to_string(ResultName{in_work.key.value, in_work.attempt, worker.incarnation});
  output.file.size = in_work.work.write_bytes;
  output.summary = simulated_summary(in_work.job);
  const auto content = chance(options_.faults.damaged) ? SimulatedFolder::Content::damaged
                                                       : SimulatedFolder::Content::whole;
  checks_.that(folder_.publish(output.file.name, content), "two results shared a name");
  if (chance(options_.faults.lost_answer)) {
    return fail_job(worker, slot, "rename: no such file or directory");
  }
  published_[output.file.name] = {in_work.key, index_of(worker),     in_work.begin, queue_.now(),
                                  {},          in_work.clock.times()};
  finish_job(worker, slot, std::move(output));
}

void SimulatedFarm::fail_job(Worker& worker, std::uint32_t slot, const char* reason,
                             FailureKind kind) {
  finish_job(worker, slot, JobFailure{reason, kind});
}

void SimulatedFarm::finish_job(Worker& worker, std::uint32_t slot,
                               std::variant<JobOutput, JobFailure> outcome) {
  end_reading(worker, *worker.slots[slot]);
  end_computing(worker, *worker.slots[slot]);
  const JobTimes times = worker.slots[slot]->clock.times();
  std::erase(worker.to_read, slot);
  std::erase(worker.to_compute, slot);
  worker.slots[slot].reset();
  note(index_of(worker));
  const std::uint64_t life = worker.life;
  worker_does(index_of(worker), worker.core->finished(slot, std::move(outcome), farm_now(), times));
  if (worker.life != life) return;
  compute_next(worker);
  read_next(worker);
}

void SimulatedFarm::act(std::uint32_t index, GiveUp& each) {
  // A job checks now and then whether it is still wanted; some do not, and end anyway.
  Worker& worker = workers_[index];
  if (!worker.slots[each.slot] || worker.slots[each.slot]->hangs || chance(0.5)) return;
  while_in_work(worker, each.slot, queue_.now() + SimulatedTime(20'000),
                [this, &worker, slot = each.slot] { fail_job(worker, slot, "given up"); });
}

}  // namespace meshfarm
