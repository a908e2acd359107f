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

// What the summaries of runs and of meshes share.

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

/// "material: 3 (stone, glass, steel)"; of many the first.
std::string text_of(const LabelMeaning& labels);
/// Null where there are none.
Json to_json(const std::optional<LabelMeaning>& labels);
/// The input must have some.
std::string text_of(const TexturesMade& textures);
/// Null where the input has none.
Json to_json(const TexturesMade& textures);
Json to_json(const Box& box);
Json to_json(const Topology& topology);
/// As fractions of the diagonal.
Json to_json(const Distance& distance, double diagonal);
/// Null where they were not measured.
Json to_json(const std::optional<NormalDeviation>& normals);
/// The greater of both directions, and both.
Json to_json(const MeasuredError& error, double diagonal);
/// As fractions of the diagonal; null where they were not measured.
void add_quantiles(const std::optional<DistanceQuantiles>& quantiles, double diagonal, Json& json);
std::string text_of(const NormalDeviation& normals);
std::string text_of(const Topology& topology);
/// "1 component", "2,000 components".
std::string counted(std::uint64_t count, std::string_view thing);
/// Genus, of all pieces together. Nothing where borders or edges that are not manifold make the
/// Euler characteristic tell more than handles.
std::optional<std::int64_t> handles_of(const Topology& topology);
Json to_json(const SurfaceFigures& figures);
void add_figures(Lines& lines, const std::string& label, const SurfaceFigures& figures);
/// As the file has it only where that is something else than the welded.
void add_topology(Lines& lines, const std::string& label, const Topology& welded,
                  const Topology& as_it_is);
std::string text_of(const Distance& distance, double diagonal);
/// Throws DataError naming `what`.
RunTimes run_times_of(const Json& summary, std::string_view what);
/// What is written to a file or a terminal; text that is no UTF-8 is replaced.
std::string dumped(const Json& json);

}  // namespace meshfarm
