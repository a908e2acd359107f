// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/report/clean_report.hpp>

#include "report/json.hpp"
#include "report/lines.hpp"

namespace meshfarm {
namespace {

std::string padded(std::string label) {
  constexpr std::size_t k_width = 17;
  label.resize(std::max(label.size() + 1, k_width), ' ');
  return label;
}

std::string as_json(const CleanReport& report) {
  Json removed = Json::array();
  std::uint64_t bytes = 0;
  for (const CleanReport::Removed& each : report.removed) {
    removed.push_back({{"what", each.what}, {"files", each.files}, {"bytes", each.bytes}});
    bytes += each.bytes;
  }
  const Json json = {{"stage", report.stage},
                     {"dry_run", report.dry_run},
                     {"removed", removed},
                     {"bytes", bytes},
                     {"kept", report.kept}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string render(const CleanReport& report, Format format) {
  if (format == Format::json) return as_json(report);
  std::string text = padded("stage") + report.stage + "\n";
  const std::string label = report.dry_run ? "would remove" : "removed";
  CleanReport::Removed all;
  for (const CleanReport::Removed& each : report.removed) {
    all.files += each.files;
    all.bytes += each.bytes;
    text += padded(label) + grouped(each.files) + (each.files == 1 ? " file, " : " files, ") +
            grouped(each.bytes) + " bytes: " + each.what + "\n";
  }
  for (const std::string& each : report.kept) text += padded("kept") + each + "\n";
  return text + padded("in all") + grouped(all.files) + (all.files == 1 ? " file, " : " files, ") +
         grouped(all.bytes) + " bytes\n";
}

}  // namespace meshfarm
