// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace meshfarm {

/// curve: every connection is encrypted, and both ends prove that they hold the run's keys. none:
/// any peer that reaches a port is trusted. All processes of a run must agree.
enum class Authentication { curve, none };

/// Whether sockets without authentication may be reachable from other hosts.
enum class Exposure { loopback_only, network };

/// How the processes of a run authenticate each other. The first ventilator or sink of a run makes
/// its keys, in a file that only its owner can read; whoever can read that file belongs to the run.
struct SecurityOptions {
  Authentication authentication = Authentication::curve;
  std::filesystem::path key_file;  // empty: in the stage, one file per run
  Exposure insecure_exposure = Exposure::loopback_only;
};

/// Throws UsageError if sockets bound there would be open to other hosts without authentication and
/// that was not explicitly allowed.
void check_exposure(const SecurityOptions& security, const std::string& bind);

}  // namespace meshfarm
