// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <utility>

#include <meshfarm/farm/job_graph.hpp>
#include <meshfarm/util/errors.hpp>

namespace meshfarm {
namespace {

/// The union, sorted, with adjacent ranges joined.
JobNeeds joined(const JobNeeds& some, const JobNeeds& others) {
  JobNeeds all = some;
  all.insert(all.end(), others.begin(), others.end());
  std::erase_if(all, [](const JobRange& each) { return each.count == 0; });
  std::sort(all.begin(), all.end());
  JobNeeds joined;
  for (const JobRange& each : all) {
    if (!joined.empty() && joined.back().stage == each.stage &&
        each.first <= joined.back().first + joined.back().count) {
      JobRange& last = joined.back();
      last.count = std::max(last.count, each.first + each.count - last.first);
    } else {
      joined.push_back(each);
    }
  }
  return joined;
}

}  // namespace

JobGraph::JobGraph(std::vector<std::string> stages, std::uint32_t algorithm)
    : algorithm_(algorithm) {
  for (std::string& name : stages) stages_.push_back({std::move(name), {}, 0});
  stages_.emplace_back();
}

JobGraph::Node& JobGraph::node(JobName name) {
  std::vector<Node>& nodes = stages_.at(name.stage).nodes;
  if (name.index >= nodes.size()) nodes.resize(name.index + std::size_t{1});
  return nodes[name.index];
}

const JobNeeds& JobGraph::needs(JobName name) const {
  return stages_.at(name.stage).nodes.at(name.index).needs;
}

JobPlace JobGraph::place(JobName name) const {
  JobPlace place{stages_.at(name.stage).name, name.index};
  for (const JobRange& each : needs(name)) {
    place.needs.push_back({stages_[each.stage].name, each.first, each.count});
  }
  return place;
}

void JobGraph::add(JobName name, Job job) {
  add(name, {}, [job = std::move(job)](JobGraph&) { return job; });
}

void JobGraph::add(JobName name, const JobNeeds& needs, Make make) {
  Node& added = node(name);
  if (added.state != State::unknown) {
    throw Error("job " + std::to_string(name.index) + " of " + stages_[name.stage].name +
                " is asked for twice");
  }
  added.state = State::waiting;
  added.needs = joined(needs, inherited_);
  added.make = std::move(make);
  ++open_;
  for (const JobRange& range : needs) wait_for(range, name);
  if (node(name).missing == 0) possible_.push_back(name);
}

void JobGraph::then(const JobNeeds& needs, Step step) {
  const auto steps = static_cast<std::uint32_t>(stages_.size() - 1);
  const JobName name{steps, static_cast<std::uint32_t>(stages_.back().nodes.size())};
  add(name, needs, [step = std::move(step)](JobGraph& graph) {
    step(graph);
    return std::optional<Job>{};
  });
}

void JobGraph::wait_for(const JobRange& range, JobName who) {
  const std::uint32_t end = range.first + range.count;
  std::uint32_t missing = 0;
  std::uint32_t index = std::max(range.first, stages_.at(range.stage).accepted_to);
  for (; index < end; ++index) {
    Node& needed = node({range.stage, index});
    if (needed.state == State::accepted) continue;
    needed.needed_by.push_back(who);
    ++missing;
  }
  node(who).missing += missing;
}

std::vector<WantedJob> JobGraph::go_on() {
  std::vector<WantedJob> fresh;
  while (!possible_.empty()) {
    const JobName name = possible_.front();
    possible_.pop_front();
    make(name, fresh);
  }
  return fresh;
}

/// Call once its needs are accepted.
void JobGraph::make(JobName name, std::vector<WantedJob>& fresh) {
  const Make make = std::exchange(node(name).make, {});
  inherited_ = node(name).needs;
  std::optional<Job> job = make(*this);
  inherited_.clear();
  if (!job) return pass(name);
  job->algorithm = algorithm_;
  if (inspect_) inspect_(*job);
  const JobKey key = key_of(*job);
  Node& made = node(name);
  made.state = State::wanted;
  made.key = key;
  ++stages_[name.stage].jobs;
  const auto [entry, is_new] = jobs_.try_emplace(key);
  entry->second.names.push_back(name);
  if (entry->second.accepted) return pass(name);
  if (is_new) fresh.push_back({key, std::move(*job), name});
}

std::vector<WantedJob> JobGraph::accept(JobKey key, const JobOutput& output) {
  if (!waits_for(key)) return {};
  Entry& entry = jobs_.at(key);
  entry.accepted = true;
  entry.output = output;
  ++jobs_accepted_;
  for (const JobName& name : entry.names) pass(name);
  return go_on();
}

/// Its dependents need not wait for it any more.
void JobGraph::pass(JobName name) {
  Node& passed = node(name);
  assert(passed.state == State::waiting || passed.state == State::wanted);
  passed.state = State::accepted;
  --open_;
  for (const JobName& each : std::exchange(passed.needed_by, {})) {
    if (--node(each).missing == 0) possible_.push_back(each);
  }
  Stage& stage = stages_[name.stage];
  if (passed.key) ++stage.jobs_accepted;
  while (stage.accepted_to < stage.nodes.size() &&
         stage.nodes[stage.accepted_to].state == State::accepted) {
    ++stage.accepted_to;
  }
}

const JobOutput& JobGraph::output(JobName name) const {
  const Node& made = stages_.at(name.stage).nodes.at(name.index);
  if (made.state != State::accepted) throw Error("the output of a job that is not accepted");
  return jobs_.at(made.key.value()).output;
}

const JobOutput* JobGraph::accepted(JobKey key) const {
  const auto found = jobs_.find(key);
  return found != jobs_.end() && found->second.accepted ? &found->second.output : nullptr;
}

std::vector<StageProgress> JobGraph::progress() const {
  std::vector<StageProgress> progress;
  for (const Stage& stage : stages_) {
    if (stage.jobs > 0) progress.push_back({stage.name, stage.jobs, stage.jobs_accepted});
  }
  return progress;
}

std::vector<AcceptedJob> JobGraph::outputs() const {
  std::vector<AcceptedJob> outputs;
  for (const Stage& stage : stages_) {
    for (const Node& each : stage.nodes) {
      if (each.state != State::accepted || !each.key) continue;
      outputs.push_back({*each.key, jobs_.at(*each.key).output});
    }
  }
  return outputs;
}

}  // namespace meshfarm
