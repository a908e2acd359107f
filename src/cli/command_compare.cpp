// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <iostream>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/util/errors.hpp>

#include "cli/command.hpp"
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
        "points on each surface")("threads", po::value(&distance_.threads)->value_name("N"),
                                  "threads (default: cores)");
    talk_.add(options);
    positional.add("a", 1).add("b", 1);
  }
  void check() override {
    if (distance_.samples == 0) throw UsageError("--samples: at least 1");
  }
  int run() override {
    const Mesh a = read_mesh(*open_mesh(a_));
    const Mesh b = read_mesh(*open_mesh(b_));
    Box box;
    for (const Vec3& p : a.positions) box.add(p);
    Comparison comparison;
    comparison.path_a = a_;
    comparison.path_b = b_;
    comparison.diagonal = box.diagonal();
    comparison.a_to_b = measure_distance(a, b, distance_);
    comparison.b_to_a = measure_distance(b, a, distance_);
    comparison.topology_a = measure_topology(a);
    comparison.topology_b = measure_topology(b);
    std::cout << render(comparison, talk_.format());
    return 0;
  }

 private:
  std::string a_;
  std::string b_;
  DistanceOptions distance_;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_compare_command() {
  return std::make_unique<CompareCommand>();
}

}  // namespace meshfarm
