// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

#include <meshfarm/staging/line_log.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm {
namespace {

constexpr std::chrono::milliseconds k_write_every{500};
constexpr std::chrono::seconds k_last_wait{3};
constexpr std::size_t k_most_waiting_bytes = std::size_t{64} << 20;

}  // namespace

struct LineLog::Shared {
  std::filesystem::path path;
  std::mutex mutex;
  std::condition_variable changed;
  std::string waiting;
  bool end = false;
  bool ended = false;

  void run();
  void write(Fd& file, const std::string& bytes) const;
};

void LineLog::Shared::write(Fd& file, const std::string& bytes) const {
  if (!file) {
    std::error_code ignored;
    std::filesystem::create_directory(path.parent_path(), ignored);
    file = Fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
    if (!file) throw_errno("cannot make", path);
  }
  write_all(file.get(), bytes, path);
  if (::fdatasync(file.get()) != 0) throw_errno("cannot sync", path);
}

void LineLog::Shared::run() {
  Fd file;
  bool works = true;
  std::unique_lock lock(mutex);
  while (!end || !waiting.empty()) {
    if (!end) changed.wait_for(lock, k_write_every, [this] { return end; });
    const std::string bytes = std::exchange(waiting, {});
    if (bytes.empty()) continue;
    lock.unlock();
    try {
      if (works) write(file, bytes);
    } catch (const Error& error) {
      // A line half written would spoil those after it; the run itself does not need them.
      log_warning("what happens is not logged any more: " + std::string(error.what()));
      works = false;
    }
    lock.lock();
  }
  ended = true;
  changed.notify_all();
}

LineLog::LineLog(std::filesystem::path path) : shared_(std::make_shared<Shared>()) {
  shared_->path = std::move(path);
  thread_ = std::thread([shared = shared_] { shared->run(); });
}

LineLog::~LineLog() {
  std::unique_lock lock(shared_->mutex);
  shared_->end = true;
  shared_->changed.notify_all();
  const bool ended =
      shared_->changed.wait_for(lock, k_last_wait, [this] { return shared_->ended; });
  lock.unlock();
  ended ? thread_.join() : thread_.detach();  // it keeps what it uses
}

void LineLog::add(std::string_view line) {
  const std::lock_guard lock(shared_->mutex);
  if (shared_->waiting.size() > k_most_waiting_bytes) return;
  shared_->waiting += line;
  shared_->waiting += '\n';
}

}  // namespace meshfarm
