// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/divide/block_cut.hpp>
#include <meshfarm/farm/job.hpp>
#include <meshfarm/io/manifest.hpp>

namespace meshfarm {

// The jobs of a cut by blocks of the input (divide/block_cut.hpp), in the order of their stages. A
// simplify job builds its part itself.

inline constexpr std::string_view k_survey_kind = "survey";
inline constexpr std::string_view k_count_kind = "count";
inline constexpr std::string_view k_partition_kind = "partition";
inline constexpr std::string_view k_vertices_kind = "scatter-vertices";
inline constexpr std::string_view k_triangles_kind = "scatter-triangles";
inline constexpr std::string_view k_join_kind = "join";

/// Whether the job's output is bundles, or leads to them: only workers read these, and each section
/// has its own checksum.
bool is_left_to_readers(std::string_view kind);

/// Parameters of all jobs but the join. A job reads everything else it needs from the stage's
/// manifest.
struct CutJobParameters {
  Cutting cutting;
  std::uint32_t block = 0;
  std::uint32_t round = 0;  // of counting: the first starts from the box, later ones from a file
  Box box;                  // of the first round
  BundlesOfMesh bundles;    // to scatter triangles: the bundles of the vertices
};
std::string encode_parameters(const CutJobParameters& parameters);
CutJobParameters decode_cut_parameters(std::string_view bytes);

std::string encode_summary(const BlockSurvey& survey);
BlockSurvey decode_survey(std::string_view summary, std::string_view what);

struct PartitionSummary {
  bool counts_again = false;
  std::uint32_t parts = 0;
};
std::string encode_summary(const PartitionSummary& summary);
PartitionSummary decode_partition_summary(std::string_view summary, std::string_view what);

/// The section of a ladder's file that describes its boundary vertices.
struct PartNumbers {
  FileRef file;
  FileSection section;
};
/// Parameters of a join.
struct JoinParameters {
  std::uint32_t group = 0;           // of regions
  BundlesOfMesh bundles;             // of triangles
  std::vector<PartNumbers> numbers;  // of all parts
};
std::string encode_parameters(const JoinParameters& parameters);
JoinParameters decode_join_parameters(std::string_view bytes);

/// The output is a boundary file.
struct JoinSummary {
  FileSection index;
  std::uint64_t triangles = 0;
  std::uint64_t degenerate = 0;
  std::uint64_t coincident = 0;
  std::uint64_t duplicate = 0;
};
std::string encode_summary(const JoinSummary& summary);
JoinSummary decode_join_summary(std::string_view summary, std::string_view what);

JobOutput survey_vertices_of_block(const Job& job, const JobContext& context);
JobOutput count_vertices_of_block(const Job& job, const JobContext& context);
JobOutput partition_cells_of_blocks(const Job& job, const JobContext& context);
JobOutput scatter_vertices_of_block(const Job& job, const JobContext& context);
JobOutput scatter_triangles_of_block(const Job& job, const JobContext& context);
JobOutput join_boundary_of_parts(const Job& job, const JobContext& context);

struct CutPlanOptions {
  std::uint32_t parts = 0;   // 0: as many as a local cut would make
  std::uint32_t blocks = 0;  // of vertices, and of triangles; 0: about 300,000 in each
  bool for_cluster = false;  // more parts by default, so that two dozen workers end together
};
/// The plan to cut this file by jobs; nothing if its records cannot be read independently. Throws
/// IoError.
std::optional<Cutting> plan_cutting(const std::filesystem::path& input,
                                    const CutPlanOptions& options);

}  // namespace meshfarm
