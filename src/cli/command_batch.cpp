// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A batch keeps its files in OUTPUT/.batch: the files' stages, which form the crew's pool, the
// output of each run, and NAME.done, by which a repeated command knows what is done.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <map>
#include <optional>

#include <sys/wait.h>

#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/report/batch_report.hpp>
#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/staging/claim.hpp>
#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>
#include <meshfarm/util/log.hpp>

#include "cli/batch_crew.hpp"
#include "cli/child_process.hpp"
#include "cli/command.hpp"
#include "cli/cut_record.hpp"
#include "cli/local_farm.hpp"
#include "cli/options.hpp"
#include "cli/output_words.hpp"
#include "cli/signals.hpp"

namespace meshfarm {
namespace {

namespace fs = std::filesystem;

/// While one file is stitched and finished, the next one is cut and its parts keep the crew busy.
constexpr std::size_t k_at_once = 2;

/// "folder/scan.obj.gz" becomes "scan.obj"; formats that cannot be written become PLY.
std::string output_name(const std::string& input) {
  fs::path name = fs::path(input).filename();
  for (const char* packed : {".gz", ".zst"}) {
    if (name.extension() == packed) name.replace_extension();
  }
  if (!name.has_extension() || !is_output_format(name)) name.replace_extension(".ply");
  return name.string();
}

std::string text_of(const fs::path& path) {
  try {
    return read_file(path);
  } catch (const Error&) {
    return {};
  }
}

/// The last error message, without the name of the process.
std::string reason_in(const std::string& err) {
  constexpr std::string_view k_error = ": error: ";
  const std::size_t at = err.rfind(k_error);
  if (at == std::string::npos) return "see its messages";
  const std::size_t begin = at + k_error.size();
  return err.substr(begin, err.find('\n', begin) - begin);
}

class BatchCommand : public Command {
 public:
  std::string_view name() const override { return "batch"; }
  std::string_view synopsis() const override {
    return "FILES... -o FOLDER (--ratio R | --triangles N | --error LENGTH)";
  }
  std::string_view summary() const override {
    return "simplify many files on this machine, with one crew of workers";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("input", po::value(&inputs_)->required(), "")(
        "output,o", po::value(&output_)->required()->value_name("FOLDER"),
        "where the results go, with the names and formats of the input files; running the same "
        "command again skips finished files");
    output_words_.add(options);
    target_.add(options);
    options.add_options()("workers", po::value(&workers_)->default_value(workers_)->value_name("N"),
                          "worker processes (default: cores)");
    cut_.add(options);
    when_full_.add(options);
    talk_.add(options);
    positional.add("input", -1);
  }
  void check() override {
    target_.check();
    cut_.check();
    if (workers_ == 0 || workers_ > 1000) throw UsageError("--workers: from 1 to 1000");
    std::map<std::string, std::string> by_output;
    for (const std::string& input : inputs_) {
      const auto [at, fresh] = by_output.emplace(output_name(input), input);
      if (!fresh) {
        throw UsageError(at->second + " and " + input + " would both become " + at->first);
      }
      if (fs::path(input).lexically_normal() ==
          (fs::path(output_) / at->first).lexically_normal()) {
        throw UsageError(input + " would be written over: give another folder");
      }
    }
  }
  void check_given(const GivenOptions& given) const override {
    cut_.check_given(given, false);
    // One option for all files: it is enough that it has an effect on one of them.
    const auto of_packing = [](const std::string& input) {
      return has_packing(output_name(input));
    };
    if (std::none_of(inputs_.begin(), inputs_.end(), of_packing)) {
      output_words_.check_given(given, output_name(inputs_.front()));
    }
  }
  int run() override {
    const std::atomic<bool>& stop = stop_on_signals();
    if (talk_.quiet) set_log(name(), LogLevel::warning);
    pool_ = fs::path(output_) / ".batch";
    fs::create_directories(pool_);
    const Claim claim(pool_ / ".batch.claim", output_ + ": another batch is at work there");
    for (const std::string& input : inputs_) plan(input);
    if (!waiting_.empty()) simplify_all(stop);
    std::cout << render(report_, talk_.format());
    if (stop) return 3;
    return std::all_of(report_.files.begin(), report_.files.end(), is_done) ? 0 : 1;
  }

 private:
  using State = BatchReport::State;
  struct Task {
    std::size_t file = 0;  // index in the report
    std::string record;    // identifies it in later commands
    std::string stage;
    pid_t pid = -1;
    std::chrono::steady_clock::time_point began = {};
  };

  static bool is_done(const BatchReport::File& file) {
    return file.state == State::done || file.state == State::done_before;
  }

  fs::path beside(const BatchReport::File& file, const char* end) const {
    return pool_ / (fs::path(file.output).filename().string() + end);
  }

  void plan(const std::string& input) {
    BatchReport::File file;
    file.input = input;
    file.output = (fs::path(output_) / output_name(input)).string();
    Task task;
    task.file = report_.files.size();
    try {
      const CutRecord wanted = record_of(input, cut_);
      task.record = text_of_record(wanted);
      task.stage = beside(file, ".stage").string();
      if (fs::exists(file.output) && text_of(beside(file, ".done")) == done_text(task, file)) {
        file.state = State::done_before;
        file.summary = text_of(beside(file, ".out"));
      } else {
        forget_other_cut(task.stage, wanted);
        waiting_.push_back(task);
      }
    } catch (const Error& error) {
      file.state = State::failed;
      file.reason = error.what();
      log_warning("left out: " + file.reason);
    }
    report_.files.push_back(std::move(file));
  }

