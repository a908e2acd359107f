// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
//
// Golden checksums of the kernel's results for small generated meshes, and of each staged format.
// They detect bytes that changed without a raised version. 'scripts/renew-golden.sh' renews them.
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include <meshfarm/farm/endpoint.hpp>
#include <meshfarm/geometry/generate.hpp>
#include <meshfarm/geometry/simplify.hpp>
#include <meshfarm/io/bake_file.hpp>
#include <meshfarm/io/boundary_file.hpp>
#include <meshfarm/io/manifest.hpp>
#include <meshfarm/io/material_colours.hpp>
#include <meshfarm/io/part_file.hpp>
#include <meshfarm/io/result_file.hpp>
#include <meshfarm/io/slab_file.hpp>
#include <meshfarm/io/stream_file.hpp>
#include <meshfarm/io/tiled_picture.hpp>
#include <meshfarm/pipeline/algorithm.hpp>
#include <meshfarm/staging/host_card.hpp>
#include <meshfarm/staging/journal.hpp>
#include <meshfarm/util/checksum.hpp>

#include "support/meshes.hpp"
#include "support/temp_folder.hpp"

using namespace meshfarm;

namespace {

constexpr const char* k_list = MESHFARM_SOURCE_DIR "/tests/golden/checksums.txt";

/// Something whose bytes are watched, and where to raise its version.
struct Watched {
  std::string name;
  std::uint32_t version = 0;
  std::uint64_t sum = 0;
  std::string raise;
};

struct Golden {
  std::uint32_t version = 0;
  std::string sum;
};

template <class T>
void add_all(Checksum& sum, const std::vector<T>& items) {
  sum.add({reinterpret_cast<const char*>(items.data()), items.size() * sizeof(T)});
}

Watched kernel(const std::string& name, Shape shape, const LineOptions& lines, PositionType type,
               std::uint64_t target) {
  constexpr std::uint64_t k_triangles = 20'000;
  Mesh mesh = in_memory(*generate_mesh(shape, k_triangles));
  if (lines.appearance_scale.length > 0) {
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
      const auto noise = static_cast<std::uint16_t>(v * 2654435769U >> 20);
      const auto band = static_cast<std::uint16_t>(mesh.positions[v].x > 0 ? 60'000 : 0);
      mesh.appearances.push_back({noise, band, 0, 1});
    }
  }
  Simplifier simplifier(std::move(mesh), {.positions = type, .lines = lines});
  Checksum sum;
  // Two steps, far from the goal and near it: they take different code paths.
  for (const std::uint64_t triangles : {8 * target, target}) {
    simplifier.reduce({.triangles = triangles, .last_triangles = target});
    add_all(sum, simplifier.mesh().positions);
    add_all(sum, simplifier.mesh().triangles);
  }
  return {"kernel/" + name, k_algorithm_version, sum.value(),
          "k_algorithm_version in include/meshfarm/pipeline/algorithm.hpp"};
}

/// A file whose version is at byte `version_at`.
Watched format(const std::string& name, const std::string& file, std::size_t version_at,
               const std::string& source) {
  std::uint32_t version = 0;
  REQUIRE(file.size() >= version_at + sizeof version);
  std::memcpy(&version, file.data() + version_at, sizeof version);
  return {"format/" + name, version, checksum(file), "the version in " + source};
}

/// A file that begins with magic, kind and version.
Watched staged(const std::string& name, const std::string& file, const std::string& source) {
  return format(name, file, 8, source);
}

std::string result_bytes() {
  std::string file;
  ResultWriter writer({PositionType::float64, false, 2},
                      [&](std::string_view bytes) { file += bytes; });
  const Mesh mesh = test::grid(9, 7);
  writer.add_rung(3, mesh, 20, 0.25);
  writer.add_rung(5, mesh, 10, 0.5);
  const std::vector<SurfaceSamples> samples = {{2.5, {{1, 2, 3}, {4, 5, 6}}}};
  writer.finish(std::span(mesh.positions).first(2), samples);
  const ResultSummary summary{writer.rungs(), 4, 5, true, 0, {}, LadderEnd::floor, writer.tail(),
                              writer.beside()};
  return file + encode_summary(summary);
}

StreamMesh stream() {
  StreamMesh stream;
  stream.mesh = test::grid(9, 7);
  for (const Vec3& p : stream.mesh.positions) stream.boundary.push_back(p.y == 0 ? 1 : 0);
  return stream;
}

Manifest manifest() {
  Manifest made;
  made.input = "in.ply";
  made.input_format = "PLY ascii";
  made.partitioner = "METIS";
  made.window_triangles = 1000;
  made.box = {{0, 1, 2}, {3, 4, 5}};
  made.input_vertices = 10;
  made.input_triangles = 11;
  made.coincident_vertices = 12;
  made.dropped_degenerate = 13;
  made.coincident_corners = 14;
  made.dropped_not_finite = 15;
  made.dropped_duplicate = 16;
  made.channels = {{{"red", ChannelType::uint8, ChannelRole::colour}}, {"channels", 24, 25}, 26};
  made.skipped = {"face.flags"};
  made.cut_seconds = 0.5;
  made.boundary_triangles = 17;
  made.boundary = {{{"boundary", 18, 19}, {}, 0}};
  made.parts = {{{"parts/000000.part", 20, 21}, 22, 23, 4}};
  return made;
}

BakeScene bake_scene() {
  BakeScene scene{512, 4, 0.25, 1.5, {}, {}, {}};
  scene.parts = {{{{0, 1, 2}, {3, 4, 5}}, {"parts/000001.part", 7, 8}, 3}};
  scene.seams = {{{{-1, -1, -1}, {1, 1, 1}}, {10, 20, 30}}};
  scene.chunks = {{1, 2, 3}, {4, 5, 6}};
  return scene;
}

std::vector<CornerUvs> flat_uvs(const Mesh& mesh) {
  std::vector<CornerUvs> uvs;
  for (const Triangle& t : mesh.triangles) {
    CornerUvs& corners = uvs.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = mesh.positions[t[k]];
      corners[k] = {static_cast<float>(p.x) / 16, static_cast<float>(p.y) / 16};
    }
  }
  return uvs;
}

