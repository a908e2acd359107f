// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/io/mesh_format.hpp>
#include <meshfarm/util/errors.hpp>

#include "cli/command.hpp"
#include "cli/options.hpp"
#include "cli/output_place.hpp"

namespace meshfarm {
namespace {

class GenerateCommand : public Command {
 public:
  std::string_view name() const override { return "generate"; }
  std::string_view synopsis() const override {
    return "-o OUTPUT (--triangles N [--shape NAME] | --shuffle --from FILE)";
  }
  std::string_view summary() const override {
    return "make a test mesh of any size, streamed to a file";
  }
  void setup(po::options_description& options, po::positional_options_description&) override {
    options.add_options()("output,o", po::value(&output_)->required()->value_name("FILE"),
                          "the file to write: .ply, .glb, .gltf, .off, .obj or .stl")(
        "triangles", po::value(&triangles_)->default_value(triangles_)->value_name("N"),
        "number of triangles, about")("shape",
                                      po::value(&shape_)->default_value(shape_)->value_name(
                                          "torus|foam|dust|soup|terrain|block|shell"),
                                      "which surface to make")(
        "shuffle", po::bool_switch(&shuffle_),
        "put vertices and triangles into random order; holds the mesh in memory")(
        "from", po::value(&from_)->value_name("FILE"),
        "with --shuffle: read this mesh instead of making one");
    talk_.add_quiet(options);
  }
  void check() override {
    if (!from_.empty() && !shuffle_) throw UsageError("--from needs --shuffle");
    shape_named(shape_);
  }
  void check_given(const GivenOptions& given) const override {
    for (const char* option : {"triangles", "shape"}) {
      if (from_.empty() || !given.contains(option)) continue;
      throw UsageError("--" + std::string(option) +
                       " cannot be combined with --from: no mesh is made then");
    }
  }
  int run() override {
    check_writable(output_);
    if (!from_.empty()) check_not_over("-o", output_, "the input", from_);
    shuffle_ ? write_shuffled() : write_in_order();
    return 0;
  }

 private:
  void write_shuffled() const {
    constexpr std::uint64_t k_seed = 1;
    PositionType positions = PositionType::float32;
    Mesh mesh;
    if (from_.empty()) {
      mesh = in_memory(*generate_mesh(shape_named(shape_), triangles_));
    } else {
      const auto source = open_mesh(from_, {.labels = false});
      mesh = read_mesh(*source);
      positions = source->info().positions;
    }
    shuffle(mesh, k_seed);
    write_mesh(output_, mesh, positions);
  }

  void write_in_order() const {
    const auto made = generate_mesh(shape_named(shape_), triangles_);
    const auto sink = create_mesh(output_, {.vertices = made->vertices(),
                                            .triangles = made->triangles(),
                                            .positions = PositionType::float32,
                                            .comment = "meshfarm generate"});
    ProgressPrinter printer(talk_.progress());
    std::uint64_t written = 0;
    const auto all = static_cast<double>(made->vertices() + made->triangles());
    const auto tell = [&](std::size_t more) {
      written += more;
      printer.show({.phase = "generate", .done = static_cast<double>(written) / all});
    };
    made->for_vertices([&](std::span<const Vec3> batch) {
      sink->vertices(batch);
      tell(batch.size());
    });
    made->for_triangles([&](std::span<const WideTriangle> batch) {
      sink->triangles(batch);
      tell(batch.size());
    });
    sink->commit();
  }

  std::string output_;
  std::uint64_t triangles_ = 1'000'000;
  std::string shape_ = "torus";
  bool shuffle_ = false;
  std::string from_;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_generate_command() {
  return std::make_unique<GenerateCommand>();
}

}  // namespace meshfarm