  std::string text_of_record(const CutRecord& record) const {
    std::string text = std::to_string(record.size) + " " + std::to_string(record.changed_ns) + " " +
                       std::to_string(record.sum) + " " + record.options;
    for (const std::string& word : target_.words()) text += " " + word;
    for (const std::string& word : output_words_.words()) text += " " + word;
    return text;
  }

  static std::string done_text(const Task& task, const BatchReport::File& file) {
    std::error_code ignored;
    return task.record + "\n" + std::to_string(fs::file_size(file.output, ignored)) + "\n";
  }

  /// Removes the stage of a file that has changed since, or of other options.
  static void forget_other_cut(const std::string& folder, const CutRecord& wanted) {
    if (!fs::exists(folder)) return;
    const Stage stage = Stage::create(folder);
    const auto staged = read_record(stage);
    if (!staged || !difference(*staged, wanted).empty()) remove_stage(folder);
  }

  /// If the file system cannot keep the runs' keys private, they are in a folder on this host.
  std::vector<std::string> key_words() {
    if (keeps_private(pool_)) return {};
    std::string folder = (temporary_folder() / "meshfarm-XXXXXX").string();
    if (::mkdtemp(folder.data()) == nullptr) throw_errno("cannot make", folder);
    keys_ = folder;
    return {"--key-file", (keys_ / "run.keys").string()};
  }

  void simplify_all(const std::atomic<bool>& stop) {
    const std::vector<std::string> keys = key_words();
    std::vector<std::string> worker = {"worker", "--pool", pool_.string(), "--supervised", "-q"};
    worker.insert(worker.end(), keys.begin(), keys.end());
    {
      BatchCrew crew(worker, workers_);
      while (!stop && (!waiting_.empty() || !running_.empty())) {
        while (!waiting_.empty() && running_.size() < k_at_once) start(keys);
        wait_for_child(200);
        reap();
        if (!crew.look_after()) throw IncompleteError("no worker is left");
      }
      std::vector<pid_t> pids;
      for (const Task& each : running_) pids.push_back(each.pid);
      end_children(std::move(pids));
    }
    std::error_code ignored;
    if (!keys_.empty()) fs::remove_all(keys_, ignored);
    if (stop) log_info("stopped; finished work is kept: run the same command again to continue");
  }

  void start(const std::vector<std::string>& keys) {
    Task task = waiting_.front();
    waiting_.erase(waiting_.begin());
    const BatchReport::File& file = report_.files[task.file];
    std::vector<std::string> words = {"simplify", file.input, "-o",     file.output, "--stage",
                                      task.stage, "-q",       "--json", "--in-batch"};
    for (const auto& more :
         {target_.words(), cut_.words(), when_full_.words(), output_words_.words(), keys}) {
      words.insert(words.end(), more.begin(), more.end());
    }
    task.began = std::chrono::steady_clock::now();
    task.pid = start_child(words, {beside(file, ".out"), beside(file, ".err")});
    running_.push_back(task);
  }

  void reap() {
    for (auto task = running_.begin(); task != running_.end();) {
      int status = 0;
      if (::waitpid(task->pid, &status, WNOHANG) == task->pid) {
        ended(*task, status);
        task = running_.erase(task);
      } else {
        ++task;
      }
    }
  }

  void ended(const Task& task, int status) {
    BatchReport::File& file = report_.files[task.file];
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - task.began;
    file.seconds = took.count();
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
      file.state = State::done;
      file.summary = text_of(beside(file, ".out"));
      AtomicFile record(beside(file, ".done"));
      record.write(done_text(task, file));
      record.commit();
    } else {
      file.state = State::failed;
      file.reason = WIFEXITED(status) ? reason_in(text_of(beside(file, ".err")))
                                      : "ended by signal " + std::to_string(WTERMSIG(status));
    }
    const auto settled =
        std::count_if(report_.files.begin(), report_.files.end(),
                      [](const BatchReport::File& each) { return each.state != State::stopped; });
    const std::string count =
        std::to_string(settled) + " of " + std::to_string(report_.files.size()) + ": ";
    if (file.state == State::done) {
      log_info(count + file.input + " is done");
    } else {
      log_warning(count + file.input + " failed: " + file.reason);
    }
  }

  std::vector<std::string> inputs_;
  std::string output_;
  std::uint32_t workers_ = default_workers();
  OutputWords output_words_;
  TargetOptions target_;
  CutWords cut_;
  FullWords when_full_;
  TalkOptions talk_;
  fs::path pool_;
  fs::path keys_;
  BatchReport report_;
  std::vector<Task> waiting_;
  std::vector<Task> running_;
};

}  // namespace

std::unique_ptr<Command> make_batch_command() {
  return std::make_unique<BatchCommand>();
}

}  // namespace meshfarm
