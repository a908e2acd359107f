// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <iostream>
#include <set>

#include <sys/resource.h>

#include <meshfarm/io/manifest.hpp>
#include <meshfarm/report/doctor.hpp>
#include <meshfarm/staging/host_card.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/transport/ventilator.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/log.hpp>

#include "cli/command.hpp"
#include "cli/options.hpp"

namespace meshfarm {
namespace {

constexpr int k_probe_files = 20;
constexpr std::size_t k_probe_bytes = 100'000;

class DoctorCommand : public Command {
 public:
  std::string_view name() const override { return "doctor"; }
  std::string_view synopsis() const override { return "STAGE"; }
  std::string_view summary() const override {
    return "check a shared folder and this host before a run, and say what to change";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("stage", po::value(&stage_)->required(), "")(
        "workers", po::value(&workers_)->default_value(workers_)->value_name("N"),
        "how many workers will join");
    talk_.add(options);
    positional.add("stage", 1);
  }
  int run() override {
    std::error_code error;
    if (!std::filesystem::is_directory(stage_, error)) {
      throw DataError(stage_ + ": no such folder");
    }
    DoctorFacts facts;
    facts.stage = stage_;
    facts.mount = mount_of(stage_);
    facts.free_bytes = free_bytes(stage_);
    facts.workers = workers_;
    facts.files_per_worker = k_files_per_worker;
    rlimit files{};
    if (::getrlimit(RLIMIT_NOFILE, &files) == 0) facts.file_limit = files.rlim_max;
    facts.host = this_host().host;
    // Results are published in a folder of the stage; before it exists, in the stage itself.
    const std::filesystem::path results = std::filesystem::path(stage_) / "results";
    const bool staged = std::filesystem::exists(results, error);
    facts.probe =
        probe_folder(staged ? results : results.parent_path(), k_probe_files, k_probe_bytes);
    if (staged) look_at_stage(facts);
    const std::vector<Finding> findings = diagnose(facts);
    std::cout << render(facts, findings, talk_.format());
    return is_healthy(findings) ? 0 : 1;
  }

 private:
  void look_at_stage(DoctorFacts& facts) const {
    const Stage stage = Stage::open(stage_);
    const Manifest manifest =
        decode_manifest(stage.read(ManifestName{}), stage.path(ManifestName{}).string());
    for (const PartEntry& part : manifest.parts) facts.part_bytes += part.file.size;
    if (manifest.cutting) facts.part_bytes = 2 * manifest.cutting->bytes;  // bundles and ladders
    if (manifest.sorting) facts.part_bytes *= 2;  // the streams are as large as the slabs
    try {
      publish_host_card(stage, this_host());
    } catch (const IoError& error) {
      log_debug(error.what());  // the probe reports why
    }
    const std::vector<HostCard> cards = read_host_cards(stage);
    std::set<std::string> names;
    for (const HostCard& card : cards) names.insert(card.host);
    facts.hosts.assign(names.begin(), names.end());
    facts.doubled_names = names_in_double_use(cards);
  }

  std::string stage_;
  std::uint32_t workers_ = 24;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_doctor_command() {
  return std::make_unique<DoctorCommand>();
}

}  // namespace meshfarm
