// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "simulation/whole_run.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <meshfarm/util/checksum.hpp>

#include "simulation/made_up_run.hpp"

namespace meshfarm {
namespace {

enum StageOfWholeRun : std::uint32_t {
  k_survey,
  k_count,
  k_partition,
  k_vertices,
  k_triangles,
  k_climb,
  k_join,
  k_split,
  k_seam,
  k_reduce,
  k_measure,
  k_write
};

constexpr std::uint32_t k_rounds_of_count = 2;
constexpr std::uint32_t k_turns_of_split = 2;
constexpr std::uint64_t k_jobs_a_block = 16;
constexpr std::uint64_t k_jobs_a_part = 10;

/// A decision that depends on an output.
bool asks_again(const JobOutput& output) {
  return output.summary.back() % 2 == 0;
}

class WholeRun {
 public:
  WholeRun(std::uint64_t jobs, std::string target)
      : target_(std::move(target)),
        blocks_(static_cast<std::uint32_t>(std::max<std::uint64_t>(1, jobs / k_jobs_a_block))),
        parts_(static_cast<std::uint32_t>(std::max<std::uint64_t>(2, jobs / k_jobs_a_part))) {}

  void begin(JobGraph& graph) {
    for (std::uint32_t b = 0; b < blocks_; ++b) {
      graph.add({k_survey, b}, of_block(b, made_up_job("survey " + std::to_string(b))));
    }
    graph.then({all_of(k_survey, blocks_)}, [this](JobGraph& so_far) {
      know(so_far, all_of(k_survey, blocks_));
      count(so_far, 0);
    });
  }

 private:
  /// All jobs made from now on depend on these outputs.
  void know(const JobGraph& graph, const JobRange& range) {
    std::string all = known_;
    for (std::uint32_t i = 0; i < range.count; ++i) {
      all += graph.output({range.stage, range.first + i}).summary;
    }
    known_ = to_hex(checksum(all));
  }

  Job job(const JobGraph& graph, const std::string& name, std::uint32_t number,
          const std::vector<JobName>& reads) const {
    Job made = made_up_job(name + " " + std::to_string(number) + ", by " + known_);
    made.inputs.reserve(reads.size());
    for (const JobName& each : reads) made.inputs.push_back(graph.output(each).file);
    return made;
  }

  static Job of_block(std::uint32_t block, Job job) {
    job.extent = extent_named("block", block, 1);
    return job;
  }
  static Job of_part(std::uint32_t part, Job job) {
    job.extent = extent_named("part", part, 1);
    return job;
  }

  void count(JobGraph& graph, std::uint32_t round) {
    const JobRange counted{k_count, round * blocks_, blocks_};
    for (std::uint32_t b = 0; b < blocks_; ++b) {
      std::vector<JobName> reads;
      if (round > 0) reads.push_back({k_partition, round - 1});
      graph.add({k_count, counted.first + b}, of_block(b, job(graph, "count", b, reads)));
    }
    graph.add({k_partition, round}, {counted}, [this, round, counted](JobGraph& so_far) {
      know(so_far, counted);
      std::vector<JobName> reads;
      for (std::uint32_t b = 0; b < blocks_; ++b) reads.push_back({k_count, counted.first + b});
      return std::optional(job(so_far, "partition", round, reads));
    });
    graph.then({{k_partition, round, 1}}, [this, round](JobGraph& so_far) {
      know(so_far, {k_partition, round, 1});
      round + 1 < k_rounds_of_count ? count(so_far, round + 1) : scatter_vertices(so_far);
    });
  }

  /// One of these can be poison, by its name.
  void scatter_vertices(JobGraph& graph) {
    for (std::uint32_t b = 0; b < blocks_; ++b) {
      Job each = made_up_job("job " + std::to_string(b));
      each.inputs = {graph.output({k_partition, k_rounds_of_count - 1}).file};
      each.left_to_readers = true;
      graph.add({k_vertices, b}, of_block(b, std::move(each)));
    }
    graph.then({all_of(k_vertices, blocks_)}, [this](JobGraph& so_far) {
      know(so_far, all_of(k_vertices, blocks_));
      scatter_triangles(so_far);
    });
  }

  void scatter_triangles(JobGraph& graph) {
    for (std::uint32_t b = 0; b < blocks_; ++b) {
      Job each = job(graph, "triangles", b, {{k_vertices, b}, {k_vertices, (b + 1) % blocks_}});
      each.left_to_readers = true;
      graph.add({k_triangles, b}, std::move(each));
    }
    graph.then({all_of(k_triangles, blocks_)}, [this](JobGraph& so_far) {
      know(so_far, all_of(k_triangles, blocks_));
      known_ += target_;
      climb(so_far);
    });
  }

