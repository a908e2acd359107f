// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cerrno>
#include <thread>

#include <meshfarm/staging/patience.hpp>

namespace meshfarm {
namespace {

constexpr int k_longest_wait_ms = 5000;

bool storage_fails(const IoError& error) {
  const int number = error.error_number();
  return number == ESTALE || number == EIO || number == ETIMEDOUT;
}

}  // namespace

ReadPatience patience_with_storage() {
  return {.missing = std::chrono::milliseconds(0)};
}

void spend(ReadPatience& patience, const Error& error) {
  const auto* io = dynamic_cast<const IoError*>(&error);
  if (io == nullptr) return;
  if (storage_fails(*io)) patience.failing = std::chrono::milliseconds(0);
  if (io->error_number() == ENOENT) patience.missing = std::chrono::milliseconds(0);
}

Waiting::Waiting(const ReadPatience& patience)
    : patience_(patience),
      begin_(std::chrono::steady_clock::now()),
      wait_ms_(patience.first_wait_ms) {}

bool Waiting::again(const IoError& error) {
  const bool missing = error.error_number() == ENOENT;
  if (patience_.attempts <= 1 || !(missing || storage_fails(error))) return false;
  if (waited() >= (missing ? patience_.missing : patience_.failing)) return false;
  pause();
  return true;
}

void Waiting::pause() {
  std::this_thread::sleep_for(std::chrono::milliseconds(wait_ms_));
  wait_ms_ = std::min(2 * wait_ms_, k_longest_wait_ms);
  if (patience_.moved) patience_.moved(0);
}

std::chrono::milliseconds Waiting::waited() const {
  return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now() -
                                                               begin_);
}

}  // namespace meshfarm
