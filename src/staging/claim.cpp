// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// A claim is a line of text: host boot-id pid-namespace pid process-start-ticks unix-seconds
#include <chrono>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>

#include <unistd.h>

#include <meshfarm/staging/atomic_file.hpp>
#include <meshfarm/staging/claim.hpp>
#include <meshfarm/staging/host_card.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

namespace meshfarm {
namespace {

namespace fs = std::filesystem;

struct Owner {
  std::string host;
  std::uint64_t boot = 0;
  std::string pids;  // the namespace of `pid`: containers have their own
  std::int64_t pid = 0;
  std::uint64_t started = 0;  // by the kernel's clock: differs if the pid was reused
  std::int64_t at_s = 0;
};

/// The 22nd field of /proc/PID/stat, counted from after the name, which may contain anything; 0 if
/// there is no such process.
std::uint64_t start_of(std::int64_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string line;
  std::getline(file, line);
  const std::size_t name_end = line.rfind(')');
  if (name_end == std::string::npos) return 0;
  std::istringstream words(line.substr(name_end + 1));
  std::string skipped;
  for (int i = 0; i < 19; ++i) words >> skipped;
  std::uint64_t started = 0;
  words >> started;
  return started;
}

std::string pid_namespace() {
  std::error_code ignored;
  const std::string target = fs::read_symlink("/proc/self/ns/pid", ignored).string();
  return target.empty() ? "-" : target;
}

Owner this_process() {
  const HostCard host = this_host();
  return {host.host.empty() ? "-" : host.host,
          host.boot,
          pid_namespace(),
          ::getpid(),
          start_of(::getpid()),
          host.seen_s};
}

std::string line_of(const Owner& owner) {
  std::ostringstream line;
  line << owner.host << ' ' << owner.boot << ' ' << owner.pids << ' ' << owner.pid << ' '
       << owner.started << ' ' << owner.at_s << '\n';
  return line.str();
}

/// Fields stay empty for a file that cannot be read: the owner is unknown.
Owner read_owner(const fs::path& path) {
  Owner owner;
  std::ifstream file(path);
  file >> owner.host >> owner.boot >> owner.pids >> owner.pid >> owner.started >> owner.at_s;
  return owner;
}

/// Only if it is certain: the process is gone on this host, or the host was rebooted since.
bool is_dead(const Owner& owner) {
  const HostCard here = this_host();
  if (owner.boot == here.boot) {
    return owner.pids == pid_namespace() && start_of(owner.pid) != owner.started;
  }
  return owner.host == here.host && owner.at_s < here.booted_s;
}

bool publish(const fs::path& path) {
  AtomicFile file(path);
  file.write(line_of(this_process()));
  return file.commit_new();
}

}  // namespace

Claim::Claim(fs::path file, std::string_view work) : file_(std::move(file)) {
  if (publish(file_)) return;
  const Owner owner = read_owner(file_);
  if (is_dead(owner)) {
    log_debug("taken over: " + file_.string());
    std::error_code ignored;
    fs::remove(file_, ignored);
    if (publish(file_)) return;
  }
  const Owner now = read_owner(file_);
  throw DataError(std::string(work) + " on host " + now.host + ", process " +
                  std::to_string(now.pid) + "; wait for its end (or, if it is gone, remove " +
                  file_.string() + ")");
}

/// If the folder was removed with its claim and made again, another owner's claim may be there.
Claim::~Claim() {
  const Owner owner = read_owner(file_);
  const Owner self = this_process();
  const bool is_own = owner.boot == self.boot && owner.pids == self.pids && owner.pid == self.pid &&
                      owner.started == self.started;
  std::error_code ignored;
  if (is_own) fs::remove(file_, ignored);
}

std::optional<std::string> holder_of(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  const Owner owner = read_owner(file);
  if (is_dead(owner)) return std::nullopt;
  return "host " + owner.host + ", process " + std::to_string(owner.pid);
}

fs::path claim_of(const fs::path& output) {
  return output.parent_path() / ("." + output.filename().string() + ".claim");
}

}  // namespace meshfarm
