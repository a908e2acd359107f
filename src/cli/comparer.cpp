// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include "cli/comparer.hpp"

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include <meshfarm/divide/divided_distance.hpp>
#include <meshfarm/geometry/crossings.hpp>
#include <meshfarm/geometry/hausdorff.hpp>
#include <meshfarm/geometry/quantile.hpp>
#include <meshfarm/geometry/surface_measures.hpp>
#include <meshfarm/geometry/value_error.hpp>
#include <meshfarm/io/channel_pairs.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/render/colour_scale.hpp>
#include <meshfarm/util/errors.hpp>

#include "cli/compared_mesh.hpp"
#include "cli/measure_words.hpp"

namespace meshfarm {
namespace {

/// Per triangle, with the label numbers shared by both meshes.
constexpr std::uint64_t k_bytes_of_labels = 2 * sizeof(Label);

/// Maximum gap between the bounds of a distance: as a fraction of the diagonal, or of the distance.
constexpr double k_certified_gap = 1e-5;
constexpr double k_certified_relative_gap = 0.01;

/// Memory to hold both meshes, and the hierarchy of one at a time.
std::uint64_t memory_for(const DividedSurface& a, const DividedSurface& b) {
  const bool a_is_larger = a.triangles() > b.triangles();
  const DividedSurface& larger = a_is_larger ? a : b;
  const DividedSurface& other = a_is_larger ? b : a;
  return memory_to_hold(larger.vertices(), larger.triangles()) + sizeof(Vec3) * other.vertices() +
         sizeof(Triangle) * other.triangles();
}

/// Additional memory to bound distances: both meshes again, without what is not surface.
std::uint64_t memory_for_bounds(const DividedSurface& a, const DividedSurface& b) {
  return (sizeof(Vec3) + sizeof(std::uint32_t)) * (a.vertices() + b.vertices()) +
         sizeof(Triangle) * (a.triangles() + b.triangles());
}

class MeshComparer {
 public:
  MeshComparer(const std::string& path_a, const std::string& path_b, const CompareOptions& options)
      : options_(options),
        source_a_(open_mesh(path_a, {.textures = Textures::keep})),
        source_b_(open_mesh(path_b, {.textures = Textures::keep})),
        channels_(pair_channels(compared_channels(source_a_->info()),
                                compared_channels(source_b_->info()))),
        a_(*source_a_, each(options.divide)),
        b_(*source_b_, each(options.divide)) {
    options_.distance.threads = options.divide.threads;
    comparison_.path_a = path_a;
    comparison_.path_b = path_b;
    comparison_.channels_only_a = channels_.only_a;
    comparison_.channels_only_b = channels_.only_b;
    comparison_.diagonal = a_.box().diagonal();
  }

  Comparison compare() {
    const std::uint64_t memory = options_.divide.memory_bytes;
    const std::uint64_t meshes =
        memory_for(a_, b_) + (options_.certify ? memory_for_bounds(a_, b_) : 0);
    const bool have_labels = source_a_->info().labels && source_b_->info().labels;
    const std::uint64_t values =
        sizeof(float) * channels_.columns_a.size() * (a_.vertices() + b_.vertices()) +
        (have_labels ? k_bytes_of_labels * (a_.triangles() + b_.triangles()) : 0);
    if (values > 0 && meshes + values <= memory) {
      compare_with_values(have_labels);
    } else if (meshes <= memory) {
      const Mesh a = read_mesh(*source_a_), b = read_mesh(*source_b_);
      measure_held({a, {}}, {b, {}}, {});
    } else if (!options_.map.empty()) {
      throw UsageError("--map: " + why_too_little(meshes, memory));
    } else if (options_.certify) {
      throw UsageError("--certify: " + why_too_little(meshes, memory));
    } else {
      measure_divided();
      comparison_.not_measured = why_too_little(meshes, memory);
    }
    if (values > 0 && meshes + values > memory) {
      const std::string why = why_too_little(meshes + values, memory);
      if (!channels_.pairs.empty()) comparison_.channels_skipped = why;
      if (have_labels) comparison_.labels_skipped = why;
    }
    measure_topology();
    return std::move(comparison_);
  }

 private:
  static DivideOptions each(DivideOptions divide) {
    divide.memory_bytes /= 2;
    return divide;
  }

  void compare_with_values(bool have_labels) {
    ComparedMesh a(*source_a_, comparison_.path_a, channels_.columns_a, a_.vertices());
    ComparedMesh b(*source_b_, comparison_.path_b, channels_.columns_b, b_.vertices());
    if (have_labels) {
      const LabelMeaning& meaning_a = *source_a_->info().labels;
      const LabelMeaning& meaning_b = *source_b_->info().labels;
      ComparedMesh::pair_labels(a, meaning_a, b, meaning_b);
      comparison_.labels = {meaning_a.name, meaning_b.name, 0, 0};
    }
    std::vector<ValueGroup> groups;
    for (const ChannelPair& pair : channels_.pairs) {
      const bool is_direction = pair.role == ChannelRole::normal;
      groups.push_back({is_direction ? ValueKind::direction : ValueKind::numbers, pair.columns});
    }
    measure_held(a.valued(), b.valued(), groups);
    const SurfaceError& a_to_b = comparison_.a_to_b;
    const SurfaceError& b_to_a = comparison_.b_to_a;
    if (comparison_.labels) {
      comparison_.labels->a_to_b = a_to_b.other_labels;
      comparison_.labels->b_to_a = b_to_a.other_labels;
    }
    for (std::size_t i = 0; i < channels_.pairs.size(); ++i) {
      comparison_.channels.push_back(
          {channels_.pairs[i].name, channels_.pairs[i].role, a_to_b.values[i], b_to_a.values[i]});
    }
  }