  /// A part whose ladder does not reach far enough is climbed again.
  void climb(JobGraph& graph) {
    climbed_.resize(parts_);
    for (std::uint32_t p = 0; p < parts_; ++p) {
      climbed_[p] = p;
      graph.add({k_climb, p}, of_part(p, job(graph, "climb", p, bundles_of(p))));
    }
    graph.then({all_of(k_climb, parts_)}, [this](JobGraph& so_far) {
      know(so_far, all_of(k_climb, parts_));
      JobNeeds again;
      for (std::uint32_t p = 0; p < parts_; ++p) {
        if (!asks_again(so_far.output({k_climb, p}))) continue;
        climbed_[p] = parts_ + p;
        so_far.add({k_climb, climbed_[p]},
                   of_part(p, job(so_far, "climb again", p, bundles_of(p))));
        again.push_back({k_climb, climbed_[p], 1});
      }
      so_far.then(again, [this](JobGraph& climbed) { join(climbed); });
    });
  }

  std::vector<JobName> bundles_of(std::uint32_t part) const {
    return {{k_vertices, part % blocks_}, {k_triangles, part % blocks_}};
  }

  void join(JobGraph& graph) {
    Job join = job(graph, "join", 0, {});
    join.by_sink = true;
    graph.add({k_join, 0}, std::move(join));
    graph.then({{k_join, 0, 1}}, [this](JobGraph& so_far) {
      know(so_far, {k_join, 0, 1});
      split(so_far, 0);
    });
  }

  void split(JobGraph& graph, std::uint32_t turn) {
    const JobRange pieces{k_split, turn * parts_, parts_};
    for (std::uint32_t p = 0; p < parts_; ++p) {
      graph.add({k_split, pieces.first + p}, job(graph, "split", p, {{k_climb, climbed_[p]}}));
    }
    graph.then({pieces}, [this, turn, pieces](JobGraph& so_far) {
      know(so_far, pieces);
      std::vector<JobName> strips;
      for (std::uint32_t p = 0; p < parts_; ++p) strips.push_back({k_split, pieces.first + p});
      so_far.add({k_seam, turn}, job(so_far, "seam", turn, strips));
      so_far.then({{k_seam, turn, 1}}, [this, turn](JobGraph& joined) {
        know(joined, {k_seam, turn, 1});
        turn + 1 < k_turns_of_split ? split(joined, turn + 1) : reduce(joined);
      });
    });
  }

  /// The last piece is the seam's. A piece that misses its quota is reduced again.
  void reduce(JobGraph& graph) {
    reduced_.resize(parts_ + 1);
    for (std::uint32_t p = 0; p <= parts_; ++p) {
      reduced_[p] = p;
      graph.add({k_reduce, p}, job(graph, "reduce", p, {divided(p)}));
    }
    graph.then({all_of(k_reduce, parts_ + 1)}, [this](JobGraph& so_far) {
      know(so_far, all_of(k_reduce, parts_ + 1));
      JobNeeds again;
      for (std::uint32_t p = 0; p <= parts_; ++p) {
        if (!asks_again(so_far.output({k_reduce, p}))) continue;
        reduced_[p] = parts_ + 1 + p;
        so_far.add({k_reduce, reduced_[p]}, job(so_far, "reduce again", p, {divided(p)}));
        again.push_back({k_reduce, reduced_[p], 1});
      }
      so_far.then(again, [this](JobGraph& mended) { measure(mended); });
    });
  }

  JobName divided(std::uint32_t piece) const {
    constexpr std::uint32_t k_last = k_turns_of_split - 1;
    return piece == parts_ ? JobName{k_seam, k_last} : JobName{k_split, k_last * parts_ + piece};
  }

  void measure(JobGraph& graph) {
    for (std::uint32_t p = 0; p <= parts_; ++p) {
      graph.add({k_measure, p}, of_part(p, job(graph, "measure", p,
                                               {{k_reduce, reduced_[p]},
                                                {k_reduce, reduced_[(p + 1) % (parts_ + 1)]},
                                                {k_reduce, reduced_[parts_]},
                                                {k_triangles, p % blocks_}})));
    }
    Job write = job(graph, "write", 0, {{k_reduce, reduced_[parts_]}});
    write.by_sink = true;
    graph.add({k_write, 0}, std::move(write));
  }

  const std::string target_;
  const std::uint32_t blocks_;
  const std::uint32_t parts_;
  std::string known_;
  std::vector<std::uint32_t> climbed_;  // by part: number of its last climb
  std::vector<std::uint32_t> reduced_;  // by piece
};

}  // namespace

JobSource whole_run(std::uint64_t jobs, const std::string& target) {
  return [jobs, target] {
    const auto run = std::make_shared<WholeRun>(jobs, target);
    JobGraph graph({"survey", "count", "partition", "vertices", "triangles", "climb", "join",
                    "split", "seam", "reduce", "measure", "write"});
    run->begin(graph);
    graph.keep(run);
    return graph;
  };
}

}  // namespace meshfarm
