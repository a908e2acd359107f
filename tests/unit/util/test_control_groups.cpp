// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <fstream>
#include <string>

#include <doctest/doctest.h>

#include <meshfarm/util/control_groups.hpp>

#include "support/temp_folder.hpp"

namespace meshfarm {
namespace {

/// A tree of control groups made of plain files.
class MadeGroups {
 public:
  MadeGroups(const std::string& cgroup, const std::string& mountinfo) {
    put("proc/cgroup", cgroup);
    put("proc/mountinfo", mountinfo);
  }
  void put(const std::string& name, const std::string& text) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path) << text << "\n";
  }
  GroupView view() const { return {folder_ / "proc", folder_.path()}; }
  std::optional<std::uint64_t> room() const {
    const auto memory = group_memory(view());
    if (!memory) return std::nullopt;
    return memory->room;
  }

 private:
  test::TempFolder folder_;
};

const std::string k_two = "31 23 0:28 / /sys/fs/cgroup rw,relatime - cgroup2 cgroup2 rw,nsdelegate";
const std::string k_one =
    "31 23 0:28 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n"
    "32 23 0:29 / /sys/fs/cgroup/cpu,cpuacct rw shared:9 - cgroup cgroup rw,cpu,cpuacct";

TEST_CASE("page cache that nobody uses is room, in both versions") {
  MadeGroups two("0::/job", k_two);
  two.put("sys/fs/cgroup/job/memory.max", "2000");
  two.put("sys/fs/cgroup/job/memory.current", "1950");
  CHECK(two.room() == 50);
  two.put("sys/fs/cgroup/job/memory.stat", "anon 50\ninactive_file 1900\nactive_file 0");
  CHECK(two.room() == 1950);

  MadeGroups one("4:memory:/job\n0::/", k_one);
  one.put("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "2000");
  one.put("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "1950");
  one.put("sys/fs/cgroup/memory/job/memory.stat", "inactive_file 3\ntotal_inactive_file 1900");
  CHECK(one.room() == 1950);
}

TEST_CASE("the least room of all groups above counts, and names its group") {
  MadeGroups two("0::/slurm/job_1/step_0", k_two);
  const std::string top = "sys/fs/cgroup/slurm/";
  two.put(top + "job_1/step_0/memory.max", "max");
  two.put(top + "job_1/step_0/memory.current", "10");
  two.put(top + "job_1/memory.max", "1000");
  two.put(top + "job_1/memory.current", "400");
  two.put(top + "memory.max", "5000");
  two.put(top + "memory.current", "4900");
  CHECK(two.room() == 100);
  const auto above = group_memory(two.view());
  two.put(top + "memory.current", "1000");
  CHECK(two.room() == 600);
  const auto job = group_memory(two.view());
  CHECK(job->group != above->group);
  CHECK(job->group != 0);
  two.put(top + "job_1/memory.high", "500");  // above this limit the kernel slows the group down
  CHECK(two.room() == 100);

  MadeGroups one("4:memory:/slurm/uid_0/job_1", k_one);
  const std::string v1 = "sys/fs/cgroup/memory/slurm/";
  const auto none = std::to_string(0x7ffffffffffff000);
  one.put(v1 + "uid_0/job_1/memory.limit_in_bytes", none);
  one.put(v1 + "uid_0/job_1/memory.usage_in_bytes", "1");
  CHECK_FALSE(one.room());
  one.put(v1 + "uid_0/memory.limit_in_bytes", "700");
  one.put(v1 + "uid_0/memory.usage_in_bytes", "300");
  CHECK(one.room() == 400);
}

TEST_CASE("of groups with one limit the outer one is named, whatever is counted at the moment") {
  MadeGroups slurm("4:memory:/job_1/step_0/task_0", k_one);
  const std::string job = "sys/fs/cgroup/memory/job_1/";
  const auto put = [&](const std::string& group, const std::string& limit,
                       const std::string& used) {
    slurm.put(group + "memory.limit_in_bytes", limit);
    slurm.put(group + "memory.usage_in_bytes", used);
    slurm.put(group + "memory.stat", "hierarchical_memory_limit 2000");
  };
  put(job, "2000", "300");
  put(job + "step_0/", "2000", "250");
  put(job + "step_0/task_0/", std::to_string(0x7ffffffffffff000), "120");
  const auto before = group_memory(slurm.view());
  CHECK(before->room == 1700);
  put(job + "step_0/", "2000", "310");  // a process ended before the job's count was read
  const auto after = group_memory(slurm.view());
  CHECK(after->room == 1690);
  CHECK(after->group == before->group);
  put(job + "step_0/", "500", "310");  // a step with a lower limit than the job
  CHECK(group_memory(slurm.view())->room == 190);
  CHECK(group_memory(slurm.view())->group != before->group);
}

TEST_CASE("a container that does not see the groups above hears of their limit in version 1") {
  MadeGroups one("4:memory:/docker/abc",
                 "31 23 0:28 /docker/abc /sys/fs/cgroup/memory ro - cgroup cgroup rw,memory");
  one.put("sys/fs/cgroup/memory/memory.limit_in_bytes", "5000");
  one.put("sys/fs/cgroup/memory/memory.usage_in_bytes", "100");
  one.put("sys/fs/cgroup/memory/memory.stat", "hierarchical_memory_limit 1100");
  CHECK(one.room() == 1000);
}

TEST_CASE("a full group has no room, which is not the same as no limit") {
  MadeGroups two("0::/job", k_two);
  CHECK_FALSE(two.room());
  two.put("sys/fs/cgroup/job/memory.max", "1000");
  two.put("sys/fs/cgroup/job/memory.current", "1200");
  CHECK(two.room() == 0);
  two.put("sys/fs/cgroup/job/memory.max", "max");
  CHECK_FALSE(two.room());
}

TEST_CASE("where both versions are mounted the one with the limit counts") {
  MadeGroups both("4:memory:/a\n0::/b",
                  k_one + "\n41 31 0:38 / /sys/fs/cgroup/unified rw - cgroup2 cgroup2 rw");
  both.put("sys/fs/cgroup/unified/b/memory.max", "70");
  both.put("sys/fs/cgroup/unified/b/memory.current", "0");
  CHECK(both.room() == 70);
  both.put("sys/fs/cgroup/memory/a/memory.limit_in_bytes", "60");
  both.put("sys/fs/cgroup/memory/a/memory.usage_in_bytes", "0");
  CHECK(both.room() == 60);
}

TEST_CASE("the least share of the cores of all groups above counts") {
  MadeGroups two("0::/slurm/job", k_two);
  CHECK_FALSE(group_cores(two.view()));
  two.put("sys/fs/cgroup/slurm/job/cpu.max", "max 100000");
  CHECK_FALSE(group_cores(two.view()));
  two.put("sys/fs/cgroup/slurm/cpu.max", "250000 100000");
  CHECK(group_cores(two.view()) == 2.5);
  two.put("sys/fs/cgroup/slurm/job/cpu.max", "33000 100000");
  CHECK(group_cores(two.view()) == 0.33);

  MadeGroups one("2:cpu,cpuacct:/a/b", k_one);
  one.put("sys/fs/cgroup/cpu,cpuacct/a/b/cpu.cfs_quota_us", "-1");
  one.put("sys/fs/cgroup/cpu,cpuacct/a/b/cpu.cfs_period_us", "100000");
  CHECK_FALSE(group_cores(one.view()));
  one.put("sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_quota_us", "150000");
  one.put("sys/fs/cgroup/cpu,cpuacct/a/cpu.cfs_period_us", "100000");
  CHECK(group_cores(one.view()) == 1.5);
}

TEST_CASE("there is a processor, and no groups are no limit") {
  CHECK(processors() >= 1);
  const test::TempFolder nothing;
  CHECK_FALSE(group_memory({nothing.path(), nothing.path()}));
  CHECK_FALSE(group_cores({nothing.path(), nothing.path()}));
}

}  // namespace
}  // namespace meshfarm