  void measure_held(const ValuedMesh& a, const ValuedMesh& b, std::span<const ValueGroup> groups) {
    comparison_.a_to_b = measure_error(
        a, b, groups, options_.distance,
        [&](const TriangleIndex& index) { count_crossings(index, comparison_.figures_b); });
    comparison_.b_to_a =
        measure_error(b, a, groups, options_.distance, [&](const TriangleIndex& index) {
          count_crossings(index, comparison_.figures_a);
          if (!options_.map.empty()) write_map(index, b.mesh);
        });
    measure_shape(a.mesh, comparison_.figures_a);
    measure_shape(b.mesh, comparison_.figures_b);
    if (options_.certify)
      certify({a.mesh.positions, a.mesh.triangles}, {b.mesh.positions, b.mesh.triangles});
  }

  void certify(Mesh a, Mesh b) {
    drop_coincident_corners(a);
    drop_coincident_corners(b);
    HausdorffOptions options;
    options.gap = k_certified_gap * comparison_.diagonal;
    options.relative_gap = k_certified_relative_gap;
    options.threads = options_.divide.threads;
    comparison_.certified = {bound_distance(a, b, options), bound_distance(b, a, options)};
  }

  void count_crossings(const TriangleIndex& index, SurfaceFigures& figures) const {
    figures.crossing_triangles =
        count_crossing_triangles(index, {.threads = options_.divide.threads});
    if (!figures.crossing_triangles) figures.crossings_skipped = k_too_many_at_one_place;
  }

  void write_map(const TriangleIndex& a, const Mesh& b) {
    constexpr double k_brightest = 0.99;  // this share of the vertices is darker: few are far off
    const std::vector<float> distances = distances_to(a, b.positions, options_.divide.threads);
    const float most =
        distances.empty() ? 0 : *std::max_element(distances.begin(), distances.end());
    std::vector<float> sorted = distances;
    const float brightest = quantile(std::span(sorted), k_brightest);
    const std::vector<Channel> channels = distance_channels();
    std::vector<float> values;
    values.reserve(distances.size() * channels.size());
    for (const float distance : distances) {
      values.push_back(distance);
      for (const std::uint8_t part : colour_on_scale(brightest > 0 ? distance / brightest : 0)) {
        values.push_back(part);
      }
    }
    write_mesh(options_.map, {b.positions, b.triangles}, source_b_->info().positions, channels,
               values);
    comparison_.map = {options_.map, most};
  }

  void measure_shape(const Mesh& mesh, SurfaceFigures& figures) const {
    ShapeMeter meter(options_.divide.threads);
    meter.add(mesh.positions, mesh.triangles);
    figures.shape = meter.measures();
    figures.edges = measure_edge_lengths(mesh, options_.divide.threads);
  }

  void measure_divided() {
    comparison_.a_to_b = measure_error(a_, b_, options_.distance);
    comparison_.b_to_a = measure_error(b_, a_, options_.distance);
    comparison_.figures_a.shape = shape_of(a_);
    comparison_.figures_b.shape = shape_of(b_);
  }

  ShapeMeasures shape_of(const DividedSurface& surface) const {
    ShapeMeter meter(options_.divide.threads);
    surface.show([&](std::span<const Vec3> positions, std::span<const Triangle> triangles) {
      meter.add(positions, triangles);
    });
    return meter.measures();
  }

  void measure_topology() {
    const SurfaceTopology of_a = a_.measure_topology();
    const SurfaceTopology of_b = b_.measure_topology();
    comparison_.welded_a = of_a.welded;
    comparison_.welded_b = of_b.welded;
    comparison_.as_it_is_a = of_a.as_it_is;
    comparison_.as_it_is_b = of_b.as_it_is;
    comparison_.figures_a.is_closed = of_a.welded.unmatched_edges == 0;
    comparison_.figures_b.is_closed = of_b.welded.unmatched_edges == 0;
  }

  CompareOptions options_;
  std::unique_ptr<MeshSource> source_a_;
  std::unique_ptr<MeshSource> source_b_;
  ChannelPairs channels_;
  DividedSurface a_;
  DividedSurface b_;
  Comparison comparison_;
};

}  // namespace

std::vector<Channel> distance_channels() {
  return {{"quality"},
          {"red", ChannelType::uint8, ChannelRole::colour},
          {"green", ChannelType::uint8, ChannelRole::colour},
          {"blue", ChannelType::uint8, ChannelRole::colour}};
}

Comparison compare_meshes(const std::string& path_a, const std::string& path_b,
                          const CompareOptions& options) {
  return MeshComparer(path_a, path_b, options).compare();
}

}  // namespace meshfarm
