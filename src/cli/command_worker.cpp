// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include <meshfarm/pipeline/algorithm.hpp>
#include <meshfarm/pipeline/benchmark.hpp>
#include <meshfarm/pipeline/job_table.hpp>
#include <meshfarm/staging/host_card.hpp>
#include <meshfarm/transport/worker.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>
#include <meshfarm/util/memory.hpp>

#include "cli/farm_command.hpp"
#include "cli/pool_worker.hpp"
#include "cli/version.hpp"

namespace meshfarm {
namespace {

class WorkerCommand : public FarmCommand {
 public:
  std::string_view name() const override { return "worker"; }
  std::string_view synopsis() const override { return "STAGE | --pool FOLDER"; }
  std::string_view summary() const override {
    return "simplify parts for a run, from any host that sees the stage";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    add_stage(options, positional, StageIs::optional);
    options.add_options()("pool", po::value(&pool_)->value_name("FOLDER"),
                          "serve the runs of all stages in this folder, or linked there, one after "
                          "another: first the run with the fewest workers for its remaining work; "
                          "keep looking for runs after each one");
    options.add_options()("wait", po::value(&wait_s_)->value_name("SECONDS"),
                          "how long to look for a ventilator (default: 60; with --pool: for ever)");
    options.add_options()("speed", po::value(&speed_)->value_name("N"),
                          "triangles a second that this host simplifies (0, the default: as "
                          "'meshfarm benchmark' measured)")(
        "threads", po::value(&threads_)->default_value(threads_)->value_name("N"),
        "parts simplified at once, 1 to 256")(
        "memory", po::value(&memory_)->value_name("SIZE"),
        "memory that all parts in progress may take together, as 8G (default: this worker's share "
        "of the free memory of the host or its control group; 0: no limit)");
    options.add_options()("run", po::value(&run_)->value_name("KEY"),
                          "serve only the run with this key, as printed by 'meshfarm run "
                          "--worker-words' (default: the newest run of the stage)");
    security_.add(options);
    talk_.add_quiet(options);
  }
  void check() override {
    security_.check();
    if (stage_.empty() == pool_.empty()) throw UsageError("give a STAGE, or --pool FOLDER");
    if (!pool_.empty() && !run_.empty()) {
      throw UsageError("--run needs a STAGE: it cannot be combined with --pool");
    }
    if (threads_ == 0 || threads_ > 256) throw UsageError("--threads: from 1 to 256");
    if (!run_.empty()) run_key_ = parse_run(run_);
    if (!memory_.empty()) memory_bytes_ = parse_size(memory_, "--memory");
  }

 protected:
  const SecurityWords& security() const override { return security_; }
  void work(const std::atomic<bool>& stop) override {
    if (pool_.empty()) return FarmCommand::work(stop);
    PoolWork pool;
    pool.folder = pool_;
    if (wait_s_ >= 0) pool.wait = std::chrono::seconds(wait_s_);
    pool.serve = [&](const Stage& stage, std::uint64_t run) {
      if (!supervised()) security_.check_mount(stage.root());
      serve_run(stage, run, k_patience_in_pool, stop);
    };
    serve_pool(pool, stop);
  }

  void serve(const Stage& stage, const std::atomic<bool>& stop) override {
    constexpr std::int64_t k_patience_s = 60;
    serve_run(stage, run_key_, std::chrono::seconds(wait_s_ < 0 ? k_patience_s : wait_s_), stop);
  }

 private:
  /// Other runs may answer instead.
  static constexpr std::chrono::seconds k_patience_in_pool{10};

  void serve_run(const Stage& stage, std::uint64_t run, std::chrono::seconds patience,
                 const std::atomic<bool>& stop) const {
    leave_host_card(stage);
    WorkerOptions options;
    options.security = security_.security;
    options.patience = patience;
    options.stop = &stop;
    options.run = run;
    options.algorithm = k_algorithm_version;
    options.abort = [](const std::string& incomplete) { end_process(incomplete); };
    options.capacity.threads = threads_;
    // Workers of one run on one machine are equally fast, so a short run need not wait for the
    // benchmark.
    const Haste haste = supervised() ? Haste::great : Haste::none;
    options.capacity.speed = speed_ != 0 ? speed_ : speed_of_this_host(k_version, haste);
    options.capacity.memory = memory_bytes_;
    if (memory_.empty()) take_free_memory(options.capacity);
    const WorkerReport report = run_worker(stage, do_job, options);
    if (supervised()) return;
    log_info(account_of(report));
    if (report.jobs_failed > 0) {
      log_warning(std::to_string(report.jobs_failed) + " jobs failed here");
    }
  }

  /// 'meshfarm doctor' uses the cards to find hosts of the same name.
  static void leave_host_card(const Stage& stage) {
    try {
      publish_host_card(stage, this_host());
    } catch (const IoError& error) {
      log_debug(error.what());
    }
  }

  static std::uint64_t parse_run(const std::string& text) {
    std::uint64_t key = 0;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, key, 16);
    if (error != std::errc{} || end != last || key == 0) {
      throw UsageError("--run takes a run's key, 16 hexadecimal digits, not '" + text + "'");
    }
    return key;
  }

  /// Memory shared with the other workers of this host, or of its control group.
  static void take_free_memory(Capacity& capacity) {
    const auto room = available_memory();
    if (!room) return;
    capacity.memory = std::max<std::uint64_t>(room->bytes, 1);  // 0 would mean no limit
    capacity.memory_pool = room->pool;
  }

  /// "16 jobs in 2.91 s, computing for 98.7 % of it"
  std::string account_of(const WorkerReport& report) const {
    char text[96];
    const double all = report.span_seconds * threads_;
    std::snprintf(text, sizeof text, "%llu jobs in %.2f s, computing for %.1f %% of it",
                  static_cast<unsigned long long>(report.jobs_done), report.span_seconds,
                  all > 0 ? 100 * report.compute_seconds / all : 0.0);
    return text;
  }

  /// Threads that do not respond can only be ended with the process.
  [[noreturn]] static void end_process(const std::string& incomplete) {
    log_error("left with a job that does not end; " +
              (incomplete.empty() ? std::string("the run is over") : incomplete));
    std::_Exit(incomplete.empty() ? 0 : 3);
  }

  std::string pool_;
  std::int64_t wait_s_ = -1;  // below 0: not given
  std::uint32_t threads_ = 1;
  std::uint64_t speed_ = 0;
  std::string run_;
  std::uint64_t run_key_ = 0;
  std::string memory_;
  std::uint64_t memory_bytes_ = 0;
  SecurityWords security_;
};

}  // namespace

std::unique_ptr<Command> make_worker_command() {
  return std::make_unique<WorkerCommand>();
}

}  // namespace meshfarm
