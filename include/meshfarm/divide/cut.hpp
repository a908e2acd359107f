// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/staging/stage.hpp>

namespace meshfarm {

struct CutOptions {
  std::uint32_t parts = 0;         // 0: default_parts() of the input's triangles
  Weld weld = Weld::exact;         // vertices at the same position become one
  std::string input_name;          // kept in the manifest, for people
  unsigned threads = 0;            // 0: one a core; the parts do not depend on it
  std::uint64_t memory_bytes = 0;  // of the parts that are made at once; 0: no limit
  std::filesystem::path scratch;   // where per-vertex state goes; empty: see scratch_folder()
  /// Told what is being done and how far it is (0..1); may be empty.
  std::function<void(std::string_view phase, double done)> progress;
  const std::atomic<bool>* stop = nullptr;
};

/// Parts of about a million triangles, but at least sixteen of a mesh that is worth cutting.
std::uint32_t default_parts(std::uint64_t triangles);

/// Cuts a mesh into parts and publishes them in the stage: parts, boundary side file, manifest last
/// (Xiong et al. 2008, 3.1). The parts depend on the input and on options.parts and options.weld
/// only. No part has more than 1.15 times as many vertices as the mean, however they lie. Memory: a
/// million cells at most (1 GB while METIS works on them), and one part a thread; per-vertex state
/// lives in mapped scratch files. Degenerate triangles are dropped and counted. Throws DataError,
/// IoError; IncompleteError when stopped.
Manifest cut_mesh(MeshSource& source, const Stage& stage, const CutOptions& options);

}  // namespace meshfarm
