// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <memory>
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
constexpr std::chrono::seconds k_pause_after_error{2};
constexpr std::chrono::seconds k_last_wait{3};
constexpr std::size_t k_most_waiting_bytes = std::size_t{64} << 20;

}  // namespace

struct LineLog::Shared : SideThread::Signals {
  std::filesystem::path path;
  std::string waiting;
  std::size_t in_work = 0;  // bytes that could not be written yet

  // Owned by the thread:
  Fd file;
  off_t written = 0;  // bytes known to be on disk
  bool told = false;

  void run();
  void write(const std::string& bytes);
  bool try_to_write(const std::string& bytes);
};

/// Bytes from an incomplete write are overwritten with the same bytes.
void LineLog::Shared::write(const std::string& bytes) {
  if (!file) {
    std::error_code ignored;
    std::filesystem::create_directory(path.parent_path(), ignored);
    file = Fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
    if (!file) throw_errno("cannot make", path);
  }
  if (::lseek(file.get(), written, SEEK_SET) < 0) throw_errno("cannot seek in", path);
  write_all(file.get(), bytes, path);
  if (::fdatasync(file.get()) != 0) throw_errno("cannot sync", path);
  written += static_cast<off_t>(bytes.size());
}

bool LineLog::Shared::try_to_write(const std::string& bytes) {
  try {
    write(bytes);
    return true;
  } catch (const Error& error) {
    if (!std::exchange(told, true)) {
      log_warning("what happens is not logged for now: " + std::string(error.what()));
    }
    return false;
  }
}

void LineLog::Shared::run() {
  std::string bytes;
  bool failed = false;
  std::unique_lock lock(mutex);
  while (!end || !waiting.empty()) {
    const auto pause = failed ? std::chrono::milliseconds(k_pause_after_error) : k_write_every;
    if (!end) changed.wait_for(lock, pause, [this] { return end; });
    bytes += std::exchange(waiting, {});
    if (bytes.empty()) continue;
    const bool last = end;
    lock.unlock();
    failed = !try_to_write(bytes);
    if (!failed) bytes.clear();
    lock.lock();
    if (last && failed) break;
    in_work = bytes.size();
  }
}

LineLog::LineLog(std::filesystem::path path) : shared_(std::make_shared<Shared>()) {
  shared_->path = std::move(path);
  thread_.emplace(
      shared_, [shared = shared_] { shared->run(); }, k_last_wait);
}

LineLog::~LineLog() = default;

void LineLog::add(std::string_view line) {
  const std::lock_guard lock(shared_->mutex);
  if (shared_->in_work + shared_->waiting.size() > k_most_waiting_bytes) return;
  shared_->waiting += line;
  shared_->waiting += '\n';
}

}  // namespace meshfarm
