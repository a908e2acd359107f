// SPDX-FileCopyrightText: 2026 the meshfarm authors
// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>
#include <support/meshes.hpp>

#include <meshfarm/io/ply_writer.hpp>

#include "ply_test_files.hpp"

using namespace meshfarm;
using namespace meshfarm::test;

namespace {

MeshSinkOptions options_for(std::uint64_t vertices, std::uint64_t triangles) {
  MeshSinkOptions options;
  options.vertices = vertices;
  options.triangles = triangles;
  return options;
}

std::size_t count_files_in(const TempFolder& folder) {
  const std::filesystem::directory_iterator files(folder.path());
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

}  // namespace

TEST_CASE("what is written is what is read") {
  const TempFolder folder;
  Mesh mesh = torus(40, 60);
  write_ply(folder / "64.ply", mesh, PositionType::float64);
  const ReadFile wide = read_path(folder / "64.ply");
  CHECK(wide.info.positions == PositionType::float64);
  CHECK(wide.info.skipped.empty());
  CHECK(wide.mesh.positions == mesh.positions);
  CHECK(wide.mesh.triangles == mesh.triangles);

  for (Vec3& position : mesh.positions) position = rounded(position, PositionType::float32);
  write_ply(folder / "32.ply", mesh, PositionType::float32);
  const ReadFile narrow = read_path(folder / "32.ply");
  CHECK(narrow.info.positions == PositionType::float32);
  CHECK(narrow.mesh.positions == mesh.positions);
  CHECK(narrow.mesh.triangles == mesh.triangles);
}

TEST_CASE("the written bytes are these") {
  const TempFolder folder;
  MeshSinkOptions options = options_for(4, 2);
  options.comment = "made by a test";
  const auto writer = create_ply(folder / "m.ply", options);
  writer->vertices(k_square_vertices);
  writer->triangles(std::span<const Triangle>(k_square_triangles).first(1));
  const std::vector<WideTriangle> last{{2, 1, 3}};
  writer->triangles(std::span<const WideTriangle>(last));
  writer->commit();
  CHECK(read_file(folder / "m.ply") == replaced(binary_square().text(), "element vertex",
                                                "comment made by a test\nelement vertex"));
}

TEST_CASE("an empty mesh is written") {
  const TempFolder folder;
  write_ply(folder / "m.ply", Mesh{}, PositionType::float32);
  CHECK(read_path(folder / "m.ply").mesh.positions.empty());
}

TEST_CASE("batches of any size make the same file") {
  const TempFolder folder;
  const Mesh mesh = torus(100, 200);
  write_ply(folder / "whole.ply", mesh, PositionType::float32);
  const auto writer =
      create_ply(folder / "pieces.ply", options_for(mesh.positions.size(), mesh.triangles.size()));
  for (std::size_t i = 0; i < mesh.positions.size(); i += 7) {
    writer->vertices(
        std::span(mesh.positions).subspan(i, std::min<std::size_t>(7, mesh.positions.size() - i)));
  }
  writer->vertices({});
  for (const Triangle& triangle : mesh.triangles) {
    writer->triangles(std::span<const Triangle>(&triangle, 1));
  }
  writer->commit();
  CHECK(read_file(folder / "pieces.ply") == read_file(folder / "whole.ply"));
}

TEST_CASE("the index type follows the vertex count") {
  const TempFolder folder;
  // Looks into the unfinished file, to avoid writing 2^31 vertices.
  const auto index_type = [&folder](std::uint64_t vertices) {
    const auto writer = create_ply(folder / "m.ply", options_for(vertices, 0));
    writer->vertices(std::vector<Vec3>(200'000));
    const auto unfinished = std::filesystem::directory_iterator(folder.path())->path();
    const std::string header = read_file(unfinished).substr(0, 200);
    const std::size_t type = header.find("uchar ") + 6;
    return header.substr(type, header.find(' ', type) - type);
  };
  CHECK(index_type(std::uint64_t{1} << 31) == "int");
  CHECK(index_type((std::uint64_t{1} << 31) + 1) == "uint");
  CHECK(index_type(std::uint64_t{1} << 32) == "uint");
  CHECK_THROWS_WITH_AS(
      create_ply(folder / "m.ply", options_for((std::uint64_t{1} << 32) + 1, 0)),
      "a PLY file with 4294967297 vertices cannot be written: its indices have 32 bits",
      UsageError);
}

TEST_CASE("counts other than promised are an error, and nothing is left behind") {
  const TempFolder folder;
  const std::string path = (folder / "m.ply").string();
  {
    const auto writer = create_ply(path, options_for(4, 2));
    CHECK_THROWS_WITH_AS(
        writer->triangles(std::span<const Triangle>(k_square_triangles)),
        (path + ": 0 vertices were given to be written, but 4 were promised").c_str(), DataError);
    writer->vertices(k_square_vertices);
    CHECK_THROWS_WITH_AS(
        writer->vertices(std::span(k_square_vertices).first(1)),
        (path + ": 5 vertices were given to be written, but 4 were promised").c_str(), DataError);
    writer->triangles(std::span<const Triangle>(k_square_triangles).first(1));
    CHECK_THROWS_WITH_AS(
        writer->commit(),
        (path + ": 1 triangles were given to be written, but 2 were promised").c_str(), DataError);
  }
  CHECK(count_files_in(folder) == 0);
}

TEST_CASE("an index out of range is an error") {
  const TempFolder folder;
  const std::string path = (folder / "m.ply").string();
  const auto writer = create_ply(path, options_for(4, 1));
  writer->vertices(k_square_vertices);
  const std::vector<WideTriangle> bad{{0, 1, (std::uint64_t{1} << 32) + 2}};
  CHECK_THROWS_WITH_AS(writer->triangles(std::span<const WideTriangle>(bad)),
                       (path + ": a triangle to be written has vertex 4294967298 of 4").c_str(),
                       DataError);
}

TEST_CASE("without commit there is no file, and an old one stays") {
  const TempFolder folder;
  write_file(folder / "m.ply", "old");
  {
    const auto writer = create_ply(folder / "m.ply", options_for(4, 0));
    writer->vertices(k_square_vertices);
  }
  CHECK(count_files_in(folder) == 1);
  CHECK(read_file(folder / "m.ply") == "old");
  write_ply(folder / "m.ply", {k_square_vertices, k_square_triangles}, PositionType::float32);
  CHECK(read_file(folder / "m.ply") == binary_square().text());
  CHECK(count_files_in(folder) == 1);
}

TEST_CASE("a path that cannot be written is an IoError before any work is done") {
  const TempFolder folder;
  write_file(folder / "file", "");
  const auto told = [](const std::filesystem::path& path) {
    try {
      const auto writer = create_ply(path, options_for(0, 0));
      return std::string("nothing");
    } catch (const IoError& error) {
      return std::string(error.what());
    }
  };
  const std::string in = folder.path().string();
  CHECK(told(folder / "no/m.ply") == "cannot write " + in + "/no/m.ply: No such file or directory");
  CHECK(told(folder / "file/m.ply") == "cannot write " + in + "/file/m.ply: Not a directory");
  CHECK(told(folder.path()) == "cannot write " + in + ": Is a directory");
  CHECK(told(in + "/") == "cannot write " + in + "/: Is a directory");
  CHECK(told("") == "cannot write : No such file or directory");
  CHECK(told("/dev/null") ==
        "cannot replace what is not a regular file: /dev/null: Invalid argument");
  CHECK(told(folder / std::string(300, 'n')).find("File name too long") != std::string::npos);
}

TEST_CASE("a comment of two lines would be two header lines") {
  const TempFolder folder;
  MeshSinkOptions options = options_for(0, 0);
  options.comment = "one\nelement vertex 7";
  CHECK_THROWS_AS(create_ply(folder / "m.ply", options), UsageError);
}
