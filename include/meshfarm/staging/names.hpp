// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace meshfarm {

/// All names in a stage are made and parsed here, relative to the stage's folder:
///
///   manifest                          what the cut made; published last, never changed
///   boundary                          the boundary triangles
///   cut                               what was cut, and how: by this the same command goes on
///   channels                          the input's vertices with their colours and other values
///   parts/000123.part                 a sub-mesh
///   parts/000123.picture              a picture of the input's materials, as it was
///   streams/000123.stream             a mesh in sweep order, by --scheme stream
///   streams/000123.slab               the same before it is sorted, by --sort farm
///   results/KEY.aATTEMPT.INCARNATION  a job's output; KEY names the job by content, 16 hex digits
///   journal/000001                    accepted results, one file a sink incarnation
///   control/000001.endpoint           where a ventilator listens, one file an epoch
///   control/ID.host                   a host that worked on this stage, 16 hex digits
///   control/RUN.keys                  what the processes of a run prove themselves by, 16 hex
///   digits
///   log/000001.trace                  what happened in an epoch, told by its ventilator
///   log/000001.summary                what a run made, told by its sink
struct ManifestName {};
struct BoundaryName {};
struct CutName {};
struct ChannelsName {};
struct PartName {
  std::uint32_t part = 0;
};
struct PictureName {
  std::uint32_t picture = 0;
};
struct StreamName {
  std::uint32_t stream = 0;
};
struct SlabName {
  std::uint32_t slab = 0;
};
struct ResultName {
  std::uint64_t key = 0;
  std::uint32_t attempt = 0;
  std::uint64_t incarnation = 0;
};
struct JournalName {
  std::uint32_t number = 0;
};
struct EndpointName {
  std::uint32_t epoch = 0;
};
struct KeysName {
  std::uint64_t run = 0;
};
struct TraceName {
  std::uint32_t epoch = 0;
};
struct SummaryName {
  std::uint32_t number = 0;
};
struct HostName {
  std::uint64_t boot = 0;
};
using StagedName = std::variant<ManifestName, BoundaryName, PartName, StreamName, ResultName,
                                JournalName, EndpointName, KeysName, TraceName, SummaryName,
                                HostName, SlabName, CutName, ChannelsName, PictureName>;

std::string to_string(const StagedName& name);
/// The name that to_string would turn into this text; nothing for any other text.
std::optional<StagedName> parse_staged_name(std::string_view text);

/// The folders of a stage, all created before a run starts: workers create none.
inline constexpr std::array<std::string_view, 6> k_stage_folders = {"parts",   "streams", "results",
                                                                    "journal", "control", "log"};

}  // namespace meshfarm
