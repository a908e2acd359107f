// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <iostream>

#include <meshfarm/geometry/distance.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/util/errors.hpp>

#include "cli/command.hpp"
#include "cli/comparer.hpp"
#include "cli/measure_words.hpp"
#include "cli/options.hpp"
#include "cli/output_place.hpp"

namespace meshfarm {
namespace {

class CompareCommand : public Command {
 public:
  std::string_view name() const override { return "compare"; }
  std::string_view synopsis() const override { return "A B"; }
  std::string_view summary() const override {
    return "compare two meshes: distances, facing and values both ways; sizes and topology of each";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("a", po::value(&a_)->required(), "")("b", po::value(&b_)->required(), "")(
        "samples", po::value(&distance_.samples)->default_value(distance_.samples)->value_name("N"),
        "points on each surface")("map", po::value(&map_)->value_name("FILE"),
                                  "write B with the distance of each vertex from A, as 'quality' "
                                  "and as colours")(
        "certify", po::bool_switch(&certify_),
        "bound the greatest distances from above and below, over all points of both surfaces");
    measure_.add(options);
    talk_.add(options);
    positional.add("a", 1).add("b", 1);
  }
  void check() override {
    if (distance_.samples == 0) throw UsageError("--samples: at least 1");
    measure_.check();
  }
  int run() override {
    if (!map_.empty()) check_map();
    const Comparison comparison =
        compare_meshes(a_, b_, {measure_.divide, distance_, certify_, map_});
    std::cout << render(comparison, talk_.format());
    return 0;
  }

 private:
  void check_map() const {
    check_writable(map_);
    if (kept_channels(map_, distance_channels()).empty()) {
      throw UsageError("--map " + map_ + ": this format has no place for distances; .ply has");
    }
    for (const std::string& mesh : {a_, b_}) check_not_over("--map", map_, "the input", mesh);
  }

  std::string a_;
  std::string b_;
  DistanceOptions distance_;
  bool certify_ = false;
  std::string map_;
  MeasureWords measure_;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_compare_command() {
  return std::make_unique<CompareCommand>();
}

}  // namespace meshfarm