/// The directory contains the tiles' checksums.
std::string tiled_directory() {
  std::vector<std::uint8_t> texels;
  for (int i = 0; i < 3 * 200 * 200; ++i) texels.push_back(static_cast<std::uint8_t>(i * 7));
  std::string last;
  TiledPicturesWriter writer([&](std::string_view bytes) { last = bytes; });
  writer.add(3, encoded_picture(200, std::move(texels), PictureCoding::png));
  writer.finish();
  return last;
}

std::string journal_bytes() {
  const test::TempFolder folder;
  JournalWriter(folder.path() / "j").append("a record");
  std::ifstream in(folder.path() / "j", std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<Watched> all_watched() {
  constexpr auto k_float = PositionType::float32;
  constexpr auto k_double = PositionType::float64;
  const Mesh sheet = test::grid(9, 7);
  return {
      kernel("torus", Shape::torus, {}, k_float, 300),
      kernel("torus-double", Shape::torus, {}, k_double, 300),
      kernel("foam", Shape::foam, {}, k_float, 1000),
      kernel("foam-keep", Shape::foam, {.topology = TopologyMode::keep}, k_float, 2000),
      kernel("foam-simplify", Shape::foam, {.topology = TopologyMode::simplify}, k_float, 200),
      kernel("dust", Shape::dust, {}, k_float, 1000),
      kernel("soup", Shape::soup, {}, k_float, 500),
      kernel("terrain", Shape::terrain, {}, k_float, 200),
      kernel("terrain-border", Shape::terrain, {.preserve_border = true}, k_float, 1000),
      kernel("block-creases", Shape::block, {.crease_angle = 40}, k_float, 1000),
      kernel("terrain-colours", Shape::terrain, {.appearance_scale = {0.005}}, k_float, 1000),
      kernel("torus-colours", Shape::torus, {.appearance_scale = {0.02}}, k_float, 300),
      staged("part", encode_part({sheet, 3, k_float}), "src/io/part_file.cpp"),
      staged("boundary", encode_boundary(3, {{{{0, 1}, {1, 2}, {2, 3}}}}).file,
             "src/io/boundary_file.cpp"),
      staged("slab", encode_slab({sheet.positions, sheet.triangles, {1, 5}, k_double, {{2, 0}}}),
             "src/io/slab_file.cpp"),
      staged("stream", encode_stream(stream()), "src/io/stream_file.cpp"),
      staged("result", result_bytes(), "src/io/result_file.cpp"),
      staged("manifest", encode_manifest(manifest()), "src/io/manifest.cpp"),
      staged("bake-scene", encode_bake_scene(bake_scene()), "src/io/bake_file.cpp"),
      staged("bake-surface", encode_bake_surface(surface_to_bake(sheet, flat_uvs(sheet))),
             "src/io/bake_file.cpp"),
      staged("baked-texels", encode_baked_texels({{{1, 2, 2}}, {{1, 2, 3}, {4, 5, 6}}}),
             "src/io/bake_file.cpp"),
      staged("tiled-pictures", tiled_directory(), "src/io/tiled_picture.cpp"),
      format("journal", journal_bytes(), 4, "src/staging/journal.cpp"),
      staged("host-card", encode_host_card({"host", 1, 2, 3}), "src/staging/host_card.cpp"),
      staged("endpoint", encode_endpoint({1, 2, "tcp://host:3", "host", 4, "key"}),
             "src/farm/endpoint.cpp"),
  };
}

/// One line each: NAME VERSION CHECKSUM.
std::map<std::string, Golden> read_list() {
  std::map<std::string, Golden> list;
  std::ifstream file(k_list);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string name;
    Golden golden;
    if (words >> name >> golden.version >> golden.sum) list[name] = golden;
  }
  return list;
}

void write_list(const std::vector<Watched>& watched) {
  std::ofstream file(k_list);
  for (const Watched& it : watched) {
    file << it.name << " " << it.version << " " << to_hex(it.sum) << "\n";
  }
}

/// What has to be done about it; empty if the bytes are unchanged.
std::string complaint(const Watched& it, const std::map<std::string, Golden>& list) {
  const auto golden = list.find(it.name);
  if (golden == list.end()) return it.name + " is not in the list";
  const bool same_bytes = golden->second.sum == to_hex(it.sum);
  if (it.version == golden->second.version) {
    if (same_bytes) return {};
    return it.name + ": other bytes under the same version " + std::to_string(it.version) +
           ": raise " + it.raise;
  }
  return it.name + ": its version is " + std::to_string(it.version) + ", and " +
         std::to_string(golden->second.version) + " in the list";
}

}  // namespace

TEST_CASE("no bytes change without a raised version") {
  const std::vector<Watched> watched = all_watched();
  const auto list = read_list();
  const char* renew = std::getenv("MESHFARM_RENEW_GOLDEN");
  const bool forced = renew != nullptr && std::string(renew) == "force";
  bool may_be_written = renew != nullptr;
  for (const Watched& it : watched) {
    const std::string why = complaint(it, list);
    const bool must_be_raised = why.find(": raise ") != std::string::npos;
    if (forced || (renew != nullptr && !must_be_raised)) continue;
    if (must_be_raised) may_be_written = false;
    const std::string then = must_be_raised ? ", then" : ";";
    CHECK_MESSAGE(why.empty(), (why + then + " run scripts/renew-golden.sh"));
  }
  if (may_be_written) {
    write_list(watched);
  } else {
    CHECK(list.size() == watched.size());
  }
}
