// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/mesh.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/io/channel.hpp>
#include <meshfarm/io/labels.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/util/text.hpp>

#include "report/json.hpp"
#include "report/lines.hpp"

namespace meshfarm {

// Shared by the summaries of runs and of meshes.

/// A table of "label  value" lines.
class Lines {
 public:
  void add(const std::string& label, const std::string& value) {
    std::string padded = label;
    padded.resize(std::max<std::size_t>(padded.size(), 16), ' ');
    text_ += padded + " " + value + "\n";
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::vector<std::string> names_of(const std::vector<Channel>& channels);

/// "material: 3 (stone, glass, steel)"; only the first names if there are many.
std::string text_of(const LabelMeaning& labels);
/// Null if there are none.
Json to_json(const std::optional<LabelMeaning>& labels);
/// Requires that the input has textures.
std::string text_of(const TexturesMade& textures);
/// Null if the input has none.
Json to_json(const TexturesMade& textures);
Json to_json(const Box& box);
Json to_json(const Topology& topology);
/// As fractions of the diagonal.
Json to_json(const Distance& distance, double diagonal);
/// Null if not measured.
Json to_json(const std::optional<NormalDeviation>& normals);
/// Both directions, and the larger values of the two.
Json to_json(const MeasuredError& error, double diagonal);
/// As fractions of the diagonal; null if not measured.
void add_quantiles(const std::optional<DistanceQuantiles>& quantiles, double diagonal, Json& json);
std::string text_of(const NormalDeviation& normals);
std::string text_of(const Topology& topology);
/// "1 component", "2,000 components".
std::string counted(std::uint64_t count, std::string_view thing);
/// The genus of all components together. Nothing if borders or non-manifold edges make the Euler
/// characteristic count more than handles.
std::optional<std::int64_t> handles_of(const Topology& topology);
Json to_json(const SurfaceFigures& figures);
void add_figures(Lines& lines, const std::string& label, const SurfaceFigures& figures);
/// Adds the file's own topology only if it differs from the welded one.
void add_topology(Lines& lines, const std::string& label, const Topology& welded,
                  const Topology& as_it_is);
std::string text_of(const Distance& distance, double diagonal);
/// Throws DataError naming `what`.
RunTimes run_times_of(const Json& summary, std::string_view what);
/// The text for a file or a terminal; invalid UTF-8 is replaced.
std::string dumped(const Json& json);

}  // namespace meshfarm
