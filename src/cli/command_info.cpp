// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>

#include <meshfarm/geometry/crossings.hpp>
#include <meshfarm/geometry/surface_measures.hpp>
#include <meshfarm/geometry/uv_facts.hpp>
#include <meshfarm/geometry/weld.hpp>
#include <meshfarm/io/mesh_source.hpp>
#include <meshfarm/io/near_vertices.hpp>
#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/report/summary.hpp>
#include <meshfarm/staging/stage.hpp>
#include <meshfarm/util/errors.hpp>
#include <meshfarm/util/file.hpp>

#include "cli/command.hpp"
#include "cli/measure_words.hpp"
#include "cli/options.hpp"

namespace meshfarm {
namespace {

class InfoCommand : public Command {
 public:
  std::string_view name() const override { return "info"; }
  std::string_view synopsis() const override { return "FILE | STREAM | STAGE"; }
  std::string_view summary() const override {
    return "show counts, bounding box and topology of a mesh file, or the contents of a stream or "
           "a stage";
  }
  void setup(po::options_description& options,
             po::positional_options_description& positional) override {
    options.add_options()("file", po::value(&file_)->required(), "")(
        "no-topology", po::bool_switch(&no_topology_),
        "counts and box only: in one scan, and without scratch files")(
        "figures", po::bool_switch(&figures_),
        "area, volume, angles, lengths of borders and of edges over 40 degrees, and triangles that "
        "cut others, too");
    measure_.add(options);
    talk_.add(options);
    positional.add("file", 1);
  }
  void check() override {
    if (figures_ && no_topology_)
      throw UsageError("--figures cannot be combined with --no-topology");
    measure_.check();
  }
  int run() override {
    if (std::filesystem::is_directory(file_)) {
      const Stage stage = Stage::open(file_);
      const Manifest manifest =
          decode_manifest(stage.read(ManifestName{}), stage.path(ManifestName{}).string());
      std::cout << render(manifest, file_, talk_.format());
      return 0;
    }
    if (file_is_stream()) {
      std::cout << render(read_through(), talk_.format());
      return 0;
    }
    const auto source = open_mesh(
        file_, {.scans = no_topology_ ? Scans::one : Scans::many, .textures = Textures::name});
    std::cout << render(no_topology_ ? scanned(*source) : measured(*source), talk_.format());
    return 0;
  }

 private:
  bool file_is_stream() const {
    std::array<char, 8> start{};
    std::ifstream(file_, std::ios::binary).read(start.data(), start.size());
    return is_stream({start.data(), start.size()});
  }

  /// Reads instead of mapping: the host of a staged file may go away meanwhile.
  Fill fill_from_file() const {
    const auto fd = std::make_shared<Fd>(open_for_read(file_));
    return [fd, path = file_, done = std::uint64_t{0}](std::span<char> buffer) mutable {
      const std::size_t got = read_up_to(fd->get(), buffer, path);
      done += got;
      if (got < buffer.size()) {
        throw DataError(path + ": cut short at byte " + std::to_string(done));
      }
    };
  }

  /// Also checks the whole stream.
  StreamSummary read_through() const {
    StreamReader reader(fill_from_file(), file_);
    StreamSummary summary{.path = file_, .stream = reader.info(), .box = {}};
    std::uint64_t front = 0;
    StreamBlock block;
    while (reader.next(block)) {
      ++summary.blocks;
      for (const Vec3& p : block.positions) summary.box.add(p);
      front += block.positions.size();
      summary.widest_front = std::max(summary.widest_front, front);
      for (const StreamCorner corner : block.boundary) front -= corner.last_use() ? 1 : 0;
      for (const auto& t : block.triangles) {
        for (const StreamCorner corner : t) front -= corner.last_use() ? 1 : 0;
      }
    }
    return summary;
  }

  static void add(Vec3 p, FileSummary& summary) {
    has_position(p) ? summary.box.add(p) : void(++summary.not_finite);
  }

  FileSummary scanned(MeshSource& source) const {
    FileSummary summary{.path = file_, .file = {}, .box = {}};
    source.scan_vertices([&](std::span<const Vec3> batch) {
      for (const Vec3& p : batch) add(p, summary);
    });
    source.scan_triangles(
        [&](std::span<const WideTriangle> batch) { summary.triangles += batch.size(); });
    summary.file = source.info();
    summary.short_faces = source.small_faces();
    return summary;
  }

  FileSummary measured(MeshSource& source) const {
    const DividedSurface surface(source, measure_.divide);
    FileSummary summary{.path = file_, .file = source.info(), .box = surface.box()};
    summary.triangles = surface.triangles();
    summary.short_faces = source.small_faces();
    summary.not_finite = surface.not_finite();
    summary.dropped_not_finite = surface.dropped();
    if (may_have_near_misses(source.info())) {
      summary.near_misses = find_near_misses(source, summary.box);
    }
    const SurfaceTopology topology = surface.measure_topology();
    summary.welded = topology.welded;
    summary.as_it_is = topology.as_it_is;
    if (figures_) add_figures(surface, topology, summary);
    if (!summary.file.textures.empty()) summary.texture_floor = texture_floor(surface);
    return summary;
  }

  void add_figures(const DividedSurface& surface, const SurfaceTopology& topology,
                   FileSummary& summary) const {
    const unsigned threads = measure_.divide.threads;
    ShapeMeter meter(threads);
    surface.show([&](std::span<const Vec3> positions, std::span<const Triangle> triangles) {
      meter.add(positions, triangles);
    });
    SurfaceFigures& figures = summary.figures.emplace();
    figures.shape = meter.measures();
    figures.is_closed = topology.welded.unmatched_edges == 0;
    const std::uint64_t needed = memory_to_hold(surface.vertices(), surface.triangles());
    if (needed > measure_.divide.memory_bytes) {
      summary.not_measured = why_too_little(needed, measure_.divide.memory_bytes);
      return;
    }
    const auto source = open_mesh(file_, {.channels = false, .labels = false});
    const Mesh mesh = read_mesh(*source);
    figures.edges = measure_edge_lengths(mesh, threads);
    figures.crossing_triangles = count_crossing_triangles(mesh, {.threads = threads});
    if (!figures.crossing_triangles) figures.crossings_skipped = k_too_many_at_one_place;
  }

  /// 0 if the mesh does not fit into --memory.
  std::uint64_t texture_floor(const DividedSurface& surface) const {
    constexpr std::uint64_t k_bytes = 160;  // per triangle, in total
    if (k_bytes * surface.triangles() > measure_.divide.memory_bytes) return 0;
    const auto source = open_mesh(file_, {.textures = Textures::keep});
    Mesh mesh = read_mesh(*source);
    WeldResult welded = weld(mesh.positions);
    separate_touching(mesh.triangles, {}, welded);
    for (Triangle& t : mesh.triangles) {
      t = {welded.first[t[0]], welded.first[t[1]], welded.first[t[2]]};
    }
    keep_triangles(mesh, [&](std::size_t i) {
      const auto& [a, b, c] = mesh.triangles[i];
      return a != b && b != c && c != a;
    });
    return told_uv_floor(find_uv_facts(mesh, 0).floor);
  }

  std::string file_;
  bool no_topology_ = false;
  bool figures_ = false;
  MeasureWords measure_;
  TalkOptions talk_;
};

}  // namespace

std::unique_ptr<Command> make_info_command() {
  return std::make_unique<InfoCommand>();
}

}  // namespace meshfarm
