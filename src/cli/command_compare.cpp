// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <iostream>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/stream/divided_distance.hpp>
#include <meshfarm/util/errors.hpp>

#include "cli/command.hpp"
#include "cli/measure_words.hpp"
#include "cli/options.hpp"

namespace meshfarm {
namespace {

class CompareCommand : public Command {
 public:
  std::string_view name() const override { return "compare"; }
  std::string_view synopsis() const override { return "A B"; }
  std::string_view summary() const override {
    return "sampled distances between two meshes, both ways, and the topology of both";
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
    const auto source_a = open_mesh(a_);
    const auto source_b = open_mesh(b_);
    Comparison comparison;
    comparison.path_a = a_;
    comparison.path_b = b_;
    DivideOptions divide = measure_.divide;
    divide.memory_bytes /= 2;  // each
    const DividedSurface a(*source_a, divide);
    const DividedSurface b(*source_b, divide);
    comparison.diagonal = a.box().diagonal();
    if (memory_for(a) + memory_for(b) <= measure_.divide.memory_bytes) {
      measure(read_mesh(*source_a), read_mesh(*source_b), comparison);
    } else {
      measure(a, b, comparison);
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
  /// What it takes to hold one with its hierarchy.
  static std::uint64_t memory_for(const DividedSurface& surface) {
    return sizeof(Vec3) * surface.vertices() + (sizeof(Triangle) + 40) * surface.triangles();
  }

  template <class Surface>
  void measure(const Surface& a, const Surface& b, Comparison& comparison) const {
    DistanceOptions options = distance_;
    options.threads = measure_.divide.threads;
    comparison.a_to_b = measure_distance(a, b, options);
    comparison.b_to_a = measure_distance(b, a, options);
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
