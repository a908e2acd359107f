// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <meshfarm/staging/file_system.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

constexpr const char* k_mountinfo =
    "22 28 0:20 / /sys rw,relatime shared:7 - sysfs sysfs rw\n"
    "28 1 254:1 / / rw,relatime shared:1 - ext4 /dev/vda1 rw,errors=remount-ro\n"
    "99 28 0:52 / /nfs rw,noatime shared:9 master:2 - nfs4 server:/export "
    "rw,vers=4.2,rsize=1048576,soft,proto=tcp\n"
    "100 28 0:52 /a /nfs/a ro - nfs4 server:/export rw,vers=4.2\n"
    "101 28 8:1 / /with\\040blank rw - xfs /dev/sda1 rw\n"
    "torn 28 0:53\n";

}  // namespace

TEST_CASE("a mount is found by its path, with the options of both lists") {
  const auto root = find_mount(k_mountinfo, "/nfsx/a");
  REQUIRE(root);
  CHECK(root->type == "ext4");
  CHECK(root->point == "/");
  CHECK_FALSE(root->is_nfs());
  CHECK(find_mount(k_mountinfo, "/nfs")->has("soft"));
  CHECK(find_mount(k_mountinfo, "/nfs/b")->value("rsize") == "1048576");
  const auto nfs = find_mount(k_mountinfo, "/nfs/a/b");
  REQUIRE(nfs);
  CHECK(nfs->is_nfs());
  CHECK(nfs->source == "server:/export");
  CHECK(nfs->has("ro"));
  CHECK(nfs->value("vers") == "4.2");
  CHECK_FALSE(nfs->value("rsize"));
  CHECK(find_mount(k_mountinfo, "/with blank/x")->type == "xfs");
  CHECK_FALSE(find_mount("", "/"));
}

TEST_CASE("this machine's mounts and space are told") {
  const test::TempFolder folder;
  CHECK_FALSE(mount_of(folder.path()).type.empty());
  CHECK(free_bytes(folder.path()) > 0);
  CHECK_THROWS_AS(mount_of(folder / "absent"), IoError);
  CHECK_THROWS_AS(free_bytes(folder / "absent"), IoError);
}

TEST_CASE("scratch goes where it was told, else to TMPDIR if there is room, else to the stage") {
  const test::TempFolder folder;
  const auto own = folder / "own";
  const auto wanted = folder / "wanted";
  const auto stage = folder / "stage";
  for (const auto& each : {own, wanted, stage}) std::filesystem::create_directory(each);
  const char* set = std::getenv("TMPDIR");
  const std::string before = set == nullptr ? "" : set;
  constexpr std::uint64_t k_too_much = std::uint64_t{1} << 60;
  set_log("test", LogLevel::off);
  ::unsetenv("TMPDIR");
  CHECK(scratch_folder({}, stage, 1000) == stage);
  ::setenv("TMPDIR", own.c_str(), 1);
  CHECK(scratch_folder({}, stage, 1000) == own);
  CHECK(scratch_folder(wanted, stage, 1000) == wanted);
  ::setenv("TMPDIR", (folder / "absent").c_str(), 1);
  CHECK(scratch_folder({}, stage, 1000) == stage);
  set_log("test", LogLevel::info);
  CHECK_THROWS_WITH_AS(scratch_folder(folder / "absent", stage, 0), doctest::Contains("absent"),
                       DataError);
  CHECK_THROWS_WITH_AS(scratch_folder(wanted, stage, k_too_much),
                       doctest::Contains("--scratch FOLDER"), DataError);
  before.empty() ? ::unsetenv("TMPDIR") : ::setenv("TMPDIR", before.c_str(), 1);
}

TEST_CASE("whether there is room is found by writing") {
  const test::TempFolder folder;
  probe_room(folder.path(), 3'000'000);
  CHECK(std::filesystem::is_empty(folder.path()));
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &before) == 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit little{2'000'000, before.rlim_max};
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &little) == 0);
  CHECK_THROWS_AS(probe_room(folder.path(), 3'000'000), IoError);
  probe_room(folder.path(), 1'000'000);
  ::setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("a probe measures, and leaves nothing behind") {
  const test::TempFolder folder;
  const FolderProbe probe = probe_folder(folder.path(), 3, 10'000);
  CHECK(probe.problem.empty());
  REQUIRE(probe.trips.size() == 3);
  for (const RoundTrip& trip : probe.trips) {
    CHECK(trip.write > 0);
    CHECK(trip.sync > 0);
    CHECK(trip.rename > 0);
    CHECK(trip.read > 0);
  }
  CHECK(probe.clock_ahead_s > -1);
  CHECK(probe.clock_ahead_s < 1);
  CHECK(probe.keeps_private);
  CHECK(probe.has_links);
  CHECK(std::filesystem::is_empty(folder.path()));
}

TEST_CASE("the server's clock is told by a file, or not at all") {
  const test::TempFolder folder;
  const auto first = server_clock(folder.path());
  REQUIRE(first);
  std::ofstream(folder / "later") << "x";
  const auto later = std::filesystem::last_write_time(folder / "later");
  CHECK(later >= *first);
  CHECK(later - *first < std::chrono::seconds(20));
  std::filesystem::remove(folder / "later");
  CHECK(std::filesystem::is_empty(folder.path()));
  CHECK_FALSE(server_clock(folder / "absent"));
  const auto seconds = server_unix_s(folder.path());
  REQUIRE(seconds);
  CHECK(std::abs(*seconds - static_cast<double>(std::time(nullptr))) < 20);
  CHECK_FALSE(server_unix_s(folder / "absent"));
}

TEST_CASE("a private file leaves nothing behind either") {
  const test::TempFolder folder;
  CHECK(keeps_private(folder.path()));
  CHECK(std::filesystem::is_empty(folder.path()));
  CHECK_THROWS_AS(keeps_private(folder / "absent"), IoError);
}

TEST_CASE("a probe says what went wrong") {
  const test::TempFolder folder;
  const FolderProbe probe = probe_folder(folder / "absent", 3, 10);
  CHECK(probe.problem.find("absent") != std::string::npos);
  CHECK(probe.trips.empty());
}
