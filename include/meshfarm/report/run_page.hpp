// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <meshfarm/geometry/value_error.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/report/trace.hpp>

namespace meshfarm {

struct PagePicture {
  std::string png;  // the file's content
  std::uint32_t width = 0;
  std::uint32_t height = 0;
};

/// The input and the result in the same view.
struct PicturePair {
  std::string caption;
  PagePicture input;
  PagePicture result;
};

/// How far the input is from the result, by fractions of its area. Distances are in the mesh's
/// unit.
struct ErrorHistogram {
  double end = 0;              // of the last bin; also the end of the map's colour scale
  std::vector<double> shares;  // of the bins, evenly spaced from 0
  double beyond = 0;           // the fraction that is farther
};

/// Pictures of both meshes.
struct PageScene {
  std::vector<PicturePair> views;
  PicturePair zoom;              // with the edges of triangles
  PagePicture parts;             // of the input
  PagePicture map;               // of the result, coloured by `histogram`
  std::string model;             // from encode_model(); empty: the result is too large for a page
  std::array<double, 9> axes{};  // the initial view: right, up, toward the viewer
  std::vector<std::array<std::uint8_t, 3>> scale;  // colours from 0 to histogram.end
};

/// Measurements of both meshes for the page.
struct PageFigures {
  SurfaceError to_result;  // from points of the input
  std::uint64_t samples = 0;
  ErrorHistogram histogram;
  SurfaceFigures input;
  SurfaceFigures result;
};

/// The page of a run. What is missing here is left out of the page.
struct RunPage {
  Manifest manifest;
  Trace trace;
  std::string summary;             // as JSON; empty: the run has not ended
  std::string command;             // that repeats the run
  std::vector<std::string> notes;  // what the page lacks, and why
  std::optional<PageScene> scene;
  std::optional<PageFigures> figures;
};

/// One HTML page that loads nothing. The same run gives the same page, except for times.
std::string render_run_page(const RunPage& page);

/// Where a run's result was written, and its counts, from the run's summary as JSON.
struct RunResult {
  std::string path;
  std::uint64_t triangles = 0;
  std::optional<std::uint64_t> crossing_triangles = {};
};
/// Throws DataError naming `what`.
RunResult parse_run_result(std::string_view text, std::string_view what);

/// A compact mesh: 16 bits per coordinate, 8 for a value from 0 to 1 per vertex, and about 12 per
/// triangle. src/report/page.js reads it.
std::string encode_model(const Mesh& mesh, std::span<const float> values);

}  // namespace meshfarm
