// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace meshfarm {

/// Base of all our errors. The subclass says who must act; the message says what failed, where, why
/// and, where it helps, what to do next. Caught in main, in the worker's job loop, and wherever a
/// failure is known to be soft.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The caller's arguments are wrong (exit 2).
class UsageError : public Error {
 public:
  using Error::Error;
};

/// The input or a staged file is malformed, corrupt or out of range (exit 1).
class DataError : public Error {
 public:
  using Error::Error;
};

/// A system call failed: keeps errno and the path (exit 1).
class IoError : public Error {
 public:
  IoError(std::string_view action, const std::filesystem::path& path, int error_number);
  int error_number() const { return error_number_; }

 private:
  int error_number_;
};

/// Errors from reading a staged file that cannot be read, or does not match, are also of this type:
/// another host may be able to read it.
class UnreadError {
 public:
  virtual ~UnreadError() = default;
};
class UnreadIoError : public IoError, public UnreadError {
 public:
  explicit UnreadIoError(const IoError& error) : IoError(error) {}
};
class UnreadDataError : public DataError, public UnreadError {
 public:
  explicit UnreadDataError(const std::string& what) : DataError(what) {}
};

/// Whether the error says that the disk, or the user's quota, is full.
bool is_no_space(const IoError& error);

/// Ends the message of a run that a full disk stopped.
inline constexpr std::string_view k_after_making_room =
    "; what is done is kept: make room, then run the same command again";

/// The run stopped before its end; what is staged is kept and can be resumed (exit 3).
class IncompleteError : public Error {
 public:
  using Error::Error;
};

/// Throws IoError with the current errno.
[[noreturn]] void throw_errno(std::string_view action, const std::filesystem::path& path);

}  // namespace meshfarm
