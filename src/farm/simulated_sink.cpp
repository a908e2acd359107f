// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "farm/simulated_farm.hpp"

namespace meshfarm {
namespace {

constexpr std::uint64_t k_run = 7;
constexpr std::chrono::milliseconds k_down{8000};
constexpr FarmTime k_patience = std::chrono::hours(2);

}  // namespace

void SimulatedFarm::start_sink() {
  if (finished_ || sink_.alive) return;
  sink_.alive = true;
  const std::uint64_t life = ++sink_.life;
  sink_.here = "s" + std::to_string(life);
  sink_.to_ventilator = sink_.from_ventilator = {};
  sink_.to_ventilator.from = sink_.from_ventilator.to = sink_.host;
  MemberOptions member;
  member.role = Role::sink;
  member.run = k_run;
  member.incarnation = dice_.next() | 1;
  member.host = "sink";
  member.results = sink_.here;
  member.patience = k_patience;
  sink_.core = std::make_unique<SinkCore>(member, source_, journal_, options_.when_full);
  tick_sink(life);
}

void SimulatedFarm::tick_sink(std::uint64_t life) {
  if (!sink_.alive || sink_.life != life) return;
  when_awake(sink_, life, [this] { sink_does(sink_.core->tick(farm_now())); });
  queue_.in(options_.heartbeat / 4, [this, life] { tick_sink(life); });
}

void SimulatedFarm::kill_sink() {
  if (!sink_.alive) return;
  kill(sink_);
  sink_.core.reset();
  sink_.peer.clear();
  queue_.in(up_to(k_down), [this] { start_sink(); });
}

void SimulatedFarm::sink_does(SinkActions actions) {
  const std::uint64_t life = sink_.life;
  for (SinkAction& action : actions) {
    if (!sink_.alive || sink_.life != life) return;
    std::visit([this](auto& each) { sink_act(each); }, action);
  }
}

void SimulatedFarm::sink_act(Look&) {
  sink_does(sink_.core->found(endpoints_seen(sink_.host), farm_now()));
}

void SimulatedFarm::sink_act(Dial& each) {
  sink_.peer = "s" + std::to_string(++dials_);
  sink_.dialled = static_cast<std::uint32_t>(std::stoul(each.address.substr(1)));
}

void SimulatedFarm::sink_act(HangUp&) {
  sink_.peer.clear();
}

void SimulatedFarm::sink_act(Say& each) {
  if (sink_.peer.empty()) return;
  to_ventilator(sink_, sink_.to_ventilator, sink_.peer, sink_.dialled, std::move(each.message));
}

void SimulatedFarm::sink_act(const Check& each) {
  const SimulatedTime readable = folder_.readable(sink_.host);
  if (readable > queue_.now() && !each.from_journal) return check_by_sick_mount(each, readable);
  SimulatedTime there =
      folder_.transfer(sink_.host, each.output.file.size) + folder_.visibility_delay();
  if (options_.centre.per_result.count() > 0) {
    there = sink_free_ = std::max(sink_free_, there) + options_.centre.per_result;
  }
  queue_.at(there, [this, each, life = sink_.life] {
    when_awake(sink_, life, [this, each] {
      const bool whole = folder_.has_whole(each.output.file.name);
      if (whole && !each.from_journal && folder_.full()) {
        return sink_does(sink_.core->checked(
            each, {"no space left on device", FailureKind::no_space}, farm_now()));
      }
      if (whole && !each.from_journal && chance(options_.faults.journal_error)) {
        return sink_does(sink_.core->fail({"cannot sync the journal", false}));
      }
      if (whole && !each.from_journal) journal(each);
      // Killed between the journal's sync and the word to the ventilator.
      if (whole && chance(options_.faults.crash_at_job / 4)) return kill_sink();
      sink_does(sink_.core->checked(each, {whole ? "" : "the file is damaged"}, farm_now()));
    });
  });
}

/// Either its reader waits, maybe in vain, or it soon sees what is not there.
void SimulatedFarm::check_by_sick_mount(const Check& each, SimulatedTime readable) {
  const SimulatedTime gives_up = queue_.now() + SimulatedFolder::k_patience;
  const bool damaged = dice_.chance(0.5);
  const JobFailure problem = damaged ? JobFailure{"the file is damaged", FailureKind::attempt}
                                     : JobFailure{"cannot open it", FailureKind::unread};
  const SimulatedTime soon = queue_.now() + std::chrono::milliseconds(750);
  queue_.at(damaged ? soon : std::min(gives_up, readable),
            [this, each, problem, life = sink_.life] {
              when_awake(sink_, life, [this, each, problem] {
                const bool well = folder_.readable(sink_.host) <= queue_.now();
                if (well) return sink_act(each);
                sink_does(sink_.core->checked(each, problem, farm_now()));
              });
            });
}

void SimulatedFarm::journal(const Check& check) {
  checks_.journalled(check.key, folder_.has_whole(check.output.file.name));
  journal_[check.key] = check.output;
  result_.last_accept = queue_.now();
  note(check.key.value);
  const auto published = published_.find(check.output.file.name);
  if (published == published_.end()) return;
  result_.jobs.push_back(published->second);
  result_.jobs.back().accepted = queue_.now();
}

void SimulatedFarm::sink_act(MakeOutput&) {
  queue_.in(up_to(std::chrono::milliseconds(faulty() ? 5000 : 1)), [this, life = sink_.life] {
    when_awake(sink_, life, [this] {
      if (folder_.full()) {
        return sink_does(sink_.core->completed({"no space left on device", true}, farm_now()));
      }
      const auto made = sink_.core->rounds().outputs();
      for (const AcceptedJob& each : made) {
        checks_.that(folder_.has_whole(each.output.file.name), "an accepted file is not there");
      }
      result_.outputs.assign(made.begin(), made.end());
      sink_does(sink_.core->completed({}, farm_now()));
    });
  });
}

void SimulatedFarm::sink_act(SinkLeaves& each) {
  kill(sink_);
  sink_.core.reset();
  sink_.peer.clear();
  // Turned away by the late word of a run that was over: whoever started it starts it again.
  if (each.why != SinkLeaves::Why::complete) queue_.in(k_down, [this] { start_sink(); });
}

}  // namespace meshfarm
