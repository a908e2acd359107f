// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "simulation/made_up_run.hpp"
#include "simulation/simulated_farm.hpp"

namespace meshfarm {
namespace {

constexpr std::chrono::milliseconds k_sink_down{8000};
/// Longer than any fault: a sink that starts after its run's end leaves by itself.
constexpr FarmTime k_patience = std::chrono::minutes(10);
/// As in src/transport/sink.cpp.
constexpr unsigned k_verifiers = 2;

}  // namespace

void SimulatedFarm::start_sink(Run& run) {
  if (run.finished || run.sink.alive) return;
  start_member(run.sink);
  run.sink_started = queue_.now();
  const std::uint64_t life = run.sink.life;
  run.sink.here = "s" + std::to_string(run.key) + "." + std::to_string(life);
  MemberOptions member;
  member.role = Role::sink;
  member.run = run.key;
  member.incarnation = dice_.next() | 1;
  member.host = "sink";
  member.results = run.sink.here;
  member.patience = k_patience;
  run.to_verify.clear();
  run.verifying = 0;
  suffer(run);
  run.sink.core = std::make_unique<SinkCore>(member, *run.source, run.journal, options_.when_full);
  tick_sink(run, life);
}

/// Damages accepted results while there is no sink: in a way that a size check shows, or not.
void SimulatedFarm::suffer(Run& run) {
  if (options_.faults.decay <= 0) return;
  for (const auto& [key, output] : run.journal) {
    if (!chance(options_.faults.decay)) continue;
    using Content = SimulatedFolder::Content;
    folder_.damage(output.file.name, dice_.chance(0.2) ? Content::cut_short : Content::damaged);
  }
}

void SimulatedFarm::tick_sink(Run& run, std::uint64_t life) {
  if (!run.sink.alive || run.sink.life != life) return;
  when_awake(run.sink, life, [this, &run] { sink_does(run, run.sink.core->tick(farm_now())); });
  queue_.in(options_.heartbeat / 4, [this, &run, life] { tick_sink(run, life); });
}

void SimulatedFarm::kill_sink(Run& run) {
  if (!run.sink.alive) return;
  end_member(run.sink);
  run.sink.core.reset();
  queue_.in(up_to(k_sink_down), [this, &run] { start_sink(run); });
}

void SimulatedFarm::sink_does(Run& run, SinkActions actions) {
  const std::uint64_t life = run.sink.life;
  for (SinkAction& action : actions) {
    if (!run.sink.alive || run.sink.life != life) return;
    std::visit([&](auto& each) { sink_act(run, each); }, action);
  }
}

void SimulatedFarm::sink_act(Run& run, Look&) {
  sink_does(run, run.sink.core->found(endpoints_seen(run.sink.host), farm_now()));
}

void SimulatedFarm::sink_act(Run& run, Dial& each) {
  dial(run.sink, "s", each);
}

void SimulatedFarm::sink_act(Run& run, HangUp&) {
  run.sink.peer.clear();
}

void SimulatedFarm::sink_act(Run& run, Say& each) {
  say(run.sink, std::move(each.message));
}

void SimulatedFarm::sink_act(Run& run, const Check& each) {
  if (each.what == Check::What::known) return check_known(run, each);
  if (each.what == Check::What::accepted) {
    run.to_verify.push_back(each);
    return verify_next(run);
  }
  const SimulatedTime readable = folder_.readable(run.sink.host);
  if (readable > queue_.now()) return check_by_sick_mount(run, each, readable);
  const bool looks = each.what == Check::What::large;
  SimulatedTime there = folder_.transfer(run.sink.host, looks ? 0 : each.output.file.size) +
                        folder_.visibility_delay();
  if (options_.centre.per_result.count() > 0) {
    there = run.sink_free = std::max(run.sink_free, there) + options_.centre.per_result;
  }
  queue_.at(there, [this, &run, each, looks, life = run.sink.life] {
    when_awake(run.sink, life, [this, &run, each, looks] {
      const std::string& name = each.output.file.name;
      const bool whole = looks ? folder_.seems_whole(name) : folder_.has_whole(name);
      if (whole && folder_.full()) {
        return sink_does(
            run, run.sink.core->checked(each, {"no space left on device", FailureKind::no_space},
                                        farm_now()));
      }
      if (whole && chance(options_.faults.journal_error)) {
        return sink_does(run, run.sink.core->fail({"cannot sync the journal", false}));
      }
      if (whole) journal(run, each);
      // Killed between the journal's sync and the message to the ventilator.
      if (whole && chance(options_.faults.crash_at_job / 4)) return kill_sink(run);
      sink_does(run,
                run.sink.core->checked(each, {whole ? "" : "the file is damaged"}, farm_now()));
    });
  });
}

/// Checks the size of a file that is in a journal.
void SimulatedFarm::check_known(Run& run, const Check& each) {
  const SimulatedTime there = folder_.transfer(run.sink.host, 0) + folder_.visibility_delay();
  const SimulatedTime later = up_to(std::chrono::milliseconds(1));
  queue_.at(there + later, [this, &run, each, life = run.sink.life] {
    when_awake(run.sink, life, [this, &run, each] {
      const bool fine = folder_.seems_whole(each.output.file.name);
      if (!fine) run.checks.taken_back(each.key);
      if (fine && chance(options_.faults.crash_at_job / 4)) return kill_sink(run);
      sink_does(run, run.sink.core->checked(each, {fine ? "" : "the file is damaged"}, farm_now()));
    });
  });
}

/// Verifies files accepted by their size when nothing else waits.
void SimulatedFarm::verify_next(Run& run) {
  if (run.to_verify.empty() || run.verifying == k_verifiers) return;
  ++run.verifying;
  const Check each = std::move(run.to_verify.front());
  run.to_verify.pop_front();
  const SimulatedTime there =
      folder_.transfer(run.sink.host, each.output.file.size) + folder_.visibility_delay();
  const SimulatedTime later = up_to(std::chrono::milliseconds(faulty() ? 30'000 : 0));
  queue_.at(there + later, [this, &run, each, life = run.sink.life] {
    when_awake(run.sink, life, [this, &run, each, life] {
      const bool fine = folder_.has_whole(each.output.file.name);
      if (!fine) run.checks.taken_back(each.key);
      if (fine && chance(options_.faults.crash_at_job / 4)) return kill_sink(run);
      --run.verifying;
      result_.last_verified = queue_.now();
      sink_does(run, run.sink.core->checked(each, {fine ? "" : "the file is damaged"}, farm_now()));
      if (run.sink.life == life) verify_next(run);
    });
  });
}

/// Either the reader waits, maybe in vain, or it soon sees wrong content.
void SimulatedFarm::check_by_sick_mount(Run& run, const Check& each, SimulatedTime readable) {
  const SimulatedTime gives_up = queue_.now() + SimulatedFolder::k_patience;
  const bool damaged = dice_.chance(0.5);
  const JobFailure problem = damaged ? JobFailure{"the file is damaged", FailureKind::attempt}
                                     : JobFailure{"cannot open it", FailureKind::unread};
  const SimulatedTime soon = queue_.now() + std::chrono::milliseconds(750);
  queue_.at(damaged ? soon : std::min(gives_up, readable),
            [this, &run, each, problem, life = run.sink.life] {
              when_awake(run.sink, life, [this, &run, each, problem] {
                const bool well = folder_.readable(run.sink.host) <= queue_.now();
                if (well) return sink_act(run, each);
                sink_does(run, run.sink.core->checked(each, problem, farm_now()));
              });
            });
}

void SimulatedFarm::journal(Run& run, const Check& check) {
  const bool looked = check.what == Check::What::large;
  run.checks.journalled(check.key, looked || folder_.has_whole(check.output.file.name));
  run.journal[check.key] = check.output;
  result_.last_accept = queue_.now();
  note(check.key.value);
  const auto published = published_.find(check.output.file.name);
  if (published == published_.end()) return;
  result_.jobs.push_back(published->second);
  result_.jobs.back().accepted = queue_.now();
}

void SimulatedFarm::sink_act(Run& run, const DoHere& each) {
  const SimulatedTime takes = up_to(std::chrono::milliseconds(faulty() ? 5000 : 1));
  queue_.in(takes, [this, &run, each, life = run.sink.life] {
    when_awake(run.sink, life, [this, &run, each, life] {
      if (folder_.full()) {
        const SinkProblem no_room{"no space left on device", true};
        return sink_does(run, run.sink.core->did(each, {}, no_room, farm_now()));
      }
      JobOutput output;
      output.file.name = to_string(ResultName{each.key.value, 1, run.key << 32U | life});
      output.summary = simulated_summary(each.job);
      checks_.that(folder_.publish(output.file.name, SimulatedFolder::Content::whole),
                   "two results of the sink shared a name");
      sink_does(run, run.sink.core->did(each, output, {}, farm_now()));
    });
  });
}

void SimulatedFarm::sink_act(Run& run, MakeOutput&) {
  queue_.in(up_to(std::chrono::milliseconds(faulty() ? 5000 : 1)),
            [this, &run, life = run.sink.life] {
              when_awake(run.sink, life, [this, &run] {
                if (folder_.full()) {
                  return sink_does(
                      run, run.sink.core->completed({"no space left on device", true}, farm_now()));
                }
                const auto made = run.sink.core->graph().outputs();
                for (const AcceptedJob& each : made) {
                  const bool fine = run.sink.core->leaves_to_readers(each.key) ||
                                    folder_.has_whole(each.output.file.name);
                  run.checks.that(fine, "an accepted file is not there");
                }
                run.outputs.assign(made.begin(), made.end());
                sink_does(run, run.sink.core->completed({}, farm_now()));
              });
            });
}

void SimulatedFarm::sink_act(Run& run, SinkLeaves& each) {
  end_member(run.sink);
  run.sink.core.reset();
  run.made_output = each.why == SinkLeaves::Why::complete;
  // Turned away by a late message of a run that was over: the user starts it again.
  if (!run.made_output) queue_.in(k_sink_down, [this, &run] { start_sink(run); });
}

}  // namespace meshfarm
