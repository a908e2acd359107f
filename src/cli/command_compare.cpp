// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <iostream>

#include <meshfarm/divide/divided_distance.hpp>
#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/value_error.hpp>
#include <meshfarm/io/channel_pairs.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/util/errors.hpp>

#include "cli/command.hpp"
#include "cli/compared_mesh.hpp"
#include "cli/measure_words.hpp"
#include "cli/options.hpp"

namespace meshfarm {
namespace {

class CompareCommand : public Command {
 public:
  std::string_view name() const override { return "compare"; }
  std::string_view synopsis() const override { return "A B"; }
  std::string_view summary() const override {
    return "sampled distances between two meshes and differences of their colours, normals, other "
           "values, and labels of triangles, both ways, and the topology of both";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("a", po::value(&a_)->required(), "")("b", po::value(&b_)->required(), "")(
        "samples", po::value(&distance_.samples)->default_value(distance_.samples)->value_name("N"),
        "points on each surface");
    measure_.add(options);
    talk_.add(options);
    positional.add("a", 1).add("b", 1);
  }
  void check() override {
    if (distance_.samples == 0) throw UsageError("--samples: at least 1");
    measure_.check();
  }
  int run() override {
    const auto source_a = open_mesh(a_, {.textures = Textures::keep});
    const auto source_b = open_mesh(b_, {.textures = Textures::keep});
    Comparison comparison;
    comparison.path_a = a_;
    comparison.path_b = b_;
    const ChannelPairs channels =
        pair_channels(compared_channels(source_a->info()), compared_channels(source_b->info()));
    comparison.channels_only_a = channels.only_a;
    comparison.channels_only_b = channels.only_b;
    DivideOptions divide = measure_.divide;
    divide.memory_bytes /= 2;  // each
    const DividedSurface a(*source_a, divide);
    const DividedSurface b(*source_b, divide);
    comparison.diagonal = a.box().diagonal();
    const std::uint64_t memory = measure_.divide.memory_bytes;
    const std::uint64_t meshes = memory_for(a, b);
    const bool have_labels = source_a->info().labels && source_b->info().labels;
    const std::uint64_t values =
        sizeof(float) * channels.columns_a.size() * (a.vertices() + b.vertices()) +
        (have_labels ? k_bytes_of_labels * (a.triangles() + b.triangles()) : 0);
    if (values > 0 && meshes + values <= memory) {
      ComparedMesh mesh_a(*source_a, a_, channels.columns_a, a.vertices());
      ComparedMesh mesh_b(*source_b, b_, channels.columns_b, b.vertices());
      if (have_labels) {
        const LabelMeaning& meaning_a = *source_a->info().labels;
        const LabelMeaning& meaning_b = *source_b->info().labels;
        ComparedMesh::pair_labels(mesh_a, meaning_a, mesh_b, meaning_b);
        comparison.labels = {meaning_a.name, meaning_b.name, 0, 0};
      }
      measure_all(mesh_a.valued(), mesh_b.valued(), channels, comparison);
    } else if (meshes <= memory) {
      measure(read_mesh(*source_a), read_mesh(*source_b), comparison);
    } else {
      measure(a, b, comparison);
    }
    if (values > 0 && meshes + values > memory) {
      const std::string why = "that takes --memory " + size_text(meshes + values) +
                              ", and there is " + size_text(memory);
      if (!channels.pairs.empty()) comparison.channels_skipped = why;
      if (have_labels) comparison.labels_skipped = why;
    }
    const SurfaceTopology topology_a = a.measure_topology();
    const SurfaceTopology topology_b = b.measure_topology();
    comparison.welded_a = topology_a.welded;
    comparison.welded_b = topology_b.welded;
    comparison.as_it_is_a = topology_a.as_it_is;
    comparison.as_it_is_b = topology_b.as_it_is;
    std::cout << render(comparison, talk_.format());
    return 0;
  }

 private:
  /// Of a triangle, with the numbers that both meshes share.
  static constexpr std::uint64_t k_bytes_of_labels = 2 * sizeof(Label);

  /// What it takes to hold both, and the hierarchy of one at a time.
  static std::uint64_t memory_for(const DividedSurface& a, const DividedSurface& b) {
    // While it is built, with what the allocator keeps: measured.
    constexpr std::uint64_t k_hierarchy_bytes = 72;
    return sizeof(Vec3) * (a.vertices() + b.vertices()) +
           sizeof(Triangle) * (a.triangles() + b.triangles()) +
           k_hierarchy_bytes * std::max(a.triangles(), b.triangles());
  }

  /// As --memory takes it; rounded up, so that it is enough.
  static std::string size_text(std::uint64_t bytes) {
    const bool is_large = bytes >= std::uint64_t{10} << 20;
    const unsigned shift = is_large ? 20 : 10;
    const std::uint64_t units = (bytes + (std::uint64_t{1} << shift) - 1) >> shift;
    return std::to_string(units) + (is_large ? "M" : "K");
  }

  DistanceOptions distance_options() const {
    DistanceOptions options = distance_;
    options.threads = measure_.divide.threads;
    return options;
  }

  template <class Surface>
  void measure(const Surface& a, const Surface& b, Comparison& comparison) const {
    comparison.a_to_b = measure_distance(a, b, distance_options());
    comparison.b_to_a = measure_distance(b, a, distance_options());
  }

  /// Distances, channels and labels.
  void measure_all(const ValuedMesh& a, const ValuedMesh& b, const ChannelPairs& channels,
                   Comparison& comparison) const {
    std::vector<ValueGroup> groups;
    for (const ChannelPair& pair : channels.pairs) {
      const bool is_direction = pair.role == ChannelRole::normal;
      groups.push_back({is_direction ? ValueKind::direction : ValueKind::numbers, pair.columns});
    }
    const SurfaceError a_to_b = measure_error(a, b, groups, distance_options());
    const SurfaceError b_to_a = measure_error(b, a, groups, distance_options());
    comparison.a_to_b = a_to_b.distance;
    comparison.b_to_a = b_to_a.distance;
    if (comparison.labels) {
      comparison.labels->a_to_b = a_to_b.other_labels;
      comparison.labels->b_to_a = b_to_a.other_labels;
    }
    for (std::size_t i = 0; i < channels.pairs.size(); ++i) {
      comparison.channels.push_back(
          {channels.pairs[i].name, channels.pairs[i].role, a_to_b.values[i], b_to_a.values[i]});
    }
  }

  std::string a_;
  std::string b_;
  DistanceOptions distance_;
  MeasureWords measure_;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_compare_command() {
  return std::make_unique<CompareCommand>();
}

}  // namespace meshfarm
