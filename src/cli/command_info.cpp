// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <iostream>

#include <meshfarm/geometry/topology.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/staging/stage.hpp>

#include "cli/command.hpp"
#include "cli/options.hpp"

namespace meshfarm {
namespace {

class InfoCommand : public Command {
 public:
  std::string_view name() const override { return "info"; }
  std::string_view synopsis() const override { return "FILE | STAGE"; }
  std::string_view summary() const override {
    return "counts, bounding box and topology of a mesh file, or what a stage holds";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("file", po::value(&file_)->required(), "")(
        "no-topology", po::bool_switch(&no_topology_),
        "counts and box only: in a bounded memory, whatever the size");
    talk_.add(options);
    positional.add("file", 1);
  }
  int run() override {
    if (std::filesystem::is_directory(file_)) {
      const Stage stage = Stage::open(file_);
      const Manifest manifest =
          decode_manifest(stage.read(ManifestName{}), stage.path(ManifestName{}).string());
      std::cout << render(manifest, file_, talk_.format());
      return 0;
    }
    const auto source = open_mesh(file_);
    std::cout << render(no_topology_ ? scanned(*source) : whole(*source), talk_.format());
    return 0;
  }

 private:
  FileSummary scanned(MeshSource& source) const {
    FileSummary summary{.path = file_, .file = {}, .box = {}, .topology = {}};
    source.scan_vertices([&](std::span<const Vec3> batch) {
      for (const Vec3& p : batch) summary.box.add(p);
    });
    source.scan_triangles(
        [&](std::span<const WideTriangle> batch) { summary.triangles += batch.size(); });
    summary.file = source.info();
    summary.short_faces = source.small_faces();
    return summary;
  }

  FileSummary whole(MeshSource& source) const {
    FileSummary summary{.path = file_, .file = {}, .box = {}, .topology = {}};
    const Mesh mesh = read_mesh(source);
    for (const Vec3& p : mesh.positions) summary.box.add(p);
    summary.triangles = mesh.triangles.size();
    summary.topology = measure_topology(mesh);
    summary.file = source.info();
    summary.short_faces = source.small_faces();
    return summary;
  }

  std::string file_;
  bool no_topology_ = false;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_info_command() {
  return std::make_unique<InfoCommand>();
}

}  // namespace meshfarm
