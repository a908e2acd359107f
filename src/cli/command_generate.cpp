// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/io/ply_writer.hpp>

#include "cli/command.hpp"
#include "cli/options.hpp"

namespace meshfarm {
namespace {

class GenerateCommand : public Command {
 public:
  std::string_view name() const override { return "generate"; }
  std::string_view synopsis() const override { return "-o OUTPUT --triangles N"; }
  std::string_view summary() const override {
    return "make a closed test surface of any size, streamed to a file";
  }
  void setup(po::options_description& options, po::positional_options_description&) override {
    options.add_options()("output,o", po::value(&output_)->required()->value_name("FILE"),
                          "where it goes, as PLY")(
        "triangles", po::value(&triangles_)->default_value(triangles_)->value_name("N"),
        "about so many triangles");
    talk_.add_quiet(options);
  }
  int run() override {
    const BumpyTorus torus(triangles_);
    PlyWriter writer(output_, {.vertices = torus.vertices(),
                               .triangles = torus.triangles(),
                               .positions = PositionType::float32,
                               .comment = "meshfarm generate"});
    ProgressPrinter printer(talk_.progress());
    std::uint64_t written = 0;
    const double all = static_cast<double>(torus.vertices() + torus.triangles());
    const auto tell = [&](std::size_t more) {
      written += more;
      printer.show({.phase = "generate", .done = static_cast<double>(written) / all});
    };
    torus.for_vertices([&](std::span<const Vec3> batch) {
      writer.vertices(batch);
      tell(batch.size());
    });
    torus.for_triangles([&](std::span<const WideTriangle> batch) {
      writer.triangles(batch);
      tell(batch.size());
    });
    writer.commit();
    return 0;
  }

 private:
  std::string output_;
  std::uint64_t triangles_ = 1'000'000;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_generate_command() {
  return std::make_unique<GenerateCommand>();
}

}  // namespace meshfarm
