// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/io/ply_writer.hpp>
#include <meshfarm/util/errors.hpp>

#include "cli/command.hpp"
#include "cli/options.hpp"

namespace meshfarm {
namespace {

class GenerateCommand : public Command {
 public:
  std::string_view name() const override { return "generate"; }
  std::string_view synopsis() const override {
    return "-o OUTPUT (--triangles N | --shuffle --from FILE)";
  }
  std::string_view summary() const override {
    return "make a closed test surface of any size, streamed to a file";
  }
  void setup(po::options_description& options, po::positional_options_description&) override {
    options.add_options()("output,o", po::value(&output_)->required()->value_name("FILE"),
                          "where it goes, as PLY")(
        "triangles", po::value(&triangles_)->default_value(triangles_)->value_name("N"),
        "about so many triangles")(
        "shuffle", po::bool_switch(&shuffle_),
        "put vertices and triangles into random order; holds the mesh in memory")(
        "from", po::value(&from_)->value_name("FILE"),
        "with --shuffle: take this mesh instead of a made one");
    talk_.add_quiet(options);
  }
  void check() override {
    if (!from_.empty() && !shuffle_) throw UsageError("--from goes with --shuffle");
  }
  int run() override {
    shuffle_ ? write_shuffled() : write_in_order();
    return 0;
  }

 private:
  void write_shuffled() const {
    constexpr std::uint64_t k_seed = 1;
    PositionType positions = PositionType::float32;
    Mesh mesh;
    if (from_.empty()) {
      mesh = whole(BumpyTorus(triangles_));
    } else {
      const auto source = open_mesh(from_);
      mesh = read_mesh(*source);
      positions = source->info().positions;
    }
    shuffle(mesh, k_seed);
    write_ply(output_, mesh, positions);
  }

  static Mesh whole(const BumpyTorus& torus) {
    if (torus.vertices() > UINT32_MAX) {
      throw UsageError("--shuffle: a mesh of so many triangles cannot be held in memory");
    }
    Mesh mesh;
    torus.for_vertices([&](std::span<const Vec3> batch) {
      mesh.positions.insert(mesh.positions.end(), batch.begin(), batch.end());
    });
    torus.for_triangles([&](std::span<const WideTriangle> batch) {
      for (const auto& [a, b, c] : batch) {
        mesh.triangles.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b),
                                  static_cast<std::uint32_t>(c)});
      }
    });
    return mesh;
  }

  void write_in_order() const {
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
  }

  std::string output_;
  std::uint64_t triangles_ = 1'000'000;
  bool shuffle_ = false;
  std::string from_;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_generate_command() {
  return std::make_unique<GenerateCommand>();
}

}  // namespace meshfarm
